"""Ranges of any length, chunk by chunk: motions that continue each other, in bounded memory.

All chunks are solved by one compiled program. Each begins with a lead: inputs that end at the last pose of the chunk
before, by which the two are tied together. A single input needs no other lead than that pose. Several inputs are first
led there by a short path; where that ends on another branch, or poses of the chunk do not close, the path that was
travelled before is travelled again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import by_name, whole_number
from jaxkin._traced import traced
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.trig import TURN
from jaxkin.linkage.coordinates import named, resolve, with_finite_inputs
from jaxkin.linkage.joint_motion import part_transforms
from jaxkin.mechanism.collect import nan_where_not_finite
from jaxkin.mechanism.joint_limits import with_limited
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.sweep import follow_drive, warn_of_float32
from jaxkin.mechanism.targets import with_targets
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

LEAD_POSES = 128
"""Poses of the lead of a chunk of several inputs, at least."""
LEAD_SPACING = 0.1
"""Distance of the poses of a lead along the path travelled before, at most, in radians or over the size of the
mechanism: a third of the longest step of the continuation."""
SAME_PLACE = 1e-4
"""Distance of parts, radians or over the size, at which a pose that is reached in two ways is one pose. At a singular
pose the two may differ by the root of rounding, or a higher one."""
_KEPT = (Status.CLOSED.value, Status.MISFIT.value)
"""Statuses of poses by which the branch is kept from chunk to chunk: no joint is beyond its limits as yet."""


class _SharedPose(NamedTuple):
    """The pose that two chunks share."""

    displacements: tuple[Float[np.ndarray, " _"], ...]
    closed: bool
    """Whether its loops are closed, or as nearly as the joints agree."""


class Stream:
    """The motions of consecutive chunks of a drive, in turn: see `Mechanism.stream`."""

    def __init__(self, mechanism: Mechanism, drive: Mapping[Any, object], chunk: int, options: SolverOptions) -> None:
        mechanism, drive = with_targets(mechanism, by_name(drive, "driven displacements", "{'A': angles}"))
        if traced(mechanism, {name: drive[name] for name in named(drive)}):
            raise ValueError("a stream is of numbers: inside jit, vmap and grad write sweep")
        chunk = whole_number(chunk, "chunk", 1)
        warn_of_float32()
        self.mechanism = mechanism
        self.inputs = {name: np.asarray(entry.values) for name, entry in resolve(mechanism.linkage, drive).items()}
        """Driven displacements by "joint.coordinate", of all poses, as they were given."""
        followed, self._finite = with_finite_inputs(tuple(self.inputs.values()))
        self._followed = dict(zip(self.inputs, map(np.asarray, followed), strict=True))
        """The displacements as the motion is followed: without NaN and infinity."""
        self.poses = len(next(iter(self.inputs.values())))
        self.chunk = min(chunk, max(self.poses, 1))
        self._sweep = partial(follow_drive, mechanism, options=options)
        origins = np.concatenate([np.asarray(joint.frames_1)[:, :3, 3] for joint in mechanism.all_joints])
        self._centre, self._size = origins.mean(axis=0), float(np.linalg.norm(np.ptp(origins, axis=0))) or 1.0

    def __len__(self) -> int:
        """Number of chunks."""
        return max(1, -(-self.poses // self.chunk))

    def __iter__(self) -> Iterator[Motion]:
        if len(self) == 1:
            yield with_limited(self._sweep(self.inputs))
            return
        on_branch, last = True, None
        for first in range(0, self.poses, self.chunk):
            motion, leading, met, same = self._led(first, last)
            on_branch = on_branch and same
            count = min(self.chunk, self.poses - first)
            arrays = motion.inputs, motion.displacements, motion.status, motion.residual
            cut = _cut(arrays, self._turns(last, met), jnp.asarray(on_branch), leading, count)
            motion = Motion(self.mechanism, *cut, options=motion.options)
            last = _shared_pose(motion, count - 1)
            yield with_limited(self._as_given(motion, first))

    def _led(self, first: int, last: _SharedPose | None) -> tuple[Motion, int, _SharedPose, bool]:
        """Solve the chunk that begins at pose `first`, behind one lead after the other until one keeps the branch.

        Returns the motion, with its lead; the number of poses of that; the pose at its end; and whether this is `last`,
        the last pose of the chunk before.
        """
        for lead in self._leads(first):
            leading = lead.shape[1]
            which = np.minimum(np.arange(first, first + self.chunk), self.poses - 1)
            rows = (np.concatenate([to, of[which]]) for to, of in zip(lead, self._followed.values(), strict=True))
            motion = self._sweep(dict(zip(self.inputs, rows, strict=True)))
            met = _shared_pose(motion, leading - 1)
            same = last is None or not last.closed or self._same(last, met)
            if same and np.isin(np.asarray(motion.status), _KEPT).all():
                break
        return motion, leading, met, same

    def _as_given(self, motion: Motion, first: int) -> Motion:
        """Give the motion of a chunk the inputs as they were given: poses are NONFINITE where these are not finite."""
        chunk = slice(first, first + len(motion))
        if self._finite is None or (finite := self._finite[chunk]).all():
            return motion
        displacements, residual = nan_where_not_finite((motion.displacements, motion.residual), finite)
        status = jnp.where(finite, motion.status, Status.NONFINITE.value)
        inputs = {name: jnp.asarray(values[chunk]) for name, values in self.inputs.items()}
        return Motion(self.mechanism, inputs, displacements, status, residual, motion.options)

    def _leads(self, first: int) -> Iterator[Float[np.ndarray, "driven leading"]]:
        """Yield paths of inputs to try in turn, each to the pose before the chunk that begins at pose `first`."""
        before = max(first - 1, 0)
        end = np.stack([values[before] for values in self._followed.values()])[:, None]
        if len(self.inputs) == 1:
            yield end
            return
        step = end - np.stack([values[max(before - 1, 0)] for values in self._followed.values()])[:, None]
        far, near = np.max(np.abs(end) / self._scales), np.max(np.abs(step) / self._scales)
        control = end - 0.5 * (far / near * step if near > 0 else end)
        t = np.linspace(0.0, 1.0, LEAD_POSES)
        # a parabola, which ends in the direction in which the inputs go on: a corner is hard to follow
        yield 2 * t * (1 - t) * control + t * t * end
        if first:
            travelled = self._distance[:first]
            leading = LEAD_POSES
            while leading < min(self.chunk, travelled[-1] / LEAD_SPACING):
                leading *= 4
            which = np.minimum(np.searchsorted(travelled, np.linspace(0.0, travelled[-1], leading)), before)
            which[-1] = before
            yield np.stack([values[which] for values in self._followed.values()])

    @cached_property
    def _scales(self) -> Float[np.ndarray, "driven 1"]:
        """What inputs are divided by to be compared: lengths by the size of the mechanism, angles by one."""
        lengths = [is_length(name.rpartition(".")[2]) for name in self.inputs]
        return np.where(lengths, self._size, 1.0)[:, None]

    @cached_property
    def _distance(self) -> Float[np.ndarray, " poses"]:
        """Distance of each pose from the first, along all poses between them."""
        step = np.zeros(self.poses)
        for values, scale in zip(self._followed.values(), self._scales, strict=True):
            np.maximum(step[1:], np.abs(np.diff(values)) / scale, out=step[1:])
        return np.cumsum(step)

    def _same(self, one: _SharedPose, other: _SharedPose) -> bool:
        """Tell whether all parts are at the same places in both poses, and the other one is closed."""
        both = tuple(np.stack(pair) for pair in zip(one.displacements, other.displacements, strict=True))
        for transforms in map(np.asarray, part_transforms(self.mechanism.linkage, both)):
            rotation, shift = transforms[1, :3, :3] - transforms[0, :3, :3], transforms[1, :3, 3] - transforms[0, :3, 3]
            moved = rotation @ self._centre + shift
            if not max(np.abs(rotation).max(), np.abs(moved).max() / self._size) <= SAME_PLACE:
                return False
        return other.closed

    def _turns(self, last: _SharedPose | None, met: _SharedPose) -> tuple[Float[np.ndarray, " _"], ...]:
        """Count the full turns, in radians, by which angles of a chunk continue those of the chunk before."""
        if last is None:
            return tuple(np.zeros_like(here) for here in met.displacements)
        turns = []
        for joint, there, here in zip(self.mechanism.all_joints, last.displacements, met.displacements, strict=True):
            angles = np.array([not is_length(name) for name in joint.coordinates], bool)
            turns.append(np.where(angles, TURN * np.round(np.nan_to_num(there - here) / TURN), 0.0).astype(here.dtype))
        return tuple(turns)


def _shared_pose(motion: Motion, number: int) -> _SharedPose:
    displacements, status = jax.device_get(_at((motion.displacements, motion.status), number))
    return _SharedPose(displacements, status in _KEPT)


@jax.jit
def _at(arrays, number):
    return jax.tree.map(lambda array: array[number], arrays)


@partial(jax.jit, static_argnums=(3, 4))
def _cut(arrays, turns: tuple[Float[Array, " _"], ...], on_branch: Bool[Array, ""], first: int, count: int):
    """Cut `count` poses from `first` on and add full turns to them; JUMPED where the branch was not kept."""
    inputs, displacements, status, residual = jax.tree.map(lambda array: array[first : first + count], arrays)
    displacements = tuple(each + more for each, more in zip(displacements, turns, strict=True))
    kept = (status == Status.CLOSED.value) | (status == Status.MISFIT.value)
    status = jnp.where(kept & ~on_branch, Status.JUMPED.value, status)
    return inputs, displacements, status, residual
