"""Find the nearest frames for which loops close throughout, where rounded numbers let them close at one pose only.

Axes that should be parallel, perpendicular, coaxial or concurrent are aligned by `jaxkin.joints.regularise`. Other
mechanisms move because of relations between their lengths: a parallelogram with a third bar as long as the two beside
it, or Bennett's linkage with its lengths and twist angles. Each frame `i` may be moved by a small twist `p_i`, on both
of its parts alike. At poses `k` along the motion the loops have the residual `r_k`, and to first order

    r_k + A_k p + J_k dq_k = 0.

Changes `dq_k` of the coordinates cannot reduce the part `N_k (r_k + A_k p)`, which therefore has to be zero. The rows
of `N_k` are orthonormal, and orthogonal to the left singular vectors of `J_k` whose singular values are not due to
noise. The `p` of least norm that satisfies the equations of all poses is applied, and the poses are closed anew, until
all residuals are at rounding.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.pose import Transform, inverse, skew
from jaxkin.joints.screws import moved
from jaxkin.linkage.first_order import null_space
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates
from jaxkin.mobility.consistency import cutoff, nearest_closed, rounding

FrameTwists = Float[np.ndarray, "frames 6"]
"""Small twists of frames in world coordinates about the centroid, lengths over the characteristic length: rotation
vector, then the displacement of the centroid."""

_WALK = 4
"""Number of poses in each direction of a motion: eight in all give more conditions than any known linkage needs."""
_STRIDE = 0.15
"""Distance of these poses from each other, radians or characteristic lengths: far enough for conditions that differ,
near enough to close."""
_DIRECTIONS = 6
"""Largest number of directions in which poses are taken: those of three freedoms, forwards and backwards."""
_ITERATIONS = 16
"""Largest number of iterations: convergence is quadratic, or linear where products of two errors are left."""
_COARSE = 1e-5
"""Singular values of the conditions, over the largest, that are zero in the first two iterations: values below this are
due to the errors of the frames."""
_FINE = 1e-9
"""Singular values of the conditions, over the largest, that are zero in all later iterations, just above rounding. What
is left then are products of two errors (two axes that are not parallel, in a linkage that moves with either error
alone), on which the iteration converges linearly."""


def nearest_mobile(loops: ClosedLoops, noise: float) -> bool:
    """Move the frames of the loops by the smallest twists with which these close along their motion.

    `noise` is how far, in radians and characteristic lengths, a frame may move: False where that is not enough. The
    joints must have the same frames on both parts.
    """
    frames = [(joint, number) for joint, each in loops.chains.items() for number in range(len(each.movements))]
    poses = _poses(loops, cutoff(noise))
    total = np.zeros((len(frames), 6))
    for iteration in range(_ITERATIONS):
        found = [nearest_closed(loops, q, cutoff(noise)) for q in poses]
        poses = [q for q, _ in found]
        if max(float(np.linalg.norm(residual)) for _, residual in found) < rounding(loops):
            return True
        rows, right = [], []
        for q, residual in found:
            held = _held(loops.jacobian(q), cutoff(noise))
            rows.append(held @ _frame_jacobian(loops, frames, q))
            right.append(held @ residual)
        least = _COARSE if iteration < 2 else _FINE
        step = -np.linalg.lstsq(np.concatenate(rows), np.concatenate(right), rcond=least)[0].reshape(-1, 6)
        total = total + step
        if not np.abs(total).max() <= noise:
            return False
        _move(loops, frames, step)
    return False


def _poses(loops: ClosedLoops, least: float) -> list[LoopCoordinates]:
    """Find poses of least residual along the freedoms of the assembled pose, forwards and backwards."""
    home, _ = nearest_closed(loops, np.zeros(len(loops.columns)), least)
    _, free = null_space(loops.jacobian(home), least)
    found = []
    for number in range(min(_DIRECTIONS, 2 * len(free))):
        generic = np.sin(1.0 + 2.7 * np.arange(free.shape[1]) + 1.3 * (number // 2))
        along, q = (generic if number % 2 else -generic), home
        for _ in range(_WALK):
            _, free = null_space(loops.jacobian(q), least)
            along = free.T @ (free @ along)
            along /= max(float(np.abs(along).max()), 1e-12)
            q, _ = nearest_closed(loops, q + _STRIDE * along, least)
            found.append(q)
    return found


def _held(jacobian: Float[np.ndarray, "equations columns"], least: float) -> Float[np.ndarray, "held equations"]:
    """Compute orthonormal combinations of the equations that no coordinate changes at first order, one a row."""
    directions, values, _ = np.linalg.svd(jacobian, full_matrices=True)
    return directions[:, int((values > least * values.max(initial=0.0)).sum()) :].T


def _frame_jacobian(
    loops: ClosedLoops, frames: list[tuple[int, int]], q: LoopCoordinates
) -> Float[np.ndarray, "equations twists"]:
    """Differentiate `Travel.residual` of the loops with respect to twists of the frames, six columns a frame.

    A frame that moves by `p` on both sides changes its displacement D by `p D - D p`: by the twist `p - Ad_D p`.
    """
    first = {frame: 6 * number for number, frame in enumerate(frames)}
    steps: dict[int, list[Transform]] = {}
    for joint, each in loops.chains.items():
        own = q[loops.slices[joint]]
        numbered = enumerate(coordinate_ranges(each.movements))
        steps[joint] = [each.alone(n).displaced(own[columns.start : columns.stop])[0] for n, columns in numbered]
    jacobian = np.zeros((len(loops.loop_group.loops), 6, 6 * len(frames)))
    for rows, loop, pose in zip(jacobian, loops.loop_group.loops, loops.travel(q).starts, strict=True):
        for joint, sign in loop:
            numbered = list(enumerate(steps[joint]))
            for number, step in numbered if sign > 0 else [(n, inverse(step)) for n, step in reversed(numbered)]:
                column = first[joint, number]
                rows[:, column : column + 6] += moved(pose, np.eye(6) - moved(step, np.eye(6)))
                pose = pose @ step
    return jacobian.reshape(-1, 6 * len(frames))


def _move(loops: ClosedLoops, frames: list[tuple[int, int]], twists: FrameTwists) -> None:
    """Move frames, given as (joint, number of the frame), by small twists, in place and on both parts alike."""
    for (joint, number), twist in zip(frames, twists, strict=True):
        before = loops.chains[joint].frames_1.copy()
        before[number] = _moved_frame(before[number], twist)
        loops.chains[joint] = loops.chains[joint]._replace(frames_1=before, frames_2=before)


def _moved_frame(frame: Transform, twist: Float[np.ndarray, "6"]) -> Transform:
    """Move a frame by a small twist; its axes stay orthonormal to rounding."""
    turn, shift = twist[:3], twist[3:]
    cross = skew(turn)
    result = frame.copy()
    result[:3, 3] += np.cross(turn, frame[:3, 3]) + shift
    left, _, right = np.linalg.svd((np.eye(3) + cross + 0.5 * cross @ cross) @ frame[:3, :3])
    result[:3, :3] = left @ right
    return result
