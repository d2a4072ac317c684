"""The strings of a STEP file: written so that no letter in them looks like one between statements, and read again."""

from __future__ import annotations

import re

_AWKWARD = re.compile(r"[;#\x80-\xff]")
"""Letters of a string that patterns over statements take for the end of one, or for a number of one; and bytes that may
be of any encoding."""

_ESCAPED = re.compile(
    r"\\X2\\((?:[0-9A-Fa-f]{4})+)\\X0\\|\\X4\\((?:[0-9A-Fa-f]{8})+)\\X0\\|\\X\\([0-9A-Fa-f]{2})|\\S\\(.)|\\P[A-I]\\|\\\\",
    re.S,
)
"""What stands for letters in strings: of 16 bits, of 32, of 8, of the upper half, a change of page, and a backslash."""


def plain_strings(text: str) -> str:
    """Write the awkward letters of all strings of a text, decoded byte by byte, in the encoding of STEP.

    Bytes of UTF-8 stay as they are, which readers know. Others, as older systems write them against the norm, are taken
    for Western European ones: readers end the string there. A text with a quotation mark too many is left as it is.
    """
    pieces = text.split("'")  # two within a string stand for one: between them is an empty piece
    if len(pieces) % 2:
        pieces[1::2] = [_plain(each) if _AWKWARD.search(each) else each for each in pieces[1::2]]
    return "'".join(pieces)


def string_value(text: str) -> str:
    """Read what a string says, of what is between its quotation marks, decoded byte by byte."""
    return _ESCAPED.sub(_letters, (_in_utf_8(text) or text).replace("''", "'"))


def _plain(piece: str) -> str:
    """Write one piece of a string."""
    piece = piece.replace(";", r"\X\3B").replace("#", r"\X\23")
    if piece.isascii() or _in_utf_8(piece) is not None:
        return piece
    western = piece.encode("latin-1").decode("cp1252", "replace")
    return "".join(each if each.isascii() else rf"\X2\{ord(each):04X}\X0" "\\" for each in western)


def _in_utf_8(text: str) -> str | None:
    try:
        return text.encode("latin-1").decode("utf-8")
    except ValueError:
        return None


def _letters(found: re.Match[str]) -> str:
    wide, wider, byte, upper = found.groups()
    if wide or wider:
        return bytes.fromhex(wide or wider).decode("utf-16-be" if wide else "utf-32-be", "replace")
    if byte:
        return chr(int(byte, 16))
    if upper:
        return chr((ord(upper) + 128) % 256)
    return "\\" if found[0] == "\\\\" else ""
