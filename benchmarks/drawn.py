"""Joints found in kinds of machines that are drawn with known ones: `uv run --group cad python benchmarks/drawn.py`.

Each kind of `benchmarks/drawings` is drawn at sizes, with plays, at a place and in an order at random, written as a
STEP file, in millimetres or inches, read, and its joints are held against those that were meant. Verdicts are those of
`benchmarks/cad.py`; a joint that is other than meant contradicts the truth, one that is missed does not. Of these some
are joints that exact contacts determine, which no inference may change: they are counted apart.

    python benchmarks/drawn.py [KIND...] [--seeds 0,1] [--verbose]
"""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

import numpy as np
from cad import BY_CONTACTS, COORDINATES, METRE, VERDICTS, bodies_of, by_contacts, useless
from drawings.drawing import KINDS, Drawing, TrueJoint, write

import jaxkin as jk

MAX_ANGLE, MAX_OFFSET = 1e-3, 0.1
"""Radians and millimetres between axes that are the same, as of `benchmarks/cad.py`."""


class Place(NamedTuple):
    """Where a drawing lies in its file."""

    turn: np.ndarray
    shift: np.ndarray
    millimetre: float
    """In the unit of the file."""

    def point(self, point: np.ndarray) -> np.ndarray:
        return (self.turn @ point + self.shift) * self.millimetre


def true_mechanism(drawing: Drawing) -> jk.Mechanism:
    """Build the mechanism of the joints that were meant."""
    joints = []
    for number, each in enumerate(drawing.joints):
        at = {"Weld": {}, "Spherical": {"point": each.point}}.get(each.kind, {"point": each.point, "axis": each.axis})
        make = jk.fixed if each.kind == "Weld" else getattr(jk, each.kind.lower())
        joints.append(make(f"{number} {each.kind}", *each.parts, **at))
    jointed = {part for joint in joints for part in joint.parts}
    return jk.Mechanism.build(fixed=[part for part in drawing.fixed if part in jointed], joints=joints, align=1e-3)


def verdict(wanted: TrueJoint, found: jk.Mechanism, idle: set[str], truly_idle: set[str], place: Place) -> str:
    """Judge the joint of two bodies, with what it is where it is not the one that was meant."""
    body = bodies_of(found)
    one, other = (body[part] for part in wanted.parts)
    coordinates = COORDINATES.get(wanted.kind)
    if one == other:
        return (
            "right"
            if wanted.kind == "Weld"
            else "idle"
            if coordinates and coordinates <= truly_idle
            else "other: one body"
        )
    between = [joint for joint in found.all_joints if {body[part] for part in joint.parts} == {one, other}]
    if not between and wanted.kind == "Revolute" and _turn_on_a_third(found, body, one, other, wanted, place):
        return "right"
    if not between:
        return "missed"
    told = [_of_one(wanted, joint, coordinates, idle, truly_idle, place) for joint in between]
    judged = told[0] if len({*told}) == 1 else f"other: {len(between)} joints"
    exact = judged.startswith("other") and all(by_contacts(joint) for joint in between)
    return f"{judged} {BY_CONTACTS}" if exact else judged


def _of_one(
    wanted: TrueJoint,
    joint: jk.Joint,
    coordinates: set[str] | None,
    idle: set[str],
    truly_idle: set[str],
    place: Place,
) -> str:
    """Judge one joint of two bodies; those of a shaft in the bearings of two parts that are screwed together agree."""
    got = set(joint.coordinates)
    offset = joint.frames_1[0][:3, 3] - place.point(wanted.point)
    if wanted.kind == "Spherical":
        same = joint.kind == "spherical" and np.linalg.norm(offset) < MAX_OFFSET * place.millimetre
        return "right" if same else f"other: {joint.kind}"
    if coordinates is None or joint.kind not in ("revolute", "cylindrical", "prismatic"):
        return f"other: {joint.kind}"
    more = {name for name in got - coordinates if f"{joint.name}.{name}" in idle}
    if wanted.kind == "Weld":
        return "idle" if more == got else f"other: {joint.kind}"
    axis = place.turn @ wanted.axis
    apart = np.linalg.norm(offset - (offset @ axis) * axis) / place.millimetre
    tilt = np.linalg.norm(np.cross(joint.frames_1[0][:3, 2], axis))
    if tilt > MAX_ANGLE or ("phi" in got and apart > MAX_OFFSET):  # a slide has a direction alone
        return f"other: {joint.kind}, axis off by {apart:.2g} mm, {tilt:.2g} rad"
    if got == coordinates:
        return "right"
    return "idle" if got - coordinates <= more and coordinates - got <= truly_idle else f"other: {joint.kind}"


def _turn_on_a_third(
    found: jk.Mechanism, body: dict[str, str], one: str, other: str, wanted: TrueJoint, place: Place
) -> bool:
    """Tell whether two bodies turn on a third one about the axis that was meant: three links on one pin have two
    joints, and it is of no matter to which of them the pin belongs."""
    axis, about = place.turn @ wanted.axis, {one: set[str](), other: set[str]()}
    for joint in found.all_joints:
        offset = joint.frames_1[0][:3, 3] - place.point(wanted.point)
        apart = np.linalg.norm(offset - (offset @ axis) * axis) / place.millimetre
        tilt = np.linalg.norm(np.cross(joint.frames_1[0][:3, 2], axis))
        if joint.kind == "revolute" and apart < MAX_OFFSET and tilt < MAX_ANGLE:
            owners = {body[part] for part in joint.parts}
            for each in owners & {*about}:
                about[each] |= owners - {each}
    return bool(about[one] & about[other])


def judged(drawing: Drawing, found: jk.Mechanism, place: Place) -> list[str]:
    """Judge all joints that were meant."""
    shown, idle, result = useless(true_mechanism(drawing)), useless(found), []
    for number, each in enumerate(drawing.joints):
        name = f"{number} {each.kind}."
        truly_idle = {coordinate[len(name) :] for coordinate in shown if coordinate.startswith(name)}
        result.append(verdict(each, found, idle, truly_idle, place))
    return result


def tried(name: str, seed: int, folder: Path, verbose: bool) -> Counter:
    """Draw, read and judge one kind, print its row, and count."""
    random = np.random.default_rng(seed)
    drawing = KINDS[name](random)
    path = folder / f"{name}_{seed}.step"
    turn, shift = write(drawing, path, random)
    begun = perf_counter()
    assembly = jk.load(path)
    mechanism = assembly.mechanism(fixed=drawing.fixed)
    seconds = perf_counter() - begun
    verdicts = judged(drawing, mechanism, Place(turn, shift, 1e-3 / METRE[assembly.unit]))
    counts = Counter(each.split(":")[0] for each in verdicts)
    counts[BY_CONTACTS] = sum(each.endswith(BY_CONTACTS) for each in verdicts)
    useful, meant = mechanism.mobility().useful, true_mechanism(drawing).mobility().useful
    cells = "".join(f"{counts[each]:8}" for each in VERDICTS)
    print(f"{name:28}{len(drawing.parts):5}{cells}{useful:8} of {meant}{seconds:8.1f}", flush=True)
    for each, joint in zip(verdicts, drawing.joints, strict=True):
        if each not in ("right", "idle"):
            print(f"      {each}, where {' and '.join(joint.parts)} have a {joint.kind}")
    if verbose:
        print(mechanism)
    counts["freedoms"], counts["kinds"] = int(useful == meant), 1
    return counts


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", help=f"of {', '.join(KINDS)}; without any, all")
    parser.add_argument("--seeds", default="0", help="random numbers of sizes and places, such as 0,1,2")
    parser.add_argument("--verbose", action="store_true", help="print the mechanisms")
    said = parser.parse_args()
    if unknown := [name for name in said.kinds if name not in KINDS]:
        parser.error(f"no kind {', '.join(unknown)}; there are {', '.join(KINDS)}")
    print(f"{'kind':28}parts" + "".join(f"{each:>8}" for each in VERDICTS) + "  useful freedoms  seconds")
    total = Counter()
    with TemporaryDirectory() as folder:
        for name in said.kinds or KINDS:
            for seed in map(int, said.seeds.split(",")):
                total += tried(name, seed, Path(folder), said.verbose)
    joints = sum(total[each] for each in VERDICTS)
    said_of = ", ".join(f"{total[each]} {each}" for each in VERDICTS)
    print(f"{joints} joints: {said_of}; {100 * total['other'] / joints:.1f} % contradict the truth")
    inferred = total["other"] - total[BY_CONTACTS]
    print(f"{inferred} of them are inferred ({100 * inferred / joints:.1f} %), the others are those of exact contacts")
    print(f"{total['freedoms']} of {total['kinds']} have the right number of useful freedoms")


if __name__ == "__main__":
    main()
