"""Loops that keep to a plane though their joints could leave it: booms that cylinders lift, and others at random."""

from dataclasses import replace

import numpy as np

import jaxkin as jk
from jaxkin.geometry.pose import unit

Z = (0, 0, 1)
IN_PLANE = {"boom.phi", "foot.phi", "cylinder.z", "eye.phi"}
STROKES = np.linspace(-1.0, 1.5, 41)


def crane(height=0.0, last=None):
    """A boom that a hydraulic cylinder from (3, -4) lifts at its point (4, 0)."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    joints = [
        jk.revolute("boom", "ground", "boom", point=(0, 0, 0), axis=Z),
        jk.revolute("foot", "ground", "tube", point=(3, -4, height), axis=Z),
        jk.cylindrical("cylinder", "tube", "rod", point=(3, -4, height), axis=along),
        last or jk.revolute("eye", "rod", "boom", point=(4, 0, height), axis=Z),
    ]
    return jk.Mechanism.build(joints=joints, fixed=["ground"])


def boom_angle(stroke):
    """By the law of cosines: sides 4 (boom) and 5 (ground) about the hinge, and the cylinder of length sqrt(17) + z."""
    length = np.sqrt(17.0) + stroke
    return np.arccos((16 + 25 - length**2) / (2 * 4 * 5)) - np.arctan2(4, 3)


def in_space(mechanism):
    """The same mechanism, solved by six equations a loop (four where all turn about one direction)."""
    linkage = mechanism.linkage
    classes = tuple(each._replace(plane=None, decoupled_plane=None) for each in linkage.classes)
    return replace(mechanism, linkage=replace(linkage, classes=classes))


def in_plane(mechanism):
    """The names of the coordinates in the plane of the only loop group; None where there is no plane."""
    (found,), (loop_group,) = mechanism.linkage.classes, mechanism.structure.loop_groups
    joints = [mechanism.all_joints[joint] for joint in loop_group.joints]
    names = [f"{joint.name}.{name}" for joint in joints for name in joint.coordinates]
    assert found.plane is None
    return None if found.decoupled_plane is None else {names[column] for column in found.decoupled_plane}


def rod_on_ball_and_cross(height=0.0, eye=4.0):
    """A boom, a tube on a cross and a rod on a ball, of which `eye` is the place along the boom."""
    return jk.Mechanism.build(
        joints=[
            jk.revolute("boom", "ground", "boom", point=(0, 0, 0), axis=Z),
            jk.universal("foot", "ground", "tube", point=(3, -4, height), axis1=Z, axis2=unit(np.array([4.0, -1, 0]))),
            jk.cylindrical("cylinder", "tube", "rod", point=(3, -4, height), axis=(1, 4, 0)),
            jk.spherical("eye", "rod", "boom", point=(eye, 0, height)),
        ],
        fixed=["ground"],
    )


def drawn(rng):
    """A four-bar, or a crane, of any joints: mechanism and drive.

    Hinges, pins, balls, crosses and swivels at any height; tubes, and plates across the plane, where parts slide.
    """
    places = rng.normal(size=(4, 2)) * 2

    def level(place):
        return (*place, rng.choice([0.0, 0.0, rng.normal()]))

    def hinge(name, one, other, place):
        point, angle = level(place), rng.uniform(0, np.pi)
        across = (np.cos(angle), np.sin(angle), 0.0)
        match rng.choice(["hinge", "pin", "ball", "cross", "swivel"], p=[0.4, 0.2, 0.2, 0.1, 0.1]):
            case "hinge":
                return [jk.revolute(name, one, other, point=point, axis=Z)]
            case "pin":
                return [jk.cylindrical(name, one, other, point=point, axis=Z)]
            case "ball":
                return [jk.spherical(name, one, other, point=point)]
            case "cross":
                return [jk.universal(name, one, other, point=point, axis1=Z, axis2=across)]
        swivel = jk.revolute(f"{name} swivel", f"{name} ring", other, point=point, axis=across)
        return [jk.revolute(name, one, f"{name} ring", point=point, axis=Z), swivel]

    if rng.integers(2):
        ends = [("ground", "a"), ("a", "b"), ("b", "c"), ("c", "ground")]
        joints = [hinge(name, *pair, place) for name, pair, place in zip("ABCD", ends, places, strict=True)]
        drive = "A"
    else:
        along = (*unit(places[2] - places[1]), 0.0)
        slide = jk.cylindrical("S", "tube", "rod", point=level(places[1]), axis=along)
        if rng.integers(2):
            slide = jk.planar("S", "tube", "rod", point=level(places[1]), normal=np.cross(along, Z))
        ends = [("ground", "boom"), ("ground", "tube"), ("rod", "boom")]
        joints = [hinge(name, *pair, place) for name, pair, place in zip("ABC", ends, places, strict=False)]
        joints, drive = [*joints, [slide]], "S"
    return jk.Mechanism.build(joints=[each for some in joints for each in some], fixed=["ground"]), drive
