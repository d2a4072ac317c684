"""Words in the names of parts: hints of what a part is, where its form does not tell."""

from __future__ import annotations

import re

_SHORT = 2
"""Letters of a word that is no more than a mark of place, such as a side."""
_PLACES = frozenset(("left", "right", "front", "rear", "upper", "lower", "top", "bottom", "links", "rechts"))
"""Words of places: they may follow what a part is, where others make it something of that, as in "motor plate"."""
_COPIES = frozenset(("mirror", "mirrored", "copy"))
"""Words that CAD systems add to names of copies."""


def words_of(name: str) -> list[str]:
    """List the words of a name in small letters, without numbers, marks of place and of copies: the last one says what
    the part is."""
    words = re.findall(r"[^\W\d_]+", name.lower())
    return [word for word in words if len(word) > _SHORT and word not in _PLACES and word not in _COPIES]
