"""Values as TOML."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping


def toml(value: object) -> str:
    """Return a value as TOML: JSON's texts and numbers are TOML's too, but for infinite ones; its tables are not."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{toml_key(key)} = {toml(each)}' for key, each in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml, value))}]"
    if isinstance(value, float) and math.isinf(value):
        return str(value)
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_key(name: str) -> str:
    """Return a name as the key of a table, in quotes where it needs them."""
    return name if name.replace("-", "").replace("_", "").isalnum() and name.isascii() else toml(name)


def comment(text: str) -> list[str]:
    """Return a text as comments, a line each."""
    return [f"# {line}" for line in text.splitlines()]
