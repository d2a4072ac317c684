"""What the products of a STEP file are made of, from its text: solids, and what other systems write beside these.

Surfaces beside solids (datum planes, threads, sketched skins) bound no material and would touch what they cross; the
tessellation of a solid that is there with exact geometry is the same solid once more.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from jaxkin.io.names import cleaned
from jaxkin.io.step_placements import STATEMENT
from jaxkin.io.step_strings import string_value

_NUMBER = re.compile(r"#(\d+)")
_STRING = re.compile(r"'((?:[^']|'')*)'")
_ITEMS = re.compile(r"(\s*#\d+\s*=\s*\w*REPRESENTATION\s*\(\s*(?:'(?:[^']|'')*'|\$)\s*,\s*\()([^()]*)(\).*)", re.S)

EXACT = {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP"}
_TESSELLATED = {"TESSELLATED_SOLID", "TESSELLATED_SHELL"}
_SURFACES = {"SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL", "GEOMETRIC_SET"}
_NO_SOLID = {"AXIS2_PLACEMENT_3D", "CARTESIAN_POINT", "GEOMETRIC_CURVE_SET", *_SURFACES}
"""Items of shapes that are none, and make no solid together."""

DEFINITIONS = {"PRODUCT_DEFINITION", "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS"}

_TELLING = re.compile(r"TESSELLATED_S|_SURFACE_MODEL|\bGEOMETRIC_SET")


class StepShapes:
    """The statements of a STEP file by their numbers."""

    def __init__(self, text: str) -> None:
        self.statements = text.split(";")
        self.kinds: dict[str, str] = {}
        self.bodies: dict[str, str] = {}
        self.places: dict[str, int] = {}
        for place, statement in enumerate(self.statements):
            if found := STATEMENT.fullmatch(statement):
                number, self.kinds[found[1]], self.bodies[found[1]] = found.groups()
                self.places[number] = place

    def solids_alone(self) -> tuple[str, list[str]]:
        """Rewrite the text without open surfaces, and without tessellations beside exact solids; also name the products
        that have the surfaces."""
        sheets = []
        for number, place in self.places.items():
            items = self.items(number)
            kinds = {self.kinds.get(item) for item in items}
            surfaces = {item for item in items if self.kinds.get(item) in _SURFACES and self._is_open(item)}
            twice = {item for item in items if self.kinds.get(item) in _TESSELLATED} if kinds & EXACT else set()
            if surfaces or twice:
                kept = ",".join(f"#{item}" for item in items if item not in surfaces | twice)
                self.statements[place] = _ITEMS.sub(
                    lambda own, kept=kept: own[1] + kept + own[3], self.statements[place]
                )
            if any(self.kinds[item] != "GEOMETRIC_SET" for item in surfaces):  # of which no face is drawn
                sheets.append(number)
        return ";".join(self.statements), self._names(self._products_of(sheets))

    def without_solids(self) -> dict[str, str]:
        """Find the product definitions whose shapes hold no solid, with the names of their products."""
        solid = {self._group(number) for number in self.places if not self._is_bare(number)}
        with_solids = {definition for definition, shape in self.defined() if self._group(shape) in solid}
        unknown = {definition for definition, shape in self.defined() if shape not in self.places}
        definitions = [number for number, kind in self.kinds.items() if kind in DEFINITIONS]
        return {each: self.product(each) for each in definitions if each not in with_solids | unknown}

    def hidden(self) -> list[str]:
        """Name the products of the solids that the file hides, of itself or with the layer that they are on."""
        shapes = {item: number for number in self.places for item in self.items(number)}
        hidden = self._named(self.of_kind("INVISIBILITY"), ("STYLED_ITEM", "LAYER_ASSIGNMENT", "REPRESENTATION"))
        named = {each for number in hidden for each in self.references(number)}
        solids = {each for each in named if self.kinds.get(each) in EXACT | _TESSELLATED}
        whole = {number for number in hidden | named if not self._is_bare(number)}
        return self._names(self._products_of(whole | {shapes[each] for each in solids if each in shapes}))

    def of_kind(self, kind: str) -> list[str]:
        """List the numbers of the statements of a kind."""
        return [number for number, own in self.kinds.items() if own == kind]

    def items(self, number: str) -> list[str]:
        """List the items of a representation; none of what is no representation."""
        found = _ITEMS.fullmatch(self.statements[self.places[number]]) if number in self.places else None
        return _NUMBER.findall(found[2]) if found else []

    def _is_bare(self, number: str) -> bool:
        return all(self.kinds.get(item) in _NO_SOLID for item in self.items(number))

    def _is_open(self, number: str) -> bool:
        """Tell whether surfaces have a rim: an edge that one face has, once."""
        if self.kinds[number] == "GEOMETRIC_SET":
            return True
        shells = self._named({number}, ("SHELL", "FACE_SET"))
        faces = self._named(shells | self._named(shells, ("SHELL",)), ("FACE",))
        loops = self._named(self._named(faces | self._named(faces, ("FACE",)), ("BOUND",)), ("EDGE_LOOP",))
        sides = [side for loop in loops for side in self.references(loop)]
        return 1 in Counter(edge for side in sides for edge in self.references(side)).values()

    def _named(self, numbers: Iterable[str], kinds: tuple[str, ...]) -> set[str]:
        """Find what some statements name whose kind ends so."""
        named = (each for number in numbers for each in self.references(number))
        return {each for each in named if self.kinds.get(each, "").endswith(kinds)}

    def rename(self, number: str, names: Mapping[str, str]) -> None:
        """Let a statement name others in place of those that it names."""
        place = self.places[number]
        head, equals, rest = self.statements[place].partition("=")
        self.statements[place] = head + equals + _NUMBER.sub(lambda own: f"#{names.get(own[1], own[1])}", rest)

    def references(self, number: str) -> list[str]:
        """List the numbers that a statement names, in turn."""
        return _NUMBER.findall(_STRING.sub("", self.bodies.get(number, "")))

    def defined(self) -> Iterator[tuple[str, str]]:
        """List the product definitions that have shapes, each with a representation of it."""
        for number, kind in self.kinds.items():
            if kind == "SHAPE_DEFINITION_REPRESENTATION":
                shape, representation = (*self.references(number), "", "")[:2]
                for definition in self.references(shape)[:1]:
                    yield definition, representation

    @cached_property
    def _groups(self) -> dict[str, str]:
        """One of all representations that say the same as each one, without a transformation between them."""
        import networkx as nx

        related = (number for number, kind in self.kinds.items() if kind.endswith("REPRESENTATION_RELATIONSHIP"))
        named = map(self.references, related)
        pairs = [(pair[0], pair[1]) for pair in named if len(pair) == 2]
        return {each: min(group) for group in nx.connected_components(nx.Graph(pairs)) for each in group}

    def _group(self, representation: str) -> str:
        return self._groups.get(representation, representation)

    def _products_of(self, representations: Iterable[str]) -> list[str]:
        """Find the product definitions of some representations."""
        wanted = set(map(self._group, representations))
        return [definition for definition, shape in self.defined() if self._group(shape) in wanted]

    def _names(self, definitions: Iterable[str]) -> list[str]:
        return [*dict.fromkeys(filter(None, map(self.product, definitions)))]

    def product(self, definition: str) -> str:
        """Find the name of the product of a definition, cleaned; "" where there is none."""
        for formation in self.references(definition)[:1]:
            for product in self.references(formation)[:1]:
                if self.kinds.get(product) == "PRODUCT":
                    named = map(string_value, _STRING.findall(self.bodies[product])[1::-1])
                    return next(filter(None, map(cleaned, named)), "")
        return ""


def solids_alone(text: str) -> tuple[str, list[str]]:
    """Rewrite the text of a file as `StepShapes.solids_alone` does, where there is something to leave out."""
    return StepShapes(text).solids_alone() if _TELLING.search(text) else (text, [])
