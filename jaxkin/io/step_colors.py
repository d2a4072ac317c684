"""One colour for each product of a STEP file, written into its text before it is converted.

The reader names the faces of the first colour of a product only. A product with several colours would have to be read
again without any, together with the whole file.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

_STATEMENT = re.compile(r"\s*#(\d+)\s*=\s*(\w*)(.*)", re.S)
_NUMBER = re.compile(r"#(\d+)")
_STYLES = re.compile(r"(STYLED_ITEM\s*\(\s*'(?:[^']|'')*'\s*,\s*)\([^()]*\)")
_SOLIDS = {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP"}
_FACES = {"ADVANCED_FACE", "FACE_SURFACE"}
_OF_LINES = {"CURVE_STYLE", "POINT_STYLE"}
"""Styles that say nothing of faces."""

_MAX_STATEMENTS = 100
"""Statements of one style: ten in real files, any number in damaged ones."""

_MAX_DEPTH = 2
"""Shells above the faces of a solid: that of a void is one inside of another."""


def one_color_each(text: str) -> str:
    """Rewrite the text of a file: the colour of most faces of a product for all that is coloured in this product.

    The text is returned as it is where no product has several colours. Faces and solids without a colour stay so.
    """
    return text if "STYLED_ITEM" not in text else _Colored(text).with_one_each()


class _Colored:
    """The statements of a STEP file, by their numbers."""

    def __init__(self, text: str) -> None:
        self.statements = text.split(";")
        self.places: dict[str, int] = {}
        self.kinds: dict[str, str] = {}
        self.styled: dict[str, str] = {}
        """The statement that gives a face or a solid its style."""
        for place, statement in enumerate(self.statements):
            if found := _STATEMENT.match(statement):
                number, self.kinds[found[1]], rest = found.groups()
                self.places[number] = place
                if self.kinds[number] in ("STYLED_ITEM", "OVER_RIDING_STYLED_ITEM"):
                    named = _NUMBER.findall(rest)
                    last = -1 if self.kinds[number] == "STYLED_ITEM" else -2  # then comes the style that is overridden
                    if len(named) >= -last:
                        self.styled[named[last]] = number

    def with_one_each(self) -> str:
        """Rewrite the text with one colour for each product."""
        done: set[str] = set()
        for number, kind in self.kinds.items():
            if kind.endswith("SHAPE_REPRESENTATION"):
                solids = [each for each in self._named(number) if self.kinds.get(each) in _SOLIDS and each not in done]
                done.update(solids)
                self._unite(solids)
        return ";".join(self.statements)

    def _named(self, number: str) -> list[str]:
        """List the numbers that a statement names."""
        return _NUMBER.findall(self.statements[self.places[number]])[1:] if number in self.places else []

    def _unite(self, solids: list[str]) -> None:
        """Give the styled faces of some solids, and these, the style of most faces."""
        faces = {face: solid for solid in solids for face in self._faces(solid)}
        styled = [item for item in (*faces, *solids) if item in self.styled]
        styles = {item: self._style(self.styled[item]) for item in styled}
        counts = Counter(styles.get(face) or styles.get(solid) for face, solid in faces.items())
        del counts[None]
        if len(counts) < 2:
            return
        chosen = counts.most_common(1)[0][0]
        model = self.statements[self.places[self.styled[next(item for item in styled if styles[item] == chosen)]]]
        if found := _STYLES.search(model):
            given = found[0].removeprefix(found[1])
            for item in styled:
                place = self.places[self.styled[item]]
                self.statements[place] = _STYLES.sub(lambda own: own[1] + given, self.statements[place])

    def _faces(self, number: str, depth: int = 0) -> Iterator[str]:
        """List the faces of a solid, or of a shell at some depth below it."""
        for each in self._named(number):
            if self.kinds.get(each) in _FACES:
                yield each
            elif self.kinds.get(each, "").endswith("SHELL") and depth < _MAX_DEPTH:
                yield from self._faces(each, depth + 1)

    def _style(self, number: str) -> tuple[str, ...]:
        """Find what the style of a face or a solid comes down to: colour, transparency."""
        found = _STYLES.search(self.statements[self.places[number]])
        todo, ends = _NUMBER.findall(found[0]) if found else [], []
        seen = {number}
        while todo and len(seen) < _MAX_STATEMENTS:
            each = todo.pop()
            if each in seen or each not in self.places or self.kinds[each] in _OF_LINES:
                continue
            seen.add(each)
            below = self._named(each)
            todo += below
            if not below:
                ends.append(self.statements[self.places[each]].partition("=")[2].strip())
        return tuple(sorted(ends))
