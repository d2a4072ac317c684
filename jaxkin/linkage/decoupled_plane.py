"""Find the plane in which a loop group moves though some of its joints could leave it (host code, numbers only).

The rod of a hydraulic cylinder turns in its tube, and a pin slides in its hole; where all hinges of the loops are
parallel, neither moves. With n the direction of the hinges, the twists of turns about n and of slides at right angles
to n keep to the plane; those of turns at right angles to n and of slides along n leave it. At first order, the loops
say of the rates e of the former and o of the latter

    J_e e + J_eo o = 0    (rotation about n, translations across n),
    J_o o = 0             (rotations across n, translation along n),

since no rate e leaves the plane. Where the second line says o = 0, the loops move in the plane, by three equations
each, while o rests. Where it leaves motions o undetermined, these motions must be idle: go on while e rests, as the
spin of a rod between hinges in its line does. Then the solution of least norm has o = 0, too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from jaxkin._traced import traced
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.partial_movement import remaining
from jaxkin.geometry.pose import cross, frame
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import DEPENDENT
from jaxkin.linkage.first_order import null_space
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.planes import ALIGNED, ElementaryAxes, elementary_axes, level
from jaxkin.topology.structure import LoopGroup, Structure

FAR = 0.05
"""How far idle motions are followed, radians or characteristic lengths. A motion that closes the loops to first order
only leaves them open by its square, 1e-3, and is undone when they are closed."""
KEPT = 0.99
"""Share of a motion that is left of an idle one when the loops are closed: all but its square, 0.0025. In a combination
of ten motions, of which one is undone, 0.9 is left."""


def decoupled_plane(joints: Sequence[Joint], structure: Structure, loop_group: LoopGroup) -> tuple[int, ...] | None:
    """Find the columns of the coordinates that act in the plane while all others rest; None where there is no plane.

    Columns are numbered from 0 through all coordinates of the joints of the loop group; `joints` are all joints of the
    structure. The normal is the direction about which most joints turn, of those for which the others rest. Of a ball,
    one axis of the frames must be normal to the plane. Frames of a joint on its two parts must differ by a motion in
    the plane only, as changes of lengths in the plane leave them.
    """
    own = [joints[joint] for joint in loop_group.joints]
    if not loop_group.loops or traced(own) or (axes := elementary_axes(own, of_balls=True)) is None:
        return None
    # Changed lengths leave loops open, but directions as they are: loops of the frames on part 1 are closed. Couplings
    # need not be looked at: loops that they tie out of the plane are solved in space (`solved_coordinates`).
    assembled = [replace(joint, frames_2=joint.frames_1) for joint in joints]
    uncoupled = replace(loop_group, couplings=())
    for normal in _directions(axes[0]):
        columns = _acting_in_plane(axes, normal)
        if columns is None or not _can_rest(own, columns) or not level(own, normal) or _tilted(own, normal):
            continue
        loops = ClosedLoops(assembled, structure, uncoupled)
        if _others_rest(loops, columns, normal, _ball_columns(own)):
            return columns
    return None


def _directions(turning: ElementaryAxes) -> Iterator[np.ndarray]:
    """Yield the directions of the axes of turns on part 1, those of most turns first."""
    found: list[tuple[np.ndarray, int]] = []
    for _, axis, _ in turning:
        for place, (known, count) in enumerate(found):
            if np.linalg.norm(cross(known, axis)) <= ALIGNED:
                found[place] = known, count + 1
                break
        else:
            found.append((axis, 1))
    yield from (axis for axis, _ in sorted(found, key=lambda each: -each[1]))


def _acting_in_plane(axes: tuple[ElementaryAxes, ElementaryAxes], normal: np.ndarray) -> tuple[int, ...] | None:
    """List the columns that act in the plane with a normal; None where an axis is oblique to it."""
    columns = []
    for slides, entries in zip((False, True), axes, strict=True):
        for column, *both in entries:
            perpendicular = all(abs(axis @ normal) <= ALIGNED for axis in both)
            parallel = all(np.linalg.norm(cross(axis, normal)) <= ALIGNED for axis in both)
            if not (perpendicular or parallel):
                return None
            if perpendicular if slides else parallel:
                columns.append(column)
    return tuple(sorted(columns))


def _tilted(joints: Sequence[Joint], normal: np.ndarray) -> bool:
    """Tell whether the frames of a joint on its two parts differ by a turn about another line than the normal.

    Coordinates out of the plane would have to undo that turn, and could not rest.
    """
    for joint in joints:
        sides = np.asarray(joint.frames_1, float)[:, :3, :3], np.asarray(joint.frames_2, float)[:, :3, :3]
        turned_normal = np.einsum("fij,fkj,k->fi", *sides, normal)
        if np.abs(turned_normal - normal).max(initial=0.0) > ALIGNED:
            return True
    return False


def _can_rest(joints: Sequence[Joint], columns: Sequence[int]) -> bool:
    """Tell whether each movement without its coordinates out of the plane, not in `columns`, is a movement, too."""
    chain = [name for joint in joints for name in joint.movements]
    return all(
        remaining(name, [k for k, column in enumerate(own) if column in columns]) is not None
        for name, own in zip(chain, coordinate_ranges(chain), strict=True)
    )


def _ball_columns(joints: Sequence[Joint]) -> set[int]:
    """List the columns of balls."""
    chain = [name for joint in joints for name in joint.movements]
    columns = zip(chain, coordinate_ranges(chain), strict=True)
    return {column for name, own in columns if MOVEMENTS[name].ball for column in own}


def _others_rest(
    loops: ClosedLoops, columns: Sequence[int], normal: Float[np.ndarray, "3"], of_balls: Collection[int]
) -> bool:
    """Tell whether the coordinates out of the plane, those not in `columns`, are held by the loops, or idle.

    `normal` is a unit vector, and `of_balls` are the columns of balls.
    """
    assembled = np.zeros(len(loops.columns))
    count = len(loops.loop_group.loops)
    to_plane = frame(np.zeros(3), normal)[:3, :3].T  # from the axes of the world to axes of which z is the normal
    twists = loops.jacobian(assembled)[: 6 * count].reshape(count, 2, 3, -1)
    twists = np.einsum("ij,lkjc->lkic", to_plane, twists).reshape(count, 6, -1)
    others = np.array([column for column in range(len(assembled)) if column not in columns], int)
    # the blocks J_eo and J_o of the module docstring, in the columns o
    in_plane, out_of_plane = (twists[:, rows][:, :, others].reshape(-1, len(others)) for rows in ([2, 3, 4], [0, 1, 5]))
    motions = null_space(out_of_plane, DEPENDENT)[1]
    if np.abs(in_plane @ motions.T).max(initial=0.0) > DEPENDENT:
        return False
    # Slides along the normal commute with all that happens in the plane, so that they are idle. Only motions that turn
    # something are followed. The angles of a ball are not held meanwhile: a turn about an oblique axis takes all three.
    combinations, turns, _ = np.linalg.svd(motions[:, loops.units[others] == 1.0])
    held = [column for column in columns if column not in of_balls]
    for motion in combinations.T[: int((turns > DEPENDENT).sum())] @ motions:
        begun = np.zeros(len(assembled))
        begun[others] = FAR * motion
        moved, found = loops.closed(begun, held=held)
        if found.residual_norm > loops.thresholds.residual or moved[others] @ motion < KEPT * FAR:
            return False
    return True
