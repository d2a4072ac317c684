"""Ball bearings that are drawn as one ring of any size, known by their names: a hint, where no size tells."""

from __future__ import annotations

from jaxkin.assembly.inference.part_names import words_of

_ENDINGS = ("bearing", "bearings", "lager", "roulement", "rodamiento", "rolamento", "cuscinetto")
"""How words for bearings end, in English, German, French, Spanish, Portuguese and Italian."""
_OTHERS = ("linear", "plain", "sleeve", "slid", "slide", "journal", "thrust", "gleit", "axial")
"""How words begin that tell of a bearing which slides, or bears along the axis."""


def is_named_bearing(name: str) -> bool:
    """Tell whether the name of a part says that it is a rolling bearing, and not something of one."""
    words = words_of(name)
    return bool(words) and words[-1].endswith(_ENDINGS) and not any(word.startswith(_OTHERS) for word in words)
