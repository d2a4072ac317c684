"""Close the loops of a mechanism whose given pose is open, without a drive, and place its joints anew there.

Joints are written down where they are in the pose of a drawing or a robot file. Where that pose is open, by a gap in
the file or lengths that were changed, its loops are closed by damped Newton steps (host code, float64, no compilation).
Which of several assembly modes is meant the steps do not know: other starts, about as far away as the loops had to go,
tell whether there is another one near.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.motions import MOVEMENTS
from jaxkin.geometry.pose import Pose, inverse
from jaxkin.geometry.traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import chain, freedoms
from jaxkin.motion.closed_loops import ClosedLoops, Row
from jaxkin.motion.open_loops import Opening, opening, stays_open
from jaxkin.topology.names import listed
from jaxkin.topology.rates import independent, null_space

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism

STARTS = 12
"""Other starts from which each structure element is closed."""
NEAREST = 0.1
"""Radians, or characteristic lengths: other starts are at least so far away, however little the loops had to move."""
APART = 1e-6
"""Radians, or characteristic lengths, between poses that are not the same: far above what closure leaves."""


@dataclass(frozen=True)
class Move:
    """How far a part was moved."""

    length: float
    """The largest displacement of the origin of one of its joints, in the unit of the mechanism."""
    angle: float
    """Radians."""


@dataclass(frozen=True, eq=False)
class Reassembly:
    """A mechanism with its loops closed. `print` it."""

    mechanism: Mechanism
    """Its assembled pose is the one found; as it was given where that stays open."""
    closed: bool
    """Whether all loops close."""
    residual_before: float
    """Square root of Eq. 12 of the given pose, lengths over the characteristic length."""
    residual: float
    """The same of the pose found."""
    moves: Mapping[str, Move]
    """How far each part was moved."""
    others: tuple[float, ...]
    """Distances, in radians and characteristic lengths, to the poses of other assembly modes that other starts led to
    with the same displacements of a set of coordinates that determine the pose."""
    starts: int
    """How many other starts were tried."""
    left: Opening | None
    """What stays open; None where nothing does."""

    def __str__(self) -> str:
        if self.left is not None:
            return (
                f"the loops cannot be closed from the given pose: the residual fell from {self.residual_before:.2g} to "
                f"{self.residual:.2g}; {self.left}. Check the numbers of these joints, or begin nearer to a closed pose"
            )
        if not any(move.length or move.angle for move in self.moves.values()):
            return f"closed as given: residual {self.residual_before:.1g}; no part was moved"
        unit = f" {self.mechanism.unit}".rstrip()
        moves = sorted(self.moves.items(), key=lambda item: -item[1].length)
        said = listed([f"{part} {move.length:.3g}{unit}, {move.angle:.3g} rad" for part, move in moves if move.angle])
        lines = [f"closed: residual {self.residual_before:.2g} before, {self.residual:.1g} now; moved: {said}"]
        if self.others:
            lines.append(
                f"{len(self.others)} of {self.starts} other starts led to another assembly mode, the nearest "
                f"{min(self.others):.2g} away: look at the pose, and give one nearer to what is meant if it is not this"
            )
        elif self.starts:
            lines.append(f"{self.starts} other starts led to no other assembly mode")
        return "\n".join(lines)


def close(mechanism: Mechanism) -> Reassembly:
    """The mechanism with its loops closed: see `Mechanism.close`."""
    if traced(mechanism):
        raise ValueError(
            "close() is for numbers: inside jit, vmap and grad sweep the mechanism, which closes its loops"
        )
    coordinates = {index: np.zeros(joint.freedoms) for index, joint in enumerate(mechanism.all_joints)}
    before, after, others, starts = 0.0, 0.0, [], 0
    for block in mechanism.structure.blocks:
        loops = ClosedLoops(mechanism, block)
        home = loops.travel(np.zeros(len(loops.columns)))
        before = float(np.hypot(before, home.gap))
        if home.gap <= loops.noise.closed:
            after = float(np.hypot(after, home.gap))
            continue
        q, found = loops.closed(np.zeros(len(loops.columns)))
        after = float(np.hypot(after, found.gap))
        for index in block.joints:
            coordinates[index] = q[loops.slices[index]] * loops.units[loops.slices[index]]
        if found.gap <= loops.noise.closed:
            others += _other_modes(loops, q)
            starts += STARTS
    if left := stays_open(mechanism):
        rest = {part: Move(0.0, 0.0) for part in mechanism.parts}
        return Reassembly(mechanism, False, before, after, rest, (), 0, left)
    places = _places(mechanism, coordinates)
    moves = {part: _move(mechanism, part, places[mechanism.structure.row_of[part]]) for part in mechanism.parts}
    if opening(mechanism) is None:
        return Reassembly(mechanism, True, before, after, moves, (), 0, None)
    joints = [
        _placed(joint, places[mechanism.structure.row_of[joint.parts[0]]], coordinates[index])
        for index, joint in enumerate(mechanism.all_joints)
    ]
    closed = replace(mechanism, all_joints=tuple(joints), ideal=(), solids=(), contacts={}, known_forms=None)
    return Reassembly(closed, True, before, after, moves, tuple(sorted(others)), starts, None)


def _other_modes(loops: ClosedLoops, q: Row) -> list[float]:
    """How far away the poses are that other starts lead to, a set of coordinates that determine the pose held."""
    found = loops.travel(q)
    motions = null_space(found.jacobian, loops.noise)[1]
    held: list[int] = []
    for column in range(len(q)):
        if independent(motions, [*held, column], loops.noise) == len(held) + 1:
            held.append(column)
    rng, distances = np.random.default_rng(0), []
    reach = max(NEAREST, float(np.abs(q).max(initial=0.0)))
    for _ in range(STARTS):
        start = q + reach * rng.uniform(-1.0, 1.0, len(q)) * ~np.isin(np.arange(len(q)), held)
        there = loops.closed(start, held)[1]
        apart = max(float(np.abs(there.places[part] - place).max()) for part, place in found.places.items())
        if there.gap <= loops.noise.closed and apart > APART:
            distances.append(apart)
    return distances


def _places(mechanism: Mechanism, coordinates: Mapping[int, Float[np.ndarray, " k"]]) -> dict[str, Pose]:
    """Displacements of the rows of parts, in world coordinates, from the fixed ones along the joints."""
    row_of = mechanism.structure.row_of
    places = {row_of[mechanism.fixed[0]]: np.eye(4)}
    joints = list(enumerate(mechanism.all_joints))
    while joints:
        waiting = []
        for index, joint in joints:
            one, other = (row_of[part] for part in joint.parts)
            step = _displacement(joint, coordinates[index])
            if one in places:
                places.setdefault(other, places[one] @ step)
            elif other in places:
                places[one] = places[other] @ inverse(step)
            else:
                waiting.append((index, joint))
        if len(waiting) == len(joints):
            break
        joints = waiting
    return places


def _displacement(joint: Joint, q: Float[np.ndarray, " k"]) -> Pose:
    before, after = (np.asarray(side, float) for side in (joint.before, joint.after))
    return chain(joint.movements, before, q, float(joint.pitch), after)[0]


def _placed(joint: Joint, place: Pose, q: Float[np.ndarray, " k"]) -> Joint:
    """The joint in its new place, the frames on its two parts the same.

    Each frame goes along with all elementary motions of its movement but the last one: from there on the movement is
    what it was, whatever the last one has turned or shifted.
    """
    frames, start = [], 0
    for number, name in enumerate(joint.movements):
        before, after = (np.asarray(side, float)[number : number + 1] for side in (joint.before, joint.after))
        own = q[start : start + freedoms([name])]
        start += len(own)
        most = own.copy()
        if MOVEMENTS[name].elements:
            most[MOVEMENTS[name].elements[-1].coordinate] = 0.0
        frames.append(place @ chain([name], before, most, float(joint.pitch))[0] @ before[0])
        place = place @ chain([name], before, own, float(joint.pitch), after)[0]
    stacked = np.array(frames)
    return replace(joint, before=stacked, after=stacked)


def _move(mechanism: Mechanism, part: str, place: Pose) -> Move:
    sides = [
        np.asarray(side, float)[frame, :3, 3]
        for joint in mechanism.all_joints
        for own, side, frame in zip(joint.parts, (joint.before, joint.after), (0, -1), strict=True)
        if own == part
    ]
    origins = np.array(sides).reshape(-1, 3)
    shifts = origins @ place[:3, :3].T + place[:3, 3] - origins
    turn = place[:3, :3]
    sine = np.linalg.norm([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return Move(float(np.linalg.norm(shifts, axis=1).max(initial=0.0)), float(np.arctan2(sine, np.trace(turn) - 1.0)))
