"""Attach derivatives to displacements of planar loops that are known already, without finding their poses anew.

They are those of `planar_derivative`, by the screws of a pose, and take a third of the time of the solution of the
closure equations for any loops (`jaxkin.solve.range.known_poses`).
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.planar_derivative import planar_slopes
from jaxkin.solve.status import closes_before_limits
from jaxkin.solve.system.loop_system import LoopSystem


def known_displacements_in_plane(
    system: LoopSystem,
    axes: AssembledAxes,
    inputs: Float[Array, "driven poses"],
    known: Float[Array, "columns poses"],
    status: Int[Array, " poses"],
    *,
    regular: bool,
) -> Float[Array, "columns poses"]:
    """Return the displacements of all joints in known poses, as differentiable functions of the inputs alone.

    The system is one of `planar_derivative.has_planar_slopes`; `regular` is that of `planar_slopes`. Shapes and units
    are those of `known_displacements`; a pose that is not closed has derivatives of zero.
    """
    return _attached(system, regular, axes, inputs, lax.stop_gradient(known), closes_before_limits(status))


@partial(jax.custom_jvp, nondiff_argnums=(0, 1))
def _attached(
    system: LoopSystem,
    regular: bool,
    axes: AssembledAxes,
    inputs: Float[Array, "driven poses"],
    known: Float[Array, "columns poses"],
    closed: Bool[Array, " poses"],
) -> Float[Array, "columns poses"]:
    """Return what is known, with derivatives with respect to the inputs where poses are closed."""
    return known


@_attached.defjvp
def _derivative_by_inputs(system: LoopSystem, regular: bool, primals, tangents):
    axes, _, _, closed = primals
    _, d_inputs, _, _ = tangents
    # for the next derivative what is known is a function of the inputs
    rows = _attached(system, regular, *primals)
    lengths = [axes.length if is_length else 1.0 for is_length in system.is_length]
    scaled = [row / length for row, length in zip(rows, lengths, strict=True)]
    driven = jnp.stack([d / lengths[column] for column, d in zip(system.driven, d_inputs, strict=True)])
    slopes = planar_slopes(system, axes, scaled, None, driven, regular=regular)
    return rows, jnp.stack([jnp.where(closed, s * length, 0.0) for s, length in zip(slopes, lengths, strict=True)])
