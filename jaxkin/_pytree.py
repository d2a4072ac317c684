"""Make a frozen dataclass a pytree, with some fields as its leaves and others static."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from operator import attrgetter
from typing import Any

import jax
from jax.tree_util import GetAttrKey


def register_leaves(kind: type, leaves: Sequence[str], static: Sequence[str]) -> None:
    """Register a dataclass with the fields `leaves` and `static`; a field that is neither gets its default when JAX
    rebuilds an instance.

    In place of `jax.tree_util.register_dataclass`, which leaves out fields only from jax 0.10 on, and which calls the
    constructor: leaves may be no arrays, such as the answers of JAX to which of them are batched.
    """
    leaves_of, static_of = _fields(leaves), _fields(static)
    keys = tuple(map(GetAttrKey, leaves))

    def rebuilt(static_values: Iterable[Any], leaf_values: Iterable[Any]) -> Any:
        made = object.__new__(kind)
        made.__dict__.update(zip(static, static_values, strict=True))
        made.__dict__.update(zip(leaves, leaf_values, strict=True))
        return made

    jax.tree_util.register_pytree_with_keys(
        kind,
        lambda each: (list(zip(keys, leaves_of(each), strict=True)), static_of(each)),
        rebuilt,
        lambda each: (leaves_of(each), static_of(each)),
    )


def _fields(names: Sequence[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Make the function that reads fields: asked for in each call with a mechanism, and several times as fast as a
    comprehension."""
    read = attrgetter(*names)
    return read if len(names) > 1 else lambda each: (read(each),)
