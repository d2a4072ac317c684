"""STEP files whose parts are in other files, beside them: all of them as one text, as if exported so.

An assembly has for such a part a product without a shape, and a document, the file. In the text of all the occurrences
of that product are those of the one at the top of its file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from jaxkin.io.step_shapes import DEFINITIONS, StepShapes
from jaxkin.io.step_strings import string_value

_SUFFIXES = (".stp", ".step", ".p21")
"""Suffixes of documents that may have parts, in small letters; others are drawings and data sheets."""

_NUMBER = re.compile(r"#(\d+)")
_STRING = re.compile(r"'((?:[^']|'')*)'")
_DATA = re.compile(r"\bDATA\s*(?:\([^;]{0,200}\)\s*)?;")
_OCCURRENCE = "NEXT_ASSEMBLY_USAGE_OCCURRENCE"
_RELATED = re.compile(r"(\bREPRESENTATION_RELATIONSHIP\s*\()([^()]*)\)")


def with_other_files(
    text: str, path: Path, read: Callable[[Path], str], most: int, above: tuple[Path, ...] = ()
) -> str:
    """Put what is in other files into the text of the STEP file at `path`, and what is in those that these refer to.

    `read` reads the text of a file. Files that are not beside it are left as they are referred to. Raises ValueError
    for files that refer to each other in a circle, for one with several products at its top, and where the text would
    have more than `most` letters.
    """
    if "DOCUMENT_FILE" not in text:
        return text
    master = StepShapes(text)
    documents = {number: file for number, file in _documents(master, path.parent)}
    wanted = dict(_definitions(master, documents))
    if not wanted:
        return text
    seen = (*above, path.resolve())
    tops: dict[Path, tuple[str, str]] = {}
    more: list[str] = []
    for file in dict.fromkeys(wanted.values()):
        if file.resolve() in seen:
            raise ValueError(f"{path.name} is damaged: it has its parts in {file.name}, which has them in {path.name}")
        other = with_other_files(read(file), file, read, most, seen)
        first = 1 + max(map(int, _NUMBER.findall(text + "".join(more))), default=0)
        if len(text) + sum(map(len, more)) + len(other) > most:
            raise ValueError(f"{path.name} and the files with its parts are too large together: export it part by part")
        shifted = _NUMBER.sub(lambda own, by=first: f"#{int(own[1]) + by}", other)
        tops[file] = _top(StepShapes(shifted), file.name, path.name)
        more.append(_statements(shifted))
    for definition, file in wanted.items():
        _placed_instead(master, definition, *tops[file])
    for number in {number for number, file in documents.items() if file in tops}:
        place = master.places[number]  # told are those that are missing
        master.statements[place] = _STRING.sub("''", master.statements[place], count=1)
    own = ";".join([*filter(None, master.statements[:-1]), master.statements[-1]])
    end = own.rindex("ENDSEC")
    return own[:end] + "".join(more) + own[end:]


def _documents(master: StepShapes, folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield the documents that are STEP files in the folder: the number of each, and its file. What it is called stands
    in itself, or in what assigns it to an external source."""
    there = {file.name.casefold(): file for file in folder.iterdir()}
    called: dict[str, list[str]] = {}
    for number, kind in master.kinds.items():
        if kind == "DOCUMENT_FILE":
            called.setdefault(number, []).extend(_STRING.findall(master.bodies[number])[:2])
        elif kind.endswith("EXTERNAL_IDENTIFICATION_ASSIGNMENT"):
            names = _STRING.findall(master.bodies[number])[:1]
            references = master.references(number)
            sources = (each for each in references if master.kinds.get(each) == "EXTERNAL_SOURCE")
            names += [name for each in sources for name in _STRING.findall(master.bodies[each])]
            for each in references:
                called.setdefault(each, []).extend(names)
    for number, names in called.items():
        if master.kinds.get(number) == "DOCUMENT_FILE":
            plain = (string_value(name).replace("\\", "/").rpartition("/")[2].casefold() for name in names)
            found = next((there[name] for name in plain if name.endswith(_SUFFIXES) and name in there), None)
            if found is not None and found.is_file():
                yield number, found


def _definitions(master: StepShapes, documents: dict[str, Path]) -> Iterator[tuple[str, Path]]:
    """Yield the product definitions that have no shape and nothing in them, but a document, and its file."""
    assemblies = {master.references(each)[0] for each in master.of_kind(_OCCURRENCE) if master.references(each)}
    bare = master.without_solids().keys() - assemblies
    above = {each: master.references(each)[0] for each in bare if master.references(each)}
    of_products = {  # documents that are products themselves, with the files that they are in
        master.references(each)[1]: master.references(each)[0]
        for each in master.of_kind("DOCUMENT_PRODUCT_EQUIVALENCE")
        if len(master.references(each)) > 1
    }
    files = dict(documents)
    for each in master.of_kind("PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS"):
        formation, *rest = master.references(each) or [""]
        found = next((documents[one] for one in rest if one in documents), None)
        if formation in of_products and found is not None:
            files[of_products[formation]] = found
    for number in master.of_kind("APPLIED_DOCUMENT_REFERENCE"):
        document, *items = master.references(number) or [""]
        if document in files:
            yield from ((one, files[document]) for one in bare if one in items or above.get(one) in items)


def _top(other: StepShapes, file: str, source: str) -> tuple[str, str]:
    """Find the product definition at the top of a file, and its shape."""
    placed = {each for number in other.of_kind(_OCCURRENCE) for each in other.references(number)[1:2]}
    shapes: dict[str, str] = {}
    for definition, shape in other.defined():
        if definition not in placed and other.kinds.get(definition) in DEFINITIONS:
            shapes.setdefault(definition, shape)
    if len(shapes) != 1:
        raise ValueError(
            f"{source} has a part in {file}, which holds {len(shapes)} products side by side: export that part as one"
        )
    return next(iter(shapes.items()))


def _placed_instead(master: StepShapes, definition: str, top: str, shape: str) -> None:
    """Let the occurrences of a product definition be those of another one, with its shape."""
    own = {each for one, each in master.defined() if one == definition}
    occurrences = [each for each in master.of_kind(_OCCURRENCE) if definition in master.references(each)[1:2]]
    shaped = {
        each for each in master.of_kind("PRODUCT_DEFINITION_SHAPE") if {*master.references(each)} & {*occurrences}
    }
    relations = {
        master.references(each)[0]
        for each in master.of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")
        if {*master.references(each)} & shaped
    }
    for each in occurrences:
        master.rename(each, {definition: top})
    for place, statement in enumerate(master.statements):
        if statement.partition("=")[0].strip(" \r\n\t#") in relations:
            master.statements[place] = _RELATED.sub(
                lambda found: (
                    found[1] + _NUMBER.sub(lambda one: f"#{shape if one[1] in own else one[1]}", found[2]) + ")"
                ),
                statement,
            )
    for number in master.of_kind("SHAPE_DEFINITION_REPRESENTATION"):  # else it is a part without a solid
        if master.references(number)[1:2] and master.references(number)[1] in own:
            master.statements[master.places[number]] = ""


def _statements(text: str) -> str:
    """Return the statements of a whole STEP file."""
    data = _DATA.search(text)
    return text[data.end() if data else 0 : text.rindex("ENDSEC")]
