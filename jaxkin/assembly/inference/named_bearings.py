"""Ball bearings that are drawn as one ring of any size, known by their names: a hint, where no size tells."""

from __future__ import annotations

import re

_ENDINGS = ("bearing", "bearings", "lager", "roulement", "rodamiento", "rolamento", "cuscinetto")
"""How words for bearings end, in English, German, French, Spanish, Portuguese and Italian."""
_OTHERS = ("linear", "plain", "sleeve", "slid", "slide", "journal", "thrust", "gleit", "axial")
"""How words begin that tell of a bearing which slides, or bears along the axis."""
_SHORT = 2
"""Letters of a word that is no more than a mark of place, such as a side."""
_PLACES = frozenset(("left", "right", "front", "rear", "upper", "lower", "top", "bottom"))
"""Words that may follow: others make it something of the bearing, its cap or its block."""


def is_named_bearing(name: str) -> bool:
    """Tell whether the name of a part says that it is a rolling bearing, and not something of one."""
    words = [word for word in re.findall(r"[^\W\d_]+", name.lower()) if len(word) > _SHORT and word not in _PLACES]
    return bool(words) and words[-1].endswith(_ENDINGS) and not any(word.startswith(_OTHERS) for word in words)
