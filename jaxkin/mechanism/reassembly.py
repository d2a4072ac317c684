"""Close the loops of a mechanism whose given pose is open, without a drive, and place its joints anew there.

Joints are written down where they are in the pose of a drawing or a robot file. Where that pose is open, by a gap in
the file or lengths that were changed, its loops are closed by damped Newton steps (host code, float64, no compilation).
Which of several assembly modes is meant the steps do not know: other starts, about as far away as the loops had to go,
tell whether there is another one near.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import several
from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.geometry.pose import Transform, turned_by
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.placed_at import placed_at
from jaxkin.mobility.alignment import asked_noise, extent
from jaxkin.mobility.home_pose import home_pose
from jaxkin.mobility.open_loops import Opening, tell_opening
from jaxkin.mobility.other_modes import STARTS, closed_from_elsewhere, other_modes

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.topology.structure import LoopGroup

_TOLD = 1e-6
"""Moves are told of parts that move by more than this part of what the most moved one does: not by rounding."""


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
    places: Mapping[str, Transform] = field(default_factory=dict)
    """Displacement (4, 4) of each part from the given pose, in world coordinates; empty where no part was moved."""
    coordinates: Mapping[str, Float[np.ndarray, " _"]] = field(default_factory=dict)
    """Displacement of each joint from the given pose, by name, a number for each of its coordinates; empty likewise."""

    def __str__(self) -> str:
        if self.left is not None:
            return (
                f"the loops cannot be closed from the given pose: the residual fell from {self.residual_before:.2g} to "
                f"{self.residual:.2g}; {self.left}. Check the numbers of these joints, or begin nearer to a closed pose"
            )
        least = Move(*(_TOLD * max(sizes) for sizes in zip(*map(astuple, self.moves.values()), strict=True)))
        if not least.length and not least.angle:
            return f"closed as given: residual {self.residual_before:.1g}; no part was moved"
        unit = f" {self.mechanism.unit}".rstrip()
        moves = sorted(self.moves.items(), key=lambda item: -item[1].length)
        said = listed(
            [
                f"{part} by {move.length:.3g}{unit} and {move.angle:.3g} rad"
                for part, move in moves
                if move.length > least.length or move.angle > least.angle
            ]
        )
        lines = [f"closed: residual {self.residual_before:.2g} before, {self.residual:.1g} now; moved: {said}"]
        if self.others:
            lines.append(
                f"{len(self.others)} of {self.starts} other starts led to another assembly mode, the nearest "
                f"{min(self.others):.2g} away: look at the pose, and give one nearer to what is meant if it is not this"
            )
        elif self.starts:
            lines.append(f"{self.starts} other starts led to no other assembly mode")
        return "\n".join(lines)


def close(
    mechanism: Mechanism, hold: Iterable[str] = (), align: float | int | None = None, look_around: bool = True
) -> Reassembly:
    """Close the loops of a mechanism without a drive: see `Mechanism.close`.

    Without `look_around` other assembly modes are not looked for, which takes most of the time.
    """
    noise = asked_noise(align)
    if traced(mechanism):
        raise ValueError(
            "close() is for numbers: inside jit, vmap and grad sweep the mechanism, which closes its loops"
        )
    held = {coordinate(mechanism.linkage, key) for key in several(hold, "hold", "coordinates")}
    given = replace(mechanism.linkage, ideal=())
    groups = [_close_group(given, loop_group, held, noise) for loop_group in given.structure.loop_groups]
    before, after = (float(np.linalg.norm([getattr(group, gap) for group in groups])) for gap in ("before", "after"))
    rest = dict.fromkeys(given.parts, Move(0.0, 0.0))
    if still_open := [group for group in groups if not group.is_closed]:
        worst = max(still_open, key=lambda group: group.after)
        left = tell_opening(given, mechanism.unit, worst.loops, worst.q)
        return Reassembly(mechanism, False, before, after, rest, (), 0, left)
    # the frames of a joint in no loop may differ, too: its part has a place, though nothing has to be solved
    if all(group.loops.coincide for group in groups) and all(joint.coincides for joint in given.joints):
        return Reassembly(mechanism, True, before, after, rest, (), 0, None)
    moved = [group for group in groups if group.q.any()]
    searched = moved if look_around else []
    others = [apart for group in searched for apart in other_modes(group.loops, group.q, group.held)]
    coordinates = [np.zeros(joint.freedoms) for joint in given.joints]
    for group in moved:
        for index, columns in group.loops.slices.items():
            coordinates[index] = (group.q * group.loops.units)[columns]
    by_name = {joint.name: q for joint, q in zip(given.joints, coordinates, strict=True)}
    found, places = placed_at(replace(mechanism, linkage=given), by_name, noise)
    found = replace(found, alignment=(*_rounding(mechanism.unit, moved), *found.alignment))
    moves = {part: _move(given, part, place) for part, place in places.items()}
    starts = STARTS * len(searched)
    return Reassembly(found, True, before, after, moves, tuple(sorted(others)), starts, None, places, by_name)


@dataclass(frozen=True, eq=False)
class _ClosedGroup:
    """What became of the loops of a loop group."""

    loops: ClosedLoops
    q: LoopCoordinates
    """The scaled coordinates found; zero where the loops are closed as they are given."""
    held: list[int]
    """Columns that stay as they are given."""
    before: float
    after: float
    """Square roots of Eq. 12."""
    is_closed: bool
    """Within the rounding of the numbers."""


def _close_group(
    linkage: Linkage, loop_group: LoopGroup, fixed: Container[JointCoordinate], noise: float
) -> _ClosedGroup:
    """Close loops from the given pose; where the steps end at a residual, by the nearest of those from other starts."""
    loops = closed_loops(linkage, loop_group)
    held = [k for k, column in enumerate(loops.columns) if column in fixed]
    before = loops.travel(np.zeros(len(loops.columns))).residual_norm
    q, found, closed = home_pose(loops, held)
    if closed:
        return _ClosedGroup(loops, q, held, before, found.residual_norm, True)
    size = extent([linkage.joints[index] for index in loop_group.joints])
    enough = max(noise * size / loops.length, loops.thresholds.residual)
    if found.residual_norm > enough and (others := closed_from_elsewhere(loops, q, enough, held)):
        q, found = min(others, key=lambda other: float(np.linalg.norm(other[0])))
    return _ClosedGroup(loops, q, held, before, found.residual_norm, found.residual_norm <= enough)


def _rounding(unit: str, moved: Sequence[_ClosedGroup]) -> list[str]:
    """Tell in words how far loops that count as closed stay open, because the numbers given were rounded."""
    left = [group.after * group.loops.length for group in moved if group.after > group.loops.thresholds.residual]
    said = f"{max(left, default=0.0):.1g} {unit}".rstrip()
    return [f"for the rounding of the numbers, loops were closed that stay open by {said}"] if left else []


def _move(linkage: Linkage, part: str, place: Transform) -> Move:
    sides = [
        np.asarray(side, float)[frame, :3, 3]
        for joint in linkage.joints
        for own, side, frame in zip(joint.parts, (joint.frames_1, joint.frames_2), (0, -1), strict=True)
        if own == part
    ]
    origins = np.array(sides).reshape(-1, 3)
    shifts = origins @ place[:3, :3].T + place[:3, 3] - origins
    return Move(float(np.linalg.norm(shifts, axis=1).max(initial=0.0)), turned_by(place))
