"""Reports that fit on a screen: of many lines of one kind, how many there are and what the first one says."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Sequence

SCREEN = 40
"""Lines of one section of a report that are printed one by one: more do not fit on a screen."""
MAX_LINES = 12
"""Lines of a longer section, or of one kind in a result, that are printed: a report has several of them, and what
follows is to be seen, too. Of an assembly of 67 parts it has 90 lines in place of 146, of which the last 60 say what to
fix and what moves."""
_NUMBER = re.compile(r"(?<![A-Za-z])-?\d[\d.]*(?:e[+-]?\d+)?")
_QUOTED = re.compile(r"'[^']*'")
_INSTANCE = re.compile(r"(?:\s*(?:<\d+>|\(\d+\)|:\d+|#\d+))+$")
"""What CAD systems, and readers after them, add to the name of a product: nobody calls a product so."""
_COUNTED = re.compile(r"(.*[^-_ .])[-_ ]+(\d+)|(.*[^-_ .\d])\.(\d+)")
"""A name that ends in a number, which may count instances or be a size."""
_OF_SIZE = re.compile(r"(?<![^\W\d])[xX\u00d7]$")
"""What stands before a size, as in "M10 x 35"; not the end of a word, as in "Box 2"."""


def products(names: Iterable[str]) -> dict[str, str]:
    """Map names of parts to the names of their products: without what tells them from others of the same product.

    That is "<2>", "(2)", ":2" or "#2" at their end, also several, as in "bolt:1#2". A number alone, as in "bolt 2",
    "bolt_2", "bolt-2" and "bolt.2", may as well be a size: it is taken away where others with the same words before it
    count from 0 or 1 on, with fewer gaps than numbers.
    """
    bare = {name: _INSTANCE.sub("", name) or name for name in names}
    counts: dict[str, set[int]] = {}
    stems: dict[str, str] = {}
    for name in {*bare.values()}:
        if found := _COUNTED.fullmatch(name):
            stem, number = (each for each in found.groups() if each is not None)
            if not _OF_SIZE.search(stem):
                stems[name] = stem
                counts.setdefault(stem, {1} if stem in bare.values() else set()).add(int(number))
    counting = {stem for stem, found in counts.items() if min(found) <= 1 and 1 < len(found) > max(found) / 2}
    return {name: stems[each] if stems.get(each) in counting else each for name, each in bare.items()}


def kind_of(text: str) -> str:
    """Return a text without its numbers and without names in quotes, so that texts of one kind are equal."""
    return _NUMBER.sub("#", _QUOTED.sub("#", text))


def shortened(lines: Sequence[str]) -> list[str]:
    """Return all lines if they fit on a screen, else the first ones, and how many more there are."""
    return list(lines) if len(lines) <= SCREEN else [*lines[:MAX_LINES], f"and {len(lines) - MAX_LINES} more"]


def grouped(entries: Iterable[tuple[Hashable, str]], verbose: bool = False) -> list[str]:
    """List texts, each given with what tells its kind; of more than SCREEN only the first of each kind, and a count.

    Kinds come in order of their number. With `verbose` all texts are listed.
    """
    entries = list(entries)
    return [text for _, text in entries] if verbose or len(entries) <= SCREEN else first_of_each(entries)


def first_of_each(entries: Iterable[tuple[Hashable, str]]) -> list[str]:
    """List the first text of each kind, with how many there are; the most frequent kind first."""
    kinds: dict[Hashable, list[str]] = {}
    for kind, text in entries:
        kinds.setdefault(kind, []).append(text)
    return [
        texts[0] if len(texts) == 1 else f"{len(texts)} such as  {texts[0]}"
        for texts in sorted(kinds.values(), key=len, reverse=True)
    ]
