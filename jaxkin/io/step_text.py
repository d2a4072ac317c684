"""The text of a STEP file (ISO 10303-21) as it is read: from its begin to its end, without comments, in one section."""

from __future__ import annotations

import re

from jaxkin.io.step_strings import plain_strings

_PACKED = {b"\x1f\x8b": "gzip", b"PK\x03\x04": "zip"}
"""How files begin that are packed."""

_BEGIN = re.compile(r"(?:\xef\xbb\xbf)?\s*ISO-10303-21\s*;")
"""After the mark of UTF-8, where there is one."""

_END = re.compile(r"END-ISO-10303-21\s*;")
_ANOTHER = re.compile(r"(?<!END-)\bISO-10303-21\s*;")
_SECTION_END = re.compile(r"\bENDSEC\s*;")
_DATA = re.compile(r"\bDATA\s*(?:\([^;]{0,200}\)\s*)?;")
_NEXT_DATA = re.compile(r"\bENDSEC\s*;\s*DATA\s*(?:\([^;]{0,200}\)\s*)?;")


def step_text(data: bytes, name: str) -> str:
    """Decode the content of a STEP file, byte by byte, without what its reader stumbles on.

    Comments are left out; so is what follows the end of the file, as a signature or padding, and sections of the third
    edition beside those of data, which become one. In strings there is neither ; nor #. `name` is what messages call
    the file. Raises ValueError for content that is no whole STEP file, or several of them.
    """
    if not data.strip(b"\0 \t\r\n"):
        raise ValueError(f"{name} is empty: expected a STEP file")
    if packed := next((how for begin, how in _PACKED.items() if data.startswith(begin)), None):
        raise ValueError(f"{name} is packed by {packed}: unpack it, and load the STEP file in it")
    text = _without_comments(data.decode("latin-1"))
    if not _BEGIN.match(text):
        raise ValueError(f"{name} is not a STEP file: it does not begin with ISO-10303-21;")
    if (end := _END.search(text)) is None:
        raise ValueError(f"{name} is cut off: it does not end with END-ISO-10303-21; copy or export it again")
    if _ANOTHER.search(text, end.end()):
        raise ValueError(f"{name} holds several STEP files, one after the other: load them one by one")
    return _in_one_section(plain_strings(text[: end.end()]))


def _without_comments(text: str) -> str:
    """Leave comments out: some readers take them for a part of a statement, and a semicolon in them for its end."""
    pieces, at, quoted = [], 0, False
    while (start := text.find("/*", at)) >= 0:
        quoted ^= text.count("'", at, start) % 2 == 1  # two apostrophes in a string stand for one
        end = start if quoted else text.find("*/", start + 2)
        if end < 0:
            break
        pieces.append(text[at : start + 2] if quoted else text[at:start] + " ")
        at = end + 2
    return "".join(pieces) + text[at:]


def _in_one_section(text: str) -> str:
    """Unite the sections of data, and leave out those of the third edition between the header and them."""
    header = _SECTION_END.search(text)
    data = _DATA.search(text, header.end()) if header else None
    if header is None or data is None:
        return text
    return f"{text[: header.end()]}\nDATA;{_NEXT_DATA.sub('', text[data.end() :])}"
