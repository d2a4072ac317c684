"""Names of parts: one for each."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import count


def unique(names: Iterable[str]) -> list[str]:
    """The names with those that come again numbered: "bolt", "bolt#2"."""
    result: dict[str, None] = {}
    used: dict[str, int] = {}
    for name in names:
        numbered = (name if number == 1 else f"{name}#{number}" for number in count(used.get(name, 1)))
        result[next(candidate for candidate in numbered if candidate not in result)] = None
        used[name] = used.get(name, 1) + 1
    return list(result)
