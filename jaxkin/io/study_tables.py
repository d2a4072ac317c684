"""What the tables of a study are made of."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

from pydantic import ConfigDict, Field

from jaxkin._names import closest

FiniteNumber = Annotated[float, Field(allow_inf_nan=False)]
"""A finite number."""


def one_of(known: Iterable[str], value: object) -> object:
    """Return a value that is one of the `known` texts; ValueError for another one."""
    if value not in list(known):
        listed = ", ".join(map(repr, filter(None, known)))
        raise ValueError(f"expected one of {listed}, got {value!r}{closest(value, known)}")
    return value


STRICT = ConfigDict(extra="forbid", strict=True)
"""Tables take no keys but those that they name, and convert no types."""
