"""Find the plane in which a loop group moves though some of its joints could leave it (host code, numbers only).

The rod of a hydraulic cylinder turns in its tube, and a pin slides in its hole; where all hinges of the loops are
parallel, neither moves. With n the direction of the hinges, the twists of turns about n and of slides at right angles
to n keep to the plane; those of turns at right angles to n and of slides along n leave it. At first order, the loops
say of the rates e of the former and o of the latter

    J_e e + J_eo o = 0    (rotation about n, translations across n),
    J_o o = 0             (rotations across n, translation along n),

since no rate e leaves the plane. Either the second line says o = 0, or it leaves motions o undetermined; where these do
not disturb the first line, J_eo o = 0, they are idle, and of least norm if o = 0. The loops then move in the plane, by
three equations each, while o rests. With o = 0 the second line holds at every pose: that it has no motions by which the
plane could be left is asked at the assembled pose alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.partial_movement import remaining
from jaxkin.geometry.pose import frame, inverse
from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import DEPENDENT, chain
from jaxkin.linkage.first_order import loop_jacobian, null_space
from jaxkin.linkage.planes import PARALLEL, Axes, elementary_axes, level
from jaxkin.topology.graph import Circuit


def decoupled_plane(joints: Sequence[Joint], loops: Sequence[Circuit]) -> tuple[int, ...] | None:
    """Find the columns of the coordinates that act in the plane while all others rest; None where there is no plane.

    Columns are numbered from 0 through all coordinates of `joints`; `loops` are (number in `joints`, sign). The normal
    is the direction about which most joints turn, of those for which the others rest. Of a ball, one axis of the frames
    must be normal to the plane. As in `planes.plane_columns`, frames of a joint on its two parts must not differ along
    the normal.
    """
    if not loops or traced(joints) or (axes := elementary_axes(joints, of_balls=True)) is None:
        return None
    for normal in _directions(axes[0]):
        inside = _inside(axes, normal)
        if inside is None or not _can_rest(joints, inside) or not level(joints, normal):
            continue
        if _others_rest(joints, loops, inside, normal):
            return inside
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


def _inside(axes: tuple[Axes, Axes], normal: np.ndarray) -> tuple[int, ...] | None:
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


def _others_rest(joints: Sequence[Joint], loops: Sequence[Circuit], inside: Sequence[int], normal: np.ndarray) -> bool:
    """Tell whether the coordinates out of the plane are held by the loops, or disturb no equation of the plane."""
    sides = [np.asarray(joint.frames_1, float) for joint in joints]
    origins = np.concatenate(sides)[:, :3, 3]
    centre, size = origins.mean(axis=0), np.ptp(origins, axis=0).max(initial=0.0) or 1.0
    plane = inverse(frame(centre, normal))
    screws = []
    for joint, side in zip(joints, sides, strict=True):
        local = plane @ side
        local[:, :3, 3] /= size
        screws.append(chain(joint.movements, local, np.zeros(joint.freedoms))[1])
    columns = [(number, k) for number, joint in enumerate(joints) for k in range(joint.freedoms)]
    jacobian = loop_jacobian(loops, columns, np.concatenate(screws, axis=1)).reshape(len(loops), 6, -1)
    others = [column for column in range(len(columns)) if column not in inside]
    in_plane, out_of_plane = (
        jacobian[:, rows][:, :, others].reshape(-1, len(others)) for rows in ([2, 3, 4], [0, 1, 5])
    )
    free = null_space(out_of_plane, DEPENDENT)[1]
    return bool(np.abs(in_plane @ free.T).max(initial=0.0) <= DEPENDENT)
