"""A small part of YAML: keys at the margin, with scalars and lists as values.

The loops of a robot are a handful of lists of names. For these a reader of all of YAML (tags, anchors, documents) would
be one more dependency, and most of it a risk. What is read:

- `key: value` at the margin, each key once, or the value on the lines after `key:`;
- a value is a scalar, or a list `[a, 'b', [c, d]]` that may go on over several lines;
- or, on the lines after `key:`, a list with one `- value` a line, where `- - value` begins a list in it;
- texts are bare, in single quotes that are doubled inside, or in double quotes without escapes;
- comments begin with "#" after a blank outside of quotes.

All scalars are texts; nothing, `null` or `~`, is an empty one. Everything else is refused, with the number of its line,
unless it belongs to a key that nobody asks for.
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

BYTE_ORDER_MARK = "\ufeff"
"""What some editors begin a file with."""

Value = str | list["Value"]

NULLS = ("~", "null", "Null", "NULL")
"""Bare texts that stand for nothing."""

_SINGLE, _DOUBLE = r"'((?:[^']|'')*)'", r'"([^"\\]*)"'
_BARE = r"""([^\s\[\],'"{}&*!|>%@`#](?:[^\[\],{}#]|(?<=\S)#)*)"""
_KEY = re.compile(rf"(?:{_SINGLE}|{_DOUBLE}|([A-Za-z_][\w \-]*?))\s*:(?:\s+|$)(.*)")
_TOKEN = re.compile(rf"\s*(?:([\[\],])|{_SINGLE}|{_DOUBLE}|{_BARE})")
_QUOTED_OR_COMMENT = re.compile(rf"(?:^|(?<=[\s\[,]))(?P<quoted>{_SINGLE}|{_DOUBLE})|(?:^|\s)#.*")


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
    text = text.removeprefix(BYTE_ORDER_MARK)
    lines = [(number, line) for number, line in enumerate(map(_uncommented, text.splitlines()), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if line.strip() not in ("---", "...") and line[0] != "%"]
    while lines:
        number, line = lines.pop(0)
        said = _KEY.fullmatch(line.rstrip())
        where = f"{source}, line {number}"
        if said is None:
            raise ValueError(f"{where}: expected a key and its value, name_mot: ['hip', 'knee'], got {_shown(line)}")
        key, value = _scalar(*said.groups()[:3]), said[4]
        if key in found:
            raise ValueError(f"{where}: the key {key!r} is there twice")
        if keys and key not in keys:
            found[key] = ""
            depth = _depth(value)
            while lines and (depth > 0 or lines[0][1][0].isspace() or lines[0][1].startswith("-")):
                depth += _depth(lines.pop(0)[1])
        elif value:
            found[key] = _flow(_whole(value, lines), where)
        else:
            block = []
            while lines and (lines[0][1][0].isspace() or lines[0][1].startswith("-")):
                block.append(lines.pop(0))
            if block and not _is_entry(block[0][1]):
                found[key] = _flow(" ".join(line.strip() for _, line in block), f"{source}, line {block[0][0]}")
            else:
                found[key] = _block(block, source) if block else ""
    return found


def _depth(text: str) -> int:
    """Count the brackets that a text leaves open, but for those in quotes."""
    text = _QUOTED_OR_COMMENT.sub("", text)
    return sum(text.count(mark) for mark in "[{") - sum(text.count(mark) for mark in "]}")


def _whole(value: str, lines: list[tuple[int, str]]) -> str:
    """Take from the lines that follow those in which the lists of a value go on."""
    while _depth(value) > 0 and lines:
        value = f"{value} {lines.pop(0)[1].strip()}"
    return value


def _scalar(single: str | None, double: str | None, bare: str | None) -> str:
    """Read a text that was written in one of three ways: the two others are None."""
    if bare is not None:
        return "" if bare.strip() in NULLS else bare.strip()
    return double or (single or "").replace("''", "'")


def _is_entry(line: str) -> bool:
    """Tell whether a line is an entry of a list."""
    return line.strip() == "-" or line.strip().startswith("- ")


def _shown(text: str) -> str:
    text = text.strip()
    return repr(text if len(text) <= MAX_SHOWN else f"{text[:MAX_SHOWN]}...")


def _uncommented(line: str) -> str:
    return _QUOTED_OR_COMMENT.sub(lambda found: found["quoted"] or "", line)


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
            open_lists[-1].append(_scalar(*token.groups()[1:]))
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
        if len(line) - len(line.lstrip()) != depth or not _is_entry(entry):
            raise ValueError(f"{where}: expected one more entry, - value, got {entry!r}")
        entry = entry[1:]
        inner: list[tuple[int, str]] = []
        if entry.strip().startswith("- ") or not entry.strip():
            inner = [(number, " " * (depth + 1) + entry)] if entry.strip() else []
            while lines and len(lines[0][1]) - len(lines[0][1].lstrip()) > depth:
                inner.append(lines.pop(0))
            result.append(_block(inner, source) if inner else "")
        else:
            result.append(_flow(_whole(entry.strip(), lines), where))
    return result
