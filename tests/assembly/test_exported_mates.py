"""Mates of CAD systems: what each leaves free, and what those of two parts amount to together."""

import numpy as np
import pytest

from reference.exported import X, Y, Z, instance, load, mate


def hinge(name, one, other, point):
    """A concentric mate of a pin and its hole, and a coincident one of two faces: a revolute joint about z."""
    return mate("Concentric", f"{name} pin", (one, "cylinder", point, Z), (other, "cylinder", point, Z)) + mate(
        "Coincident", f"{name} face", (one, "plane", point, Z), (other, "plane", point, Z)
    )


@pytest.mark.long
def test_mates_of_two_parts_are_intersected(tmp_path):
    """A slider-crank of mates only: x = r cos(q) + sqrt(l^2 - r^2 sin(q)^2)."""
    r, length = 0.03, 0.1
    crank, slider = (r, 0, 0), (r + length, 0, 0)
    tree = instance("base", grounded="true") + instance("crank") + instance("rod") + instance("slider")
    rail = mate("Coincident", "floor", ("base", "plane", (0, 0, 0), Z), ("slider", "plane", (0, 0, 0), Z))
    rail += mate("Distance", "wall", ("base", "plane", (0, 0.02, 0), Y), ("slider", "plane", (0, 0.01, 0), Y))
    mates = (
        hinge("A", "base", "crank", (0, 0, 0)) + hinge("B", "crank", "rod", crank) + hinge("C", "rod", "slider", slider)
    )
    mechanism = load(tmp_path, tree, mates=mates + rail).mechanism()
    kinds = {joint.parts: joint.kind for joint in mechanism.all_joints}
    assert sorted(kinds.values()) == ["prismatic", "revolute", "revolute", "revolute"]
    q = np.linspace(0, 2 * np.pi, 37)
    motion = mechanism.sweep({"base-crank": q})
    x = np.array(motion.transforms["slider"])[:, 0, 3] + slider[0]
    np.testing.assert_allclose(x, r * np.cos(q) + np.sqrt(length**2 - (r * np.sin(q)) ** 2), atol=1e-12)


PLANE, LINE, POINT = ("plane", (0, 0, 0), Z), ("line", (0, 0, 0), X), ("point", (0, 0, 0), Z)


@pytest.mark.parametrize(
    ("kind", "one", "other", "freedoms"),
    [
        ("Coincident", PLANE, PLANE, 3),
        ("Coincident", PLANE, LINE, 4),
        ("Coincident", PLANE, POINT, 5),
        ("Concentric", LINE, LINE, 2),
        ("Distance", LINE, ("line", (0, 0.1, 0), X), 3),
        ("Distance", LINE, ("line", (0, 0, 0.1), Y), 5),
        ("Coincident", LINE, POINT, 4),
        ("Distance", LINE, ("point", (0.2, 0.1, 0), Z), 5),
        ("Concentric", POINT, ("sphere", (0, 0, 0), Z), 3),
        ("Distance", POINT, ("point", (0, 0.1, 0), Z), 5),
        ("Tangent", PLANE, ("cylinder", (0, 0, 0.1), X), 4),
        ("Coincident", ("circle", (0, 0, 0), Z), ("circle", (0, 0, 0), (0, 0, -1)), 1),
        ("Coincident", ("circle", (0.1, 0, 0), Z), PLANE, 3),
        ("Lock", POINT, POINT, 0),
    ],
)
@pytest.mark.parametrize("swapped", [False, True])
def test_each_mate_leaves_its_freedoms(tmp_path, kind, one, other, freedoms, swapped):
    tree = instance("base", grounded="true") + instance("part", (0.3, 0, 0)).replace("0.3", "0")
    sides = (("part", *one), ("base", *other)) if swapped else (("base", *one), ("part", *other))
    mechanism = load(tmp_path, tree, mates=mate(kind, "m", *sides)).mechanism()
    assert mechanism.mobility().freedoms == freedoms


@pytest.mark.parametrize(("kind", "axis", "left"), [("Parallel", X, "prismatic"), ("Perpendicular", Y, "prismatic")])
def test_mates_of_angles_count_with_others(tmp_path, kind, axis, left):
    """A pin in its hole, kept from turning; alone the mate of an angle is no joint, and is named."""
    tree = instance("base", grounded="true") + instance("part")
    angle = mate(kind, "square", ("base", "plane", (0, 0, 0), X), ("part", "plane", (0, 0, 0), axis))
    pin = mate("Concentric", "pin", ("base", "line", (0, 0, 0), Z), ("part", "line", (0, 0, 0), Z))
    (found,) = load(tmp_path, tree, mates=pin + angle).mechanism().all_joints
    assert found.kind == left
    alone = load(tmp_path, tree, mates=angle).mechanism()
    assert any(f"{kind} 'square'" in note and "is left out" in note for note in alone.notes)


def test_mates_that_exporters_have_no_name_for_are_read_by_their_own(tmp_path):
    """A lock comes without geometry, and a limit as a distance."""
    tree = instance("base", grounded="true") + instance("slide") + instance("knob")
    nothing = "".join(
        f'<ConstraintGeometry geomType="Unknown"><InstancePath><Uid>{uid}</Uid></InstancePath></ConstraintGeometry>'
        for uid in ("slide", "knob")
    )
    mates = f'<UnknownConstraint name="Lock3">{nothing}</UnknownConstraint>'
    mates += mate("Distance", "LimitDistance1", ("base", *PLANE), ("slide", *PLANE))
    mates += mate("Concentric", "pin", ("base", *LINE), ("slide", *LINE))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert mechanism.bodies["slide"] == ("slide", "knob")
    assert mechanism.mobility().freedoms == 2
    for said in ("'Lock3' between 'slide' and 'knob' is taken for a lock", "'LimitDistance1'"):
        assert any(said in note for note in mechanism.notes)


def test_mates_with_planes_of_the_assembly_are_with_what_is_held(tmp_path):
    """Exporters name the assembly itself by its own identifier."""
    tree = instance("base", (1, 0, 0), grounded="true") + instance("slide")
    mates = mate("Coincident", "top", ("machine", "plane", (0, 0, 0.5), Z), ("slide", "plane", (0, 0, 0.5), Z))
    (joint,) = load(tmp_path, tree, mates=mates).mechanism().all_joints
    assert joint.kind == "planar" and joint.parts == ("base", "slide")
