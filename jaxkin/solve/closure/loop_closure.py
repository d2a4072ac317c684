"""The closure of loops without couplings, as loops in the plane and loops in space are evaluated alike."""

from __future__ import annotations

from typing import NamedTuple

from jaxtyping import Array, Float


class LoopClosure(NamedTuple):
    """The closure equations of all loops of a loop system at many poses, lengths over the characteristic length."""

    residual: Float[Array, "equations poses"]
    """The equations that the loops need: rows of `closure.Closure.residual`."""
    jacobian: Float[Array, "equations columns poses"]
    """Derivative of `residual` with respect to the columns of the loop system."""
    rotation_square: Float[Array, " poses"]
    """Sum of the squares of all rotation entries in Eq. 12."""
    translation_square: Float[Array, " poses"]
    """Sum of the squares of all translations in Eq. 12."""
