"""Names of parts: readable, one for each."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable

from jaxkin._names import free_name

MAX_NAME_LETTERS = 60
"""Letters of a name; exporters chain the names of files into longer ones, which no table or message has room for."""

_END = 16
"""Last letters that a shortened name keeps: numbers that tell names apart are mostly at their end."""

_DAMAGED = {"Cc", "Cn", "Co", "Cs"}
"""Unicode categories of letters that nobody typed: control, unassigned, private, halves of surrogate pairs."""


def cleaned(name: str) -> str:
    """Make a name fit for messages and studies: typed in one line, and of `MAX_NAME_LETTERS` at most."""
    line = in_one_line(name)
    return line if len(line) <= MAX_NAME_LETTERS else f"{line[: MAX_NAME_LETTERS - _END - 3]}...{line[-_END:]}"


def in_one_line(name: str) -> str:
    """Make a name of letters that can be typed in one line; a name of such letters stays as it is.

    White space of any kind becomes one blank, and is left out at the ends; damaged letters become "_", invisible ones
    are left out.
    """
    typed = "".join(" " if letter.isspace() else "_" if _damaged(letter) else letter for letter in name)
    visible = "".join(letter for letter in typed if unicodedata.category(letter) != "Cf")
    return " ".join(visible.split())


def is_damaged(name: str) -> bool:
    """Tell whether a name has letters that nobody typed: control characters, or the rests of another encoding."""
    return any(_damaged(letter) for letter in name if not letter.isspace())


def unique(names: Iterable[str]) -> list[str]:
    """Number the names that come again: "bolt", "bolt#2"."""
    result: dict[str, None] = {}
    used: dict[str, int] = {}
    for name in names:
        result[free_name(name, result, used.get(name, 1))] = None
        used[name] = used.get(name, 1) + 1
    return list(result)


def _damaged(letter: str) -> bool:
    return letter == "\N{REPLACEMENT CHARACTER}" or unicodedata.category(letter) in _DAMAGED
