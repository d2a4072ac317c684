"""Put rows at their places among more rows, zeros elsewhere."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float


def scatter_rows(found: Float[Array, "some *entries"], which: Sequence[int] | np.ndarray, number: int) -> Array:
    """Put the rows `found` at the places `which` among `number` rows, zeros elsewhere.

    The rows are gathered: XLA would write scattered rows one after another.
    """
    place = np.full(number, len(which))
    place[list(which)] = np.arange(len(which))
    if len(which) < number:
        found = jnp.concatenate([found, jnp.zeros((1, *found.shape[1:]), found.dtype)])
    return found if np.array_equal(place, np.arange(number)) else found[place]
