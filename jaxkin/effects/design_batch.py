"""Evaluate a measure for many designs of one mechanism: one compiled program, batches of it side by side on all cores.

A design is a row of numbers: new values of some lengths, then offsets of some pins in their holes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._traced import written_with_jax
from jaxkin.effects.pin_play import with_pins_moved
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.pose import Pose
from jaxkin.solve.device import group_for_device, on_cpu
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.execution.cores import available_cores, in_threads
from jaxkin.solve.options import SolverOptions

BATCH_POSES = 1000
"""Poses that one batch has, about: their numbers stay in the cache of a core. 10^5 designs of a four-bar take 0.55 s in
batches of 250, 0.59 s of 1,000, 1.25 s of 2,000 and 1.37 s of 4,000, on two cores."""
DEVICE_POSES = 100_000
"""The same on a device that is no CPU."""


@dataclass(frozen=True)
class DesignMeasure:
    """What is measured, and of which designs: static to JAX."""

    measure: Callable[..., Any]
    lengths: tuple[Any, ...]
    """Names of lengths: the first numbers of a design."""
    pins: tuple[tuple[str, int], ...]
    """Joints, and how many numbers of a design are the offset of their pins."""
    driven: tuple[Any, ...]
    """Keys of the drive; none where the measure is one of the mechanism."""
    one_pose: bool
    """Whether the drive is that of one pose."""
    options: SolverOptions

    def __call__(self, mechanism: Mechanism, driven: tuple[Any, ...], design: Float[Array, " numbers"]):
        """Evaluate one design: the value, and whether all its poses are on the branch of the assembled pose."""
        count = len(self.lengths)
        if count:
            mechanism = mechanism.with_lengths(dict(zip(self.lengths, design[:count], strict=True)))
        offsets = {}
        for name, size in self.pins:
            offsets[name] = design[count : count + size]
            count += size
        if offsets:
            mechanism = mechanism.with_linkage(with_pins_moved(mechanism.linkage, offsets))
        if not self.driven:
            return self._measured(mechanism), jnp.asarray(True)
        drive = dict(zip(self.driven, driven, strict=True))
        found: Pose | Motion
        if self.one_pose:
            found = mechanism.solve(drive, options=self.options, throw=False)
            reached = found.motion.on_branch
        else:
            found = mechanism.sweep(drive, options=self.options)
            reached = found.on_branch
        return self._measured(found), jnp.all(reached)

    def _measured(self, of: Pose | Motion | Mechanism) -> Float[Array, ""]:
        """Call the measure; ValueError where it asks for numbers that JAX traces, as numpy does."""
        try:
            with written_with_jax("the measure"):
                return _one_number(self.measure(of))
        except AttributeError as error:
            if self.driven:
                raise
            raise ValueError(
                f"the measure is given the mechanism, since there is no drive ({error}): give one for a pose or a "
                "motion, as in drive={'A': 0.7}"
            ) from error


def _one_number(value: Any) -> Float[Array, ""]:
    """Check that a measure is one number (ValueError)."""
    shape = getattr(value, "shape", () if isinstance(value, int | float) else None)
    if shape != ():
        what = type(value).__name__ if shape is None else f"an array of shape {shape}"
        raise ValueError(f"the measure must return one number, such as jnp.max(...) of what it measures, got {what}")
    return jnp.asarray(value, float)


@partial(whole_program, static=(0,))
def value_and_slopes(measured: DesignMeasure, mechanism: Mechanism, driven: tuple, design: Float[Array, " numbers"]):
    """Evaluate one design: value, whether it is reached, and the derivatives of the value by its numbers."""

    def twice(numbers):
        value, reached = measured(mechanism, driven, numbers)
        return value, (value, reached)

    slopes, (value, reached) = jax.jacfwd(twice, has_aux=True)(design)
    return value, reached, slopes


@partial(whole_program, static=(0,))
def evaluate_batch(
    measured: DesignMeasure, mechanism: Mechanism, driven: tuple, designs: Float[Array, "designs numbers"]
):
    """Evaluate some designs, traced ones too: values, and which are reached."""
    return jax.vmap(measured, (None, None, 0))(mechanism, driven, designs)


def evaluate(
    measured: DesignMeasure,
    mechanism: Mechanism,
    driven: tuple[Any, ...],
    designs: Float[np.ndarray, "designs numbers"],
    poses: int,
) -> tuple[Float[np.ndarray, " designs"], Bool[np.ndarray, " designs"]]:
    """Evaluate many designs: values, NaN where a design is not reached, and which are."""
    length = min(len(designs), max(1, group_for_device(BATCH_POSES, DEVICE_POSES) // max(poses, 1)))
    count = -(-len(designs) // length)
    padded = np.concatenate([designs, np.repeat(designs[-1:], count * length - len(designs), axis=0)])

    def run(batch: Float[np.ndarray, "designs numbers"]):
        return jax.device_get(evaluate_batch(measured, mechanism, driven, batch))

    found = in_threads(run, np.split(padded, count), available_cores() if on_cpu() else 1)
    values, reached = (np.concatenate(column)[: len(designs)] for column in zip(*found, strict=True))
    reached = reached & np.isfinite(values)
    return np.where(reached, values, np.nan), reached
