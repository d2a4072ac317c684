"""A small part of YAML: keys at the margin, with scalars and lists as values.

The loops of a robot are a handful of lists of names. For these a reader of all of YAML (tags, anchors, documents) would
be one more dependency, and most of it a risk. What is read:

- `key: value` at the margin, each key once;
- a value is a scalar, or a list `[a, 'b', [c, d]]` that may go on over several lines;
- or, on the lines after `key:`, a list with one `- value` a line, where `- - value` begins a list in it;
- texts are bare, or in single or double quotes without escapes; comments begin with "#" after a blank.

All scalars are texts. Everything else is refused, with the number of its line, unless it belongs to a key that nobody
asks for.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path

from jaxkin._files import check_file

MAX_YAML_BYTES = 1_000_000
"""Bytes of a file: a robot with a thousand loops has a tenth of that."""

MAX_LETTERS = 4096
"""Letters of a text: far above any name."""

MAX_SHOWN = 80
"""Letters of the file that a message repeats."""

MAX_LEVELS = 20
"""Lists in each other; loops have two."""

Value = str | list["Value"]

_KEY = re.compile(r"([A-Za-z_][\w \-]*?)\s*:(?:\s+|$)(.*)")
_TOKEN = re.compile(r"\s*(?:([\[\],])|'([^']*)'|\"([^\"\\]*)\"|([^\s\[\],'\"{}&*!|>%@`#][^\[\],{}#]*))")


def read_yaml(path: Path, keys: Collection[str] = ()) -> dict[str, Value]:
    """Read the keys and values of a file; FileNotFoundError where there is none, ValueError for what is not read.

    `keys` are those whose values are asked for, all by default: the others may be written in any way, and are empty.
    """
    if (size := check_file(path, "YAML file")) > MAX_YAML_BYTES:
        raise ValueError(f"{path.name}: {size} bytes of YAML; at most {MAX_YAML_BYTES} are read")
    try:
        text = path.read_bytes().decode()
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name}: expected text in UTF-8: {error}") from None
    return parse_yaml(text, path.name, keys)


def parse_yaml(text: str, source: str, keys: Collection[str] = ()) -> dict[str, Value]:
    """Parse a text: see the module and `read_yaml`; `source` begins messages."""
    if re.search(rf"[^,\[\]\n]{{{MAX_LETTERS + 1}}}", text):
        raise ValueError(f"{source}: it holds a text of more than {MAX_LETTERS} letters")
    found: dict[str, Value] = {}
    lines = [(number, line) for number, line in enumerate(map(_uncommented, text.splitlines()), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if line.strip() not in ("---", "...") and line[0] != "%"]
    while lines:
        number, line = lines.pop(0)
        said = _KEY.fullmatch(line.rstrip())
        where = f"{source}, line {number}"
        if said is None:
            raise ValueError(f"{where}: expected a key and its value, name_mot: ['hip', 'knee'], got {_shown(line)}")
        key, value = said[1], said[2]
        if key in found:
            raise ValueError(f"{where}: the key {key!r} is there twice")
        if keys and key not in keys:
            found[key] = ""
            depth = _depth(value)
            while lines and (depth > 0 or lines[0][1][0].isspace() or lines[0][1].startswith("-")):
                depth += _depth(lines.pop(0)[1])
        elif value:
            while value.count("[") > value.count("]") and lines:
                value = f"{value} {lines.pop(0)[1].strip()}"
            found[key] = _flow(value, where)
        else:
            block = []
            while lines and (lines[0][1][0].isspace() or lines[0][1].startswith("-")):
                block.append(lines.pop(0))
            found[key] = _block(block, source) if block else ""
    return found


def _depth(text: str) -> int:
    """Count the brackets that a text leaves open."""
    return sum(text.count(mark) for mark in "[{") - sum(text.count(mark) for mark in "]}")


def _shown(text: str) -> str:
    text = text.strip()
    return repr(text if len(text) <= MAX_SHOWN else f"{text[:MAX_SHOWN]}...")


def _uncommented(line: str) -> str:
    return re.sub(r"(^|\s)#.*", "", line)


def _flow(text: str, where: str) -> Value:
    """Parse a scalar or a list in brackets."""
    position, open_lists = 0, [list[Value]()]
    expected = True
    while text[position:].strip():
        token = _TOKEN.match(text, position)
        if token is None:
            raise ValueError(f"{where}: expected a text or a list, got {_shown(text[position:])}")
        position = token.end()
        mark = token[1]
        if mark == "[" and expected and len(open_lists) <= MAX_LEVELS:
            open_lists.append([])
        elif mark == "]" and len(open_lists) > 1:
            closed = open_lists.pop()
            open_lists[-1].append(closed)
            expected = False
        elif mark == "," and not expected and len(open_lists) > 1:
            expected = True
        elif mark is None and expected:
            open_lists[-1].append(next(group for group in token.groups()[1:] if group is not None).strip())
            expected = False
        else:
            raise ValueError(f"{where}: {mark or token[0].strip()!r} is out of place in {_shown(text)}")
    if len(open_lists) != 1 or len(open_lists[0]) != 1:
        raise ValueError(f"{where}: the list {_shown(text)} is not closed")
    return open_lists[0][0]


def _block(lines: list[tuple[int, str]], source: str) -> list[Value]:
    """Parse a list with one entry a line."""
    result: list[Value] = []
    depth = len(lines[0][1]) - len(lines[0][1].lstrip())
    while lines:
        number, line = lines.pop(0)
        where = f"{source}, line {number}"
        entry = line.strip()
        if len(line) - len(line.lstrip()) != depth or not (entry == "-" or entry.startswith("- ")):
            raise ValueError(f"{where}: expected one more entry, - value, got {entry!r}")
        entry = entry[1:]
        inner: list[tuple[int, str]] = []
        if entry.strip().startswith("- ") or not entry.strip():
            inner = [(number, " " * (depth + 1) + entry)] if entry.strip() else []
            while lines and len(lines[0][1]) - len(lines[0][1].lstrip()) > depth:
                inner.append(lines.pop(0))
            result.append(_block(inner, source) if inner else "")
        else:
            value = entry.strip()
            while value.count("[") > value.count("]") and lines:
                value = f"{value} {lines.pop(0)[1].strip()}"
            result.append(_flow(value, where))
    return result
