"""Find loops of four bars that lie flat within rounding, and move their pins so that they lie flat exactly.

A planar loop of four hinges with the links l_i, the distances between its pins, can lie flat where

    l_1 +- l_2 +- l_3 +- l_4 = 0

for some choice of signs. Two motions cross in that pose, a change point: a parallelogram can go on as one, or fold
over. Links that miss this by the rounding of a file fold over, or stop short of the pose; which of the two, the
rounding decides. Where one of the four axes is a slide, two of the links make way for the distance of the two pins
beside it, measured across the slide: a crank and a rod of equal length, whose pin slides on a line through the hinge of
the crank, can lie flat.

Each pin is moved on both of its parts alike, so that the assembled pose stays closed. Of all moves with which the loops
lie flat the least are taken, by Newton's method with steps of least norm.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise, product
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Vector, cross
from jaxkin.joints.joint import Joint
from jaxkin.linkage.planes import ALIGNED
from jaxkin.topology.components import connected
from jaxkin.topology.graph import Circuit, WalkStep
from jaxkin.topology.structure import Structure

EXACT = 1e-13
"""How far a sum of links may be from zero, over the size of the loops, and count as zero: rounding of float64."""
_AXES = 4
"""Number of axes that act in the plane of a loop with one freedom."""
_DEPENDENT = 1e-4
"""Singular values of the derivatives of sums, over the largest, that count as zero: above errors, below angles."""
_ITERATIONS = 4
"""Steps of Newton's method: three take a relative error of 1e-3 below rounding."""

PinDisplacements = Mapping[int, Vector]
"""Displacements of the pins of joints, by number of the joint; the others stay where they are."""


class Axis(NamedTuple):
    """An axis of a joint in the assembled pose, world coordinates."""

    joint: int
    turns: bool
    """Whether it is that of a rotation, else of a translation."""
    point: Vector
    direction: Vector


class Link(NamedTuple):
    """A distance between two parallel pins."""

    first: Axis
    second: Axis
    across: Vector | None = None
    """Direction in which the distance is measured, with a sign; None for that of the axes from each other."""

    def length(self, moves: PinDisplacements) -> tuple[float, Vector]:
        """Measure the link after moves of its pins, and differentiate it by the move of the second one."""
        one, other = (pin.point + moves.get(pin.joint, 0.0) for pin in (self.first, self.second))
        apart, normal = other - one, self.first.direction
        if self.across is not None:
            return float(self.across @ apart), self.across
        apart = apart - (apart @ normal) * normal
        length = float(np.linalg.norm(apart))
        return length, apart / max(length, np.finfo(float).tiny)


class FlatLoop(NamedTuple):
    """A loop that can lie flat: sums of its links, with signs, are zero then."""

    links: tuple[Link, ...]
    signs: Float[np.ndarray, "sums links"]

    def sums(self, moves: PinDisplacements) -> Float[np.ndarray, " sums"]:
        """Compute the sums of the links after moves of pins."""
        return self.signs @ np.array([link.length(moves)[0] for link in self.links])

    def off_by(self) -> float:
        """Compute the largest of the sums as the loop is assembled."""
        return float(np.abs(self.sums({})).max())

    @property
    def joints(self) -> tuple[int, ...]:
        """Numbers of the joints of its pins."""
        return tuple(dict.fromkeys(pin.joint for link in self.links for pin in (link.first, link.second)))


def flat_loops(joints: Mapping[int, Joint], ends: Mapping[int, tuple[str, str]], noise: float) -> list[FlatLoop]:
    """Find the loops of four axes in a plane that lie flat if each pin is moved by at most `noise`, a length.

    `joints` are those of a loop group by number, and `ends` the bodies of part 1 and part 2 of each. Loops with links
    as short as the noise are left out.
    """
    found, most = [], 2 * _AXES * noise  # each pin is an end of two links
    for circuit in circuits(ends):
        links = _links(_axes_in_plane(joints, circuit))
        lengths = np.array([link.length({})[0] for link in links])
        if not links or min(length for link, length in zip(links, lengths, strict=True) if link.across is None) <= most:
            continue
        signs = np.array([(1.0, *rest) for rest in product((1.0, -1.0), repeat=len(links) - 1)])
        if len(near := signs[np.abs(signs @ lengths) <= most]):
            found.append(FlatLoop(links, near))
    return found


def bodies_of(structure: Structure, joints: Mapping[int, Joint]) -> dict[int, tuple[str, str]]:
    """Map joints, by number, to the bodies of part 1 and part 2: fixed joints make one body of their parts."""
    ends = {n: tuple(structure.row_of[part] for part in structure.joint_parts[n]) for n in joints}
    welds = [ends[n] for n, joint in joints.items() if not joint.freedoms]
    groups = connected({row for pair in ends.values() for row in pair}, welds)
    body = {row: min(group) for group in groups for row in group}
    return {n: (body[one], body[other]) for n, (one, other) in ends.items()}


def laid_flat(
    loops: Sequence[FlatLoop], joints: Mapping[int, Joint], noise: float, size: float
) -> dict[int, Joint] | None:
    """Move the pins of loops of some `size` by at most `noise` each, so that all loops lie flat; None where that fails.

    `joints` are those of `flat_loops`. Returns those that moved, by number. Axes that coincide stay so.
    """
    turning = [axis for number, joint in joints.items() for axis in _axes(number, joint) if axis.turns]
    coaxial = [(a.joint, b.joint) for a, b in combinations(turning, 2) if _on_one_axis(a, b, ALIGNED * size)]
    column = {joint: 3 * number for number, group in enumerate(connected(joints, coaxial)) for joint in group}
    total = np.zeros(3 * (1 + max(column.values(), default=0)))
    for _ in range(_ITERATIONS):
        moves = {joint: total[first : first + 3] for joint, first in column.items()}
        off = np.concatenate([loop.sums(moves) for loop in loops])
        if np.abs(off).max() <= EXACT * size:
            return {joint: _moved(joints[joint], move) for joint, move in moves.items() if move.any()}
        slopes = np.concatenate([_slopes(loop, moves, column, len(total)) for loop in loops])
        # a sum that follows from others does so but for products of errors
        total = total - np.linalg.lstsq(slopes, off, rcond=_DEPENDENT)[0]
        if not np.abs(total).max() <= noise:
            return None
    return None


def _slopes(
    loop: FlatLoop, moves: PinDisplacements, column: Mapping[int, int], count: int
) -> Float[np.ndarray, "sums columns"]:
    """Differentiate the sums of a loop by the moves of pins, of each from its first column on."""
    by_move = np.zeros((len(loop.links), count))
    for row, link in zip(by_move, loop.links, strict=True):
        _, slope = link.length(moves)
        for pin, side in ((link.first, -1.0), (link.second, 1.0)):
            row[column[pin.joint] : column[pin.joint] + 3] += side * slope
    return loop.signs @ by_move


def _on_one_axis(one: Axis, other: Axis, near: float) -> bool:
    """Tell whether two pins are nearly on one axis."""
    apart = np.cross(other.point - one.point, one.direction)
    return bool(np.linalg.norm(apart) <= near and _parallel(one.direction, other.direction))


def _moved(joint: Joint, move: Vector) -> Joint:
    frames = np.array(joint.frames_1)
    frames[:, :3, 3] += move
    return replace(joint, frames_1=frames, frames_2=frames)


def circuits(ends: Mapping[int, tuple[str, str]]) -> Iterator[Circuit]:
    """List the circuits of at most four joints between bodies, each once."""
    around = defaultdict(list)
    for joint, (one, other) in ends.items():
        around[one].append((WalkStep(joint, 1), other))
        around[other].append((WalkStep(joint, -1), one))

    def further(walk: Circuit, passed: tuple[str, ...]) -> Iterator[Circuit]:
        if passed[0] == passed[-1]:
            yield walk
        elif len(walk) < _AXES:
            for step, body in around[passed[-1]]:
                # each circuit begins with the first of its joints, from part 1 to part 2
                if step.joint > walk[0].joint and body not in passed[1:]:
                    yield from further((*walk, step), (*passed, body))

    for joint, (one, other) in ends.items():
        if one != other:
            yield from further((WalkStep(joint, 1),), (one, other))


def _axes_in_plane(joints: Mapping[int, Joint], circuit: Circuit) -> list[Axis]:
    """List the axes that act in the plane of a circuit, in the order of travel; none where it has no plane.

    Turns that would tilt the plane rest: one about another axis, and all of a ball but that about the normal; those of
    the two balls of a rod, too, but for its spin.
    """
    own = [joints[number] for number, _ in circuit]
    movements = [MOVEMENTS[name] for joint in own for name in joint.movements]
    balls = [place for place, joint in enumerate(own) if any(MOVEMENTS[name].ball for name in joint.movements)]
    rod = len(balls) == 2 and balls[1] - balls[0] in (1, len(circuit) - 1)
    if any(each.has_pitch or each.follows for each in movements) or not all(joint.coincides for joint in own):
        return []
    hinges = [axis.direction for number, _ in circuit for axis in _axes(number, joints[number]) if axis.turns]
    for normal in hinges[:2] if rod or len(balls) < 2 else ():
        axes = [axis for number, sign in circuit for axis in _axes(number, joints[number], normal)[::sign]]
        acting = [axis for axis in axes if axis.turns == _parallel(axis.direction, normal)]
        tilts = sum(not _parallel(direction, normal) for direction in hinges)
        slides = [axis.direction for axis in acting if not axis.turns]
        if tilts <= (0 if balls else 1) and all(abs(slide @ normal) <= ALIGNED for slide in slides):
            return acting
    return []


def _axes(number: int, joint: Joint, of_balls: Vector | None = None) -> list[Axis]:
    """List the axes of a joint from part 1 to part 2: of a ball the one given, or none."""
    axes: list[Axis] = []
    for frame, name in zip(np.asarray(joint.frames_1, float), joint.movements, strict=True):
        if not MOVEMENTS[name].ball:
            elements = MOVEMENTS[name].elements
            axes += [Axis(number, each.kind == "rotate", frame[:3, 3], frame[:3, each.axis]) for each in elements]
        elif of_balls is not None:
            axes.append(Axis(number, True, frame[:3, 3], of_balls))
    return axes


def _parallel(one: Vector, other: Vector) -> bool:
    return bool(np.linalg.norm(cross(one, other)) <= ALIGNED)


def _links(axes: Sequence[Axis]) -> tuple[Link, ...]:
    """List the links of a loop of four axes, of which one at most is a slide; none of other loops."""
    slides = [place for place, axis in enumerate(axes) if not axis.turns]
    if len(axes) != _AXES or len(slides) > 1:
        return ()
    first = slides[0] + 1 if slides else 0
    axes = [*axes[first:], *axes[:first]]
    pins = axes[: _AXES - len(slides)]
    links = [Link(one, other) for one, other in pairwise(pins)]
    if not slides:
        return *links, Link(pins[-1], pins[0])
    return *links, Link(pins[-1], pins[0], np.cross(pins[0].direction, axes[-1].direction))
