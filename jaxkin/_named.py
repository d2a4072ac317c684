"""Joints, displacements and transforms by name: a dictionary whose KeyError says which names there are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NoReturn, TypeVar

import jax

from jaxkin._names import nearest

Entry = TypeVar("Entry")


class Named(dict[str, Entry]):
    """What there is, by name. A pytree, whose entries keep their order."""

    def __init__(self, what: str, entries: Iterable[tuple[str, Entry]]) -> None:
        super().__init__(entries)
        self.what = what
        """What an entry is called in the message: "joint"."""

    def __call__(self, *names: Any, **_: Any) -> NoReturn:
        name = names[0] if names else next(iter(self), "...")
        raise TypeError(f"entries are by {self.what}, and asked for in square brackets: write [{name!r}], and no ()")

    def __missing__(self, name: Any) -> NoReturn:
        joint = str(name).rpartition(".")[0]
        if self.what == "joint" and joint in self:  # a coordinate, as drives, inputs and tables name it
            raise KeyError(
                f"{name!r} is a coordinate, and entries are by joint: write [{joint!r}], whose last axis has the "
                f"coordinates in turn, as mechanism.joints[{joint!r}].coordinates names them"
            )
        raise KeyError(f"there is no {self.what} {name!r}{nearest(str(name), self)}")


jax.tree_util.register_pytree_with_keys(
    Named,
    lambda named: ([(jax.tree_util.DictKey(key), entry) for key, entry in named.items()], (named.what, tuple(named))),
    lambda static, entries: Named(static[0], zip(static[1], entries, strict=True)),
)
