"""Telling numbers that are there from numbers that JAX will only know later."""

from __future__ import annotations

import jax
from jax.core import Tracer


def traced(*trees: object) -> bool:
    """Tell whether JAX traces any of the arrays (inside `jit`, `vmap` or `grad`): their numbers cannot be looked at."""
    return any(isinstance(leaf, Tracer) for leaf in jax.tree.leaves(trees))
