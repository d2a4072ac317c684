"""Find the nearest frames for which loops close throughout, where rounded numbers let them close at one pose only.

Parallel, perpendicular, coaxial and concurrent axes are put right by `jaxkin.joints.regularise`. What is left are
mechanisms that move for the sake of their lengths: a third bar as long as the two beside it, the twists and lengths of
Bennett's linkage. Each frame `i` may be moved by a small twist `p_i`, on both of its parts alike. At poses `k` along
the motion the loops have the residual `r_k`, and to first order

    r_k + A_k p + J_k dq_k = 0.

What the coordinates cannot undo is `N_k (r_k + A_k p) = 0`, with the rows of `N_k` orthonormal to the columns of `J_k`
whose singular values are beyond doubt. The `p` of least norm that satisfies the equations of all poses is applied, and
the poses are closed anew, until all residuals are at rounding.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Pose, inverse
from jaxkin.joints.screws import chain, freedoms, moved
from jaxkin.linkage.first_order import null_space
from jaxkin.mobility.consistency import cutoff, nearest_closed, rounding
from jaxkin.mobility.host_closure import ClosedLoops, Row

Twists = Float[np.ndarray, "frames 6"]
"""World coordinates, lengths over the characteristic one: rotation, then the velocity of the origin."""

_WALK = 4
"""Poses in each direction of the motion: with both directions, more conditions than any linkage known has."""
_STRIDE = 0.15
"""Radians, or characteristic lengths, from one of these poses to the next."""
_DIRECTIONS = 6
"""Directions of the motion in which poses are taken at most."""
_ITERATIONS = 16
"""Iterations at most. Convergence is quadratic, or linear where products of two errors are left."""
_COARSE = 1e-5
"""Least singular value of the conditions, over the largest, that counts in the first two iterations: smaller ones come
from the errors themselves."""
_FINE = 1e-9
"""The same in all later iterations, just above rounding: products of two errors are left (two axes out of parallel, in
a linkage that would move with either), on which the iteration converges linearly."""


def nearest_mobile(loops: ClosedLoops, noise: float) -> bool:
    """Move the frames of the loops by the smallest twists with which these close along their motion.

    `noise` is how far, in radians and characteristic lengths, a frame may move: False where that is not enough. The
    joints must have the same frames on both parts.
    """
    frames = [(joint, number) for joint, (names, *_) in loops.chains.items() for number in range(len(names))]
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


def _poses(loops: ClosedLoops, least: float) -> list[Row]:
    """Poses of least residual along the freedoms of the assembled pose, forwards and backwards."""
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
    """Orthonormal combinations of the equations that no coordinate changes."""
    directions, values, _ = np.linalg.svd(jacobian, full_matrices=True)
    return directions[:, int((values > least * values.max(initial=0.0)).sum()) :].T


def _frame_jacobian(loops: ClosedLoops, frames: list[tuple[int, int]], q: Row) -> Float[np.ndarray, "equations twists"]:
    """Derivative of the misfits of the loops with respect to twists of the frames.

    A frame that moves by `p` on both sides changes its displacement D by `p D - D p`: by the twist `p - Ad_D p`.
    """
    first = {frame: 6 * number for number, frame in enumerate(frames)}
    steps: dict[int, list[Pose]] = {}
    for joint, (names, before, _, pitch) in loops.chains.items():
        own, start = q[loops.slices[joint]], 0
        steps[joint] = []
        for number, name in enumerate(names):
            stop = start + freedoms([name])
            steps[joint].append(chain([name], before[number : number + 1], own[start:stop], pitch)[0])
            start = stop
    jacobian = np.zeros((len(loops.loop_group.loops), 6, 6 * len(frames)))
    for rows, loop, pose in zip(jacobian, loops.loop_group.loops, loops.travel(q).starts, strict=True):
        for joint, sign in loop:
            numbered = list(enumerate(steps[joint]))
            for number, step in numbered if sign > 0 else [(n, inverse(step)) for n, step in reversed(numbered)]:
                column = first[joint, number]
                rows[:, column : column + 6] += moved(pose, np.eye(6) - moved(step, np.eye(6)))
                pose = pose @ step
    return jacobian.reshape(-1, 6 * len(frames))


def _move(loops: ClosedLoops, frames: list[tuple[int, int]], twists: Twists) -> None:
    for (joint, number), twist in zip(frames, twists, strict=True):
        names, before, _, pitch = loops.chains[joint]
        before = before.copy()
        before[number] = _moved_frame(before[number], twist)
        loops.chains[joint] = (names, before, before, pitch)


def _moved_frame(frame: Pose, twist: Float[np.ndarray, "6"]) -> Pose:
    """A frame after a small twist, orthonormal to rounding."""
    turn, shift = twist[:3], twist[3:]
    cross = np.array([[0, -turn[2], turn[1]], [turn[2], 0, -turn[0]], [-turn[1], turn[0], 0]])
    result = frame.copy()
    result[:3, 3] += np.cross(turn, frame[:3, 3]) + shift
    left, _, right = np.linalg.svd((np.eye(3) + cross + 0.5 * cross @ cross) @ frame[:3, :3])
    result[:3, :3] = left @ right
    return result
