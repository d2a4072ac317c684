"""What is given by name, and names that were not found: the nearest known one, for messages."""

from __future__ import annotations

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
