"""Values as TOML."""

from __future__ import annotations

import json
from collections.abc import Mapping


def toml(value: object) -> str:
    """Return a value as TOML: JSON's texts, lists and numbers are TOML's too, its tables are not."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{toml_key(key)} = {toml(each)}' for key, each in value.items())} }}"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_key(name: str) -> str:
    """Return a name as the key of a table, in quotes where it needs them."""
    return name if name.replace("-", "").replace("_", "").isalnum() and name.isascii() else toml(name)


def comment(text: str) -> list[str]:
    """Return a text as comments, a line each."""
    return [f"# {line}" for line in text.splitlines()]
