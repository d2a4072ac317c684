"""The documents of the repository: the pages that are written, and the blocks of code in them."""

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
"""CHANGELOG has no code, and may name what is gone."""


class Block(NamedTuple):
    """A fenced block of a page."""

    language: str
    text: str
    line: int
    """The line of the page on which the text begins, the first being 1."""


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page, in order; those of a language only."""
    text = page.read_text(encoding="utf-8")
    found = re.finditer(r"^( *)```(\w+)[^\n]*\n(.*?)^\1```$", text, re.M | re.S)
    return [Block(match[2], match[3], text.count("\n", 0, match.start(3)) + 1) for match in found]


def name(page: Path) -> str:
    """The page as tests are named after it."""
    return page.relative_to(ROOT).as_posix()
