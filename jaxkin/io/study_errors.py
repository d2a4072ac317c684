"""What is wrong in a study, in words: file, key, what arrived, what was expected, and the nearest name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from jaxkin._names import nearest

if TYPE_CHECKING:
    from pydantic import ValidationError

_MAX_MISTAKES = 5
"""Mistakes that a message lists at most."""
_MAX_SHOWN_LETTERS = 60
"""Letters of what arrived that are shown."""

_MEANT = {"count": "poses", "steps": "poses", "number": "poses", "start": "from", "stop": "to", "end": "to"}
"""Keys that other programs have -> those of a study, where a table has these: by their letters others are nearer."""

_EXPECTED = {
    "string_type": "a text in quotes",
    "list_type": "a list in brackets",
    "dict_type": "a table",
    "model_type": "a table",
    "bool_type": "true or false",
    "int_type": "a whole number",
    "float_type": "a number",
    "finite_number": "a finite number",
    "greater_than": "a number greater than {gt}",
    "greater_than_equal": "a number not less than {ge}",
    "less_than_equal": "a number not greater than {le}",
    "literal_error": "{expected}",
}


def messages(error: ValidationError, file: str, keys: Mapping[tuple[str, ...], Sequence[str]]) -> str:
    """Tell all mistakes that pydantic found, a line each. `keys` are those that the tables know; "*" is any name."""
    found = error.errors(include_url=False)
    lines = [f"{file}: {_said(one, keys)}" for one in found[:_MAX_MISTAKES]]
    left = len(found) - _MAX_MISTAKES
    more = [f"{file}: and {left} more mistake{'s' if left > 1 else ''}"] if left > 0 else []
    return "\n".join(lines + more)


def _said(error: Any, keys: Mapping[tuple[str, ...], Sequence[str]]) -> str:
    place = _path(error["loc"])
    context = error.get("ctx", {})
    match error["type"]:
        case "missing":
            return f"{place} is missing"
        case "extra_forbidden":
            return _unknown(error["loc"], place, keys)
        case "too_short" | "too_long":
            length = context.get("min_length", context.get("max_length"))
            at_least = "at least " if {error["loc"][0], error["loc"][-1]} & {"fixed", "rigid", "values"} else ""
            return f"{place}: expected a list of {at_least}{length}, got {_shown(error['input'])}"
        case "value_error":
            return f"{place}: {context['error']}"
    expected = str(_EXPECTED.get(error["type"], error["msg"])).format_map(context)
    return f"{place}: expected {expected}, got {_shown(error['input'])}{_misplaced(error['loc'], keys)}"


def _unknown(loc: Sequence[str | int], place: str, keys: Mapping[tuple[str, ...], Sequence[str]]) -> str:
    *table, key = map(str, loc)
    by_name = keys.get((*table[:-1], "*")) if table else None
    known = keys.get(tuple(table)) or by_name or ()
    meant = f"; did you mean {_MEANT[key]!r}?" if _MEANT.get(key) in known else ""
    advice = _misplaced(loc, keys) or meant or nearest(key, known)
    if by_name and "did you mean" not in advice:
        advice += f"; a name with a dot stands in quotes: {table[-1] + '.' + key!r}"
    return f"there is no key {place!r}{advice}"


def _misplaced(loc: Sequence[str | int], keys: Mapping[tuple[str, ...], Sequence[str]]) -> str:
    """Tell of keys of the whole file that come after a table, to which TOML says that they belong: the usual slip."""
    key = str(loc[-1])
    return (
        f"; if {key} is meant for the whole file, write it above the first [table]"
        if len(loc) > 1 and key in keys[()]
        else ""
    )


def _path(loc: Sequence[str | int]) -> str:
    """Write the key as one would write it: joints.A.axis[2]; a name with other letters than those of a bare key in
    quotes."""
    path = ""
    for name in loc:
        if isinstance(name, int):
            path += f"[{name}]"
        else:
            bare = name.replace("-", "").replace("_", "").isalnum() and name.isascii()
            path += f"{'.' if path else ''}{name if bare else repr(name)}"
    return path or "the file"


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _MAX_SHOWN_LETTERS else f"{text[: _MAX_SHOWN_LETTERS - 1]}…"
