"""What is given by name, and names that were not found: the nearest known one, for messages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

_LISTED = 8
"""Known names that a message lists at most: more are not read."""


def by_name(given: Any, what: str, example: str) -> Mapping[Any, Any]:
    """What was given, if it is a mapping: ValueError with an example otherwise."""
    if not isinstance(given, Mapping):
        raise ValueError(f"{what} are given by name, as in {example}, got {given!r}")
    return given


def match(patterns: Sequence[str], known: Sequence[str], what: str) -> tuple[str, ...]:
    """The known names that some patterns stand for, in their order: "*" is any text, "?" any one letter.

    A name that is known stands for itself, whatever letters it has. Raises ValueError for a pattern without a match.
    """
    found: list[str] = []
    for pattern in patterns:
        if not isinstance(pattern, str) or pattern in known or not {*"*?"} & {*pattern}:
            found.append(pattern)  # whether it is known is checked where it is used
            continue
        parts = re.split(r"([*?])", pattern)
        form = re.compile("".join({"*": ".*", "?": "."}.get(each, re.escape(each)) for each in parts), re.DOTALL)
        names = [name for name in known if form.fullmatch(name)]
        if not names:
            raise ValueError(f"{what} names {pattern!r}, which no part matches{nearest(pattern, known)}")
        found += [name for name in names if name not in found]
    return tuple(found)


def nearest(name: str, known: Iterable[str]) -> str:
    """The end of a message about an unknown name: "; did you mean 'crank'?", else the names that there are."""
    known = list(known)
    if close := closest(name, known):
        return close
    if not known:
        return "; there is none"
    return f"; there is {listed([repr(other) for other in known])}"


def listed(words: Sequence[str]) -> str:
    """Names with commas, the first few of many: "A, B, C and 40 more"."""
    more = f" and {len(words) - _LISTED} more" if len(words) > _LISTED else ""
    return ", ".join(words[:_LISTED]) + more


def closest(name: object, known: Iterable[str]) -> str:
    """The end of a message that lists the known names itself: "; did you mean 'crank'?", or nothing."""
    close = get_close_matches(str(name), list(known), n=1)
    return f"; did you mean {close[0]!r}?" if close else ""
