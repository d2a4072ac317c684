"""Numbers as files hold them."""

from __future__ import annotations


def written(*numbers: float) -> str:
    """Write numbers in full precision, with blanks between them."""
    return " ".join(repr(float(number)) for number in numbers)
