"""Hold the numbers of a loop system: frames, pitches and curves of its joints, coefficients of its couplings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.patches import Followed

Frames = Float[Array | np.ndarray, "_ 4 4"]


class CouplingNumbers(NamedTuple):
    """The numbers of a coupling, in radians and the unit of the mechanism: see `Coupling`."""

    coefficients: Float[Array, "coordinates powers"]
    offset: Float[Array, ""]


class Joints(NamedTuple):
    """Frames, pitches and curves of the joints of a loop system, one entry a joint, in the unit of the mechanism: see
    `Joint`; and the numbers of its couplings."""

    frames_1: tuple[Float[Array, "frames 4 4"], ...]
    frames_2: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]
    couplings: tuple[CouplingNumbers, ...] = ()
    curves: tuple[tuple[Followed | None, ...], ...] = ()
    """For each joint the curves of its movements, empty where it has none: see `Joint.curves`."""


def scaled_frames(
    frames_1: Sequence[Frames], frames_2: Sequence[Frames], xp: Any = jnp, constant: bool = True
) -> tuple[Frames, Float[Array | np.ndarray, ""]]:
    """Compute all frames without unit and origin, and the characteristic length; by `xp`, jax.numpy or numpy.

    All frames on parts 1 come first, then those on parts 2, then the identity. The origin is moved to the centroid of
    the frames on part 1, and lengths are divided by the root-mean-square distance of these frames from the centroid
    (the characteristic length), so that no result depends on unit or origin. Where `constant`, centroid and
    characteristic length are constants in derivatives: in those of displacements they cancel.
    """
    frames = xp.concatenate([*(xp.asarray(each, float) for each in (*frames_1, *frames_2)), np.eye(4)[None]])
    origins = frames[: len(frames) // 2, :3, 3]
    origins = lax.stop_gradient(origins) if xp is jnp and constant else origins
    centre, length = centroid_and_length(origins, xp)
    shift = (frames[:-1, :3, 3] - centre) / length
    if xp is jnp:
        return frames.at[:-1, :3, 3].set(shift), length
    frames[:-1, :3, 3] = shift
    return frames, np.asarray(length)


def inverse_poses(poses: Float[Array | np.ndarray, "*entries 4 4"], xp: Any = jnp) -> Any:
    """Invert rigid poses; by `xp`, jax.numpy or numpy.

    Joined from blocks: XLA on a CPU (jaxlib 0.10.2) gets blocks written into a product of matrices wrong where `vmap`
    gives all of them a leading axis of one.
    """
    turned = xp.swapaxes(poses[..., :3, :3], -1, -2)
    x, y, z = (poses[..., row, :3] * poses[..., row, 3:] for row in range(3))
    moved = -(x + y + z)
    return xp.concatenate([xp.concatenate([turned, moved[..., None]], axis=-1), poses[..., 3:, :]], axis=-2)
