"""Find the plane in which a loop group moves though some of its joints could leave it (host code, numbers only).

The rod of a hydraulic cylinder turns in its tube, and a pin slides in its hole; where all hinges of the loops are
parallel, neither moves. With n the direction of the hinges, the twists of turns about n and of slides at right angles
to n keep to the plane; those of turns at right angles to n and of slides along n leave it. At first order, the loops
say of the rates e of the former and o of the latter

    J_e e + J_eo o = 0    (rotation about n, translations across n),
    J_o o = 0             (rotations across n, translation along n),

since no rate e leaves the plane. Where the second line says o = 0, the loops move in the plane, by three equations
each, while o rests. Where it leaves motions o undetermined, these must be idle: go on with e = 0, as the spin of a rod
between hinges in its line does. They are of least norm if o = 0.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.partial_movement import remaining
from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import DEPENDENT
from jaxkin.linkage.first_order import null_space
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.planes import PARALLEL, Axes, elementary_axes, level
from jaxkin.topology.structure import LoopGroup, Structure

FAR = 0.3
"""How far idle motions are followed, radians or characteristic lengths: far enough to tell a motion of second order."""


def decoupled_plane(joints: Sequence[Joint], structure: Structure, loop_group: LoopGroup) -> tuple[int, ...] | None:
    """Find the columns of the coordinates that act in the plane while all others rest; None where there is no plane.

    Columns are numbered from 0 through all coordinates of the joints of the loop group; `joints` are all joints of the
    structure. The normal is the direction about which most joints turn, of those for which the others rest. Of a ball,
    one axis of the frames must be normal to the plane. As in `planes.plane_columns`, frames of a joint on its two parts
    must not differ along the normal.
    """
    inside = [joints[joint] for joint in loop_group.joints]
    if not loop_group.loops or traced(inside) or (axes := elementary_axes(inside, of_balls=True)) is None:
        return None
    # lengths that were changed leave loops open, and directions as they are; couplings tie what stays in the plane
    assembled = [replace(joint, frames_2=joint.frames_1) for joint in joints]
    uncoupled = replace(loop_group, couplings=())
    for normal in _directions(axes[0]):
        columns = _in_plane(axes, normal)
        if columns is None or not _can_rest(inside, columns) or not level(inside, normal):
            continue
        loops = ClosedLoops(assembled, structure, uncoupled)
        if _others_rest(loops, columns, normal, _of_balls(inside)):
            return columns
    return None


def _directions(turning: Axes) -> Iterator[np.ndarray]:
    """Yield the directions of the axes of turns on part 1, those of most turns first."""
    found: list[tuple[np.ndarray, int]] = []
    for _, axis, _ in turning:
        for place, (known, count) in enumerate(found):
            if np.linalg.norm(np.cross(known, axis)) <= PARALLEL:
                found[place] = known, count + 1
                break
        else:
            found.append((axis, 1))
    yield from (axis for axis, _ in sorted(found, key=lambda each: -each[1]))


def _in_plane(axes: tuple[Axes, Axes], normal: np.ndarray) -> tuple[int, ...] | None:
    """List the columns that act in the plane with a normal; None where an axis is oblique to it."""
    inside = []
    for across, entries in zip((False, True), axes, strict=True):
        for column, *both in entries:
            along = [abs(axis @ normal) <= PARALLEL for axis in both]
            parallel = [np.linalg.norm(np.cross(axis, normal)) <= PARALLEL for axis in both]
            if all(along if across else parallel):
                inside.append(column)
            elif not all(parallel if across else along):
                return None
    return tuple(sorted(inside))


def _can_rest(joints: Sequence[Joint], inside: Sequence[int]) -> bool:
    """Tell whether each movement without its coordinates out of the plane is a movement, too."""
    column = 0
    for joint in joints:
        for name in joint.movements:
            count = len(MOVEMENTS[name].coordinates)
            if remaining(name, [k for k in range(count) if column + k in inside]) is None:
                return False
            column += count
    return True


def _of_balls(joints: Sequence[Joint]) -> set[int]:
    """List the columns of balls."""
    every = [name for joint in joints for name in joint.movements for _ in MOVEMENTS[name].coordinates]
    return {column for column, name in enumerate(every) if MOVEMENTS[name].ball}


def _others_rest(loops: ClosedLoops, inside: Sequence[int], normal: np.ndarray, of_balls: Collection[int]) -> bool:
    """Tell whether the coordinates out of the plane are held by the loops, or idle."""
    rest = np.zeros(len(loops.columns))
    count = len(loops.loop_group.loops)
    plane = frame(np.zeros(3), normal)[:3, :3].T  # to axes of which z is the normal
    twists = loops.jacobian(rest)[: 6 * count].reshape(count, 2, 3, -1)
    twists = np.einsum("ij,lkjc->lkic", plane, twists).reshape(count, 6, -1)
    others = [column for column in range(len(rest)) if column not in inside]
    in_plane, out_of_plane = (twists[:, rows][:, :, others].reshape(-1, len(others)) for rows in ([2, 3, 4], [0, 1, 5]))
    free = null_space(out_of_plane, DEPENDENT)[1]
    if not len(free):
        return True
    if np.abs(in_plane @ free.T).max() > DEPENDENT:
        return False
    rest[others] = FAR * np.random.default_rng(0).uniform(0.5, 1.0, len(free)) @ free
    # of a turn about any axis each angle of a ball has a part
    moved, found = loops.closed(rest, held=[column for column in inside if column not in of_balls])
    return found.residual_norm <= loops.thresholds.residual and bool(np.linalg.norm(moved) > FAR / 2)
