"""Names that were not found: the nearest known one, for messages; parts by pattern; names that are still free; numbers
with their nouns."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping, Sequence
from difflib import get_close_matches
from itertools import count
from typing import Protocol, SupportsInt

_MAX_KNOWN = 8
"""Known names that a message lists at most: more are not read."""


class InAssembly(Protocol):
    """What has a name, and lies in sub-assemblies: a part."""

    @property
    def name(self) -> str: ...

    @property
    def path(self) -> tuple[str, ...]: ...


def match_parts(patterns: str | Sequence[str], parts: Sequence[InAssembly], what: str = "parts") -> tuple[str, ...]:
    """List the parts that some patterns stand for, by name, in the order of the patterns, each once.

    A pattern is a name, a glob ("Base*"), or either with the sub-assemblies before it ("Arm/Base*", "Arm/*"): these may
    begin at any depth, and "*" goes through all that is below. Raises ValueError for a pattern without a match; `what`
    begins the message.
    """
    paths = {part.name: "/".join((*part.path, part.name)) for part in parts}
    found: dict[str, None] = {}
    for pattern in [patterns] if isinstance(patterns, str) else patterns:
        if not isinstance(pattern, str):
            raise ValueError(f"{what} names parts by text, as in 'Base' or 'Arm/Base*', got {pattern!r}")
        names = [pattern] if pattern in paths else _below(pattern, paths)
        if not names:
            known = [*paths, *paths.values()] if "/" in pattern else paths
            raise ValueError(f"{what} names {pattern!r}, which no part matches{nearest(pattern, known)}")
        found |= dict.fromkeys(names)
    return tuple(found)


def may_be_pattern(name: str) -> bool:
    """Tell whether a name has a letter of patterns, or sub-assemblies before it."""
    return bool({*"*?/"} & {*name})


def _below(pattern: str, paths: Mapping[str, str]) -> list[str]:
    """List the names whose path ends in what the pattern stands for; without "/" in it, the name alone does."""
    form = _form(pattern)
    if "/" not in pattern:
        return [name for name in paths if form.fullmatch(name)]
    ends = re.compile("(?:.*/)?" + form.pattern, re.DOTALL)
    return [name for name, path in paths.items() if ends.fullmatch(path)]


def _form(pattern: str) -> re.Pattern[str]:
    """Compile a pattern to a regular expression: "*" is any text, "?" any one letter, all else itself."""
    pieces = re.split(r"([*?])", pattern)
    return re.compile("".join({"*": ".*", "?": "."}.get(each, re.escape(each)) for each in pieces), re.DOTALL)


def nearest(name: str, known: Iterable[str]) -> str:
    """Write the end of a message about an unknown name: "; did you mean 'crank'?", else the names that there are."""
    known = list(known)
    if close := closest(name, known):
        return close
    if not known:
        return "; there is none"
    return f"; there is {listed([repr(other) for other in known])}"


def free_name(name: str, taken: Container[str], first: int = 1) -> str:
    """Return the first of "name", "name#2", "name#3", ... that is not taken, from number `first` on."""
    numbered = (name if number == 1 else f"{name}#{number}" for number in count(first))
    return next(each for each in numbered if each not in taken)


def listed(words: Sequence[str], most: int = _MAX_KNOWN) -> str:
    """Write names with commas, the first few of many: "A, B, C and 40 more"."""
    more = f" and {len(words) - most} more" if len(words) > most else ""
    return ", ".join(words[:most]) + more


def closest(name: object, known: Iterable[str]) -> str:
    """Write the end of a message that lists the known names itself: "; did you mean 'crank'?", or nothing.

    A name of the same words in another order comes first: joints are named by their two parts, in either order.
    """
    known = list(known)
    words = _words(str(name))
    close = [each for each in known if words and _words(each) == words] or get_close_matches(str(name), known, n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _words(name: str) -> list[str]:
    return sorted(re.findall(r"[^\W_]+", name.casefold()))


def counted(number: SupportsInt, noun: str, none: str = "0") -> str:
    """Write a number with a noun in singular or plural, and `none` for zero."""
    number = int(number)
    plural = f"{noun[:-1]}ies" if noun[-1:] == "y" else noun + ("es" if noun.endswith("s") else "s")
    return f"{number or none} {noun if number == 1 else plural}"
