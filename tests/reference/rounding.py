"""Mechanisms as others write them down: placed anywhere, in any unit, their numbers rounded."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from jaxkin.examples import path
from jaxkin.geometry.pose import frame
from jaxkin.io.load import load
from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import cylindrical
from jaxkin.mechanism.mechanism import Mechanism
from reference import catalogue, mechanisms, overconstrained

Array = np.ndarray


def schmidt_coupling(angle=0.4) -> Mechanism:
    """Three discs on parallel axes, each two neighbours joined by three links of one length: mobility 1 where counting
    in the plane gives -1 (Schmidt, US patent 3,242,694); the third disc, on a shaft, turns as the first."""
    links, radius, joints = 3, 30.0, []
    centres = [np.array([0.0, 0.0]), np.array([42.0, 11.0]), np.array([75.0, -20.0])]
    joints += [
        mechanisms.revolute(name, "ground", disc, point=(*centre, 0.0), axis=mechanisms.Z)
        for name, disc, centre in (("in", "disc 0", centres[0]), ("out", "disc 2", centres[2]))
    ]
    for stage in range(2):
        for number in range(links):
            turn = angle + 2 * np.pi * number / links + stage
            pin = radius * np.array([np.cos(turn), np.sin(turn)])
            link = f"link {stage}{number}"
            for end, disc in (("a", stage), ("b", stage + 1)):
                place = (*(centres[disc] + pin), 0.0)
                joints.append(mechanisms.revolute(f"{link}{end}", f"disc {disc}", link, point=place, axis=mechanisms.Z))
    return Mechanism.build(fixed=["ground"], joints=joints)


def spherical_wrist() -> Mechanism:
    """A platform on three chains of three hinges, all axes through one point: it turns to any attitude within reach,
    three freedoms, where counting gives -3 (Gosselin and Hamel, 1994, ICRA: the agile eye)."""
    joints = []
    for number in range(3):
        turn = Rotation.from_euler("z", 2 * np.pi * number / 3)
        axes = [turn.apply(axis) for axis in ([1.0, 0.2, -0.8], [-0.3, 1.0, 0.1], [0.9, -0.1, 0.7])]
        chain = ("ground", f"lower {number}", f"upper {number}", "platform")
        for k, (axis, away) in enumerate(zip(axes, (0.05, 0.06, 0.04), strict=True)):
            joints.append(mechanisms.revolute(f"{'abc'[k]}{number}", *chain[k : k + 2], point=away * axis, axis=axis))
    return Mechanism.build(fixed=["ground"], joints=joints)


def five_bar() -> Mechanism:
    """Two freedoms: both bars at the ground can be driven."""
    points = {"A": (0, 0), "B": (-20, 45), "C": (35, 90), "D": (85, 50), "E": (70, 0)}
    return catalogue.pinned(points, {"ground": "AE", "left": "AB", "upper": "BC", "lower": "CD", "right": "DE"})


def written_down(exact: Mechanism, digits: int, seed: int = 0) -> Mechanism:
    """The mechanism somewhere else, as its numbers of so many digits say it."""
    joints = rounded(placed(exact.all_joints, np.random.default_rng(seed)), digits)
    return Mechanism.build(fixed=list(exact.fixed), joints=joints)


def tilted_fourbar(tilt: float, **options) -> Mechanism:
    """A planar four-bar by hand with one axis out of parallel; at the assembled pose C does not turn, so that to first
    order the tilt does not show."""
    axis, up = (np.sin(tilt), 0.0, np.cos(tilt)), (0, 0, 1)
    joints = [
        mechanisms.revolute("A", "ground", "crank", point=(0, 0, 0), axis=up),
        mechanisms.revolute("B", "crank", "coupler", point=(1, 0, 0), axis=up),
        mechanisms.revolute("C", "coupler", "rocker", point=(3.2, 2.9, 0), axis=axis),
        mechanisms.revolute("D", "ground", "rocker", point=(4, 0, 0), axis=up),
    ]
    return Mechanism.build(fixed=["ground"], joints=joints, **options)


def _from_solids(name: str, fixed: str) -> Callable[[], Mechanism]:
    return cache(lambda: load(path(name)).mechanism(fixed=[fixed]))


EVERY: dict[str, Callable[[], Mechanism]] = {
    **{
        each.__name__: each
        for each in (
            *(catalogue.andrews, catalogue.antiparallelogram, catalogue.cam_roller, catalogue.delta),
            *(catalogue.hexapod, catalogue.jansen, catalogue.oldham, catalogue.parallelogram, catalogue.peaucellier),
            *(catalogue.quick_return, catalogue.sarrus, catalogue.scotch_yoke, catalogue.stephenson),
            *(catalogue.swash_plate, catalogue.watt, overconstrained.bricard_linkage),
            *(overconstrained.goldberg_linkage, overconstrained.missing_axes, overconstrained.wrist),
            *(mechanisms.ball_in_bore, mechanisms.bennett_linkage, mechanisms.cam, mechanisms.cardan_shafts),
            *(mechanisms.planar_fourbar, mechanisms.rssr_linkage, mechanisms.slider_crank),
            *(mechanisms.spherical_linkage, schmidt_coupling, spherical_wrist),
        )
    },
    "five_bar": five_bar,
    "kite": lambda: mechanisms.planar_fourbar(1.0, ground=50.0, crank=50.0, coupler=120.0, rocker=120.0),
    "three cranks": lambda: catalogue.parallelogram(3),
    "parallel links, cylindrical": lambda: catalogue.parallelogram(4, pin=cylindrical),
    "shaft in contacts": lambda: overconstrained.shaft_in_contacts(5),
    "Fig. 3": _from_solids("eighteen_bars", "p1"),
    "Fig. 6": _from_solids("cam", "frame"),
    "Fig. 7": _from_solids("air_cylinder", "p1"),
}
"""The catalogue, what is overconstrained, and the paper's examples."""


def placed(joints: Sequence[Joint], rng: np.random.Generator) -> tuple[Joint, ...]:
    """The joints turned, moved and scaled at random: by up to their extent, and by up to a thousand."""
    origins = np.concatenate([joint.frames_1[:, :3, 3] for joint in joints])
    pose, scale = np.eye(4), 10.0 ** rng.uniform(-3, 3)
    pose[:3, :3] = Rotation.random(random_state=rng).as_matrix()
    pose[:3, 3] = rng.uniform(-1, 1, 3) * np.ptp(origins)

    def moved(frames: Array) -> Array:
        frames = pose @ frames
        frames[:, :3, 3] *= scale
        return frames

    return tuple(
        replace(
            joint, frames_1=moved(joint.frames_1), frames_2=moved(joint.frames_2), pitch=np.asarray(scale * joint.pitch)
        )
        for joint in joints
    )


def rounded(joints: Sequence[Joint], digits: int) -> tuple[Joint, ...]:
    """The joints with all numbers of their points and axes rounded to decimals of the largest coordinate."""
    size = max(float(np.abs(joint.frames_1[:, :3, 3]).max()) for joint in joints) or 1.0

    def number(values: Array, of: float) -> Array:
        return np.round(values / of, digits) * of

    def moved(pose: Array) -> Array:
        return frame(number(pose[:3, 3], size), number(pose[:3, 2], 1.0), number(pose[:3, 0], 1.0))

    return _with_frames(joints, moved)


def tilted(joints: Sequence[Joint], angle: float, rng: np.random.Generator) -> tuple[Joint, ...]:
    """The joints with every frame turned about its own origin by up to an angle."""

    def moved(pose: Array) -> Array:
        turned = pose.copy()
        turned[:3, :3] = Rotation.from_rotvec(rng.uniform(-1, 1, 3) * angle / np.sqrt(3)).as_matrix() @ pose[:3, :3]
        return turned

    return _with_frames(joints, moved)


def _with_frames(joints: Sequence[Joint], moved: Callable[[Array], Array]) -> tuple[Joint, ...]:
    found = []
    for joint in joints:
        frames = np.array([moved(np.asarray(pose)) for pose in joint.frames_1])
        found.append(replace(joint, frames_1=frames, frames_2=frames))
    return tuple(found)
