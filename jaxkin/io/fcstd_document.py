"""Documents of FreeCAD (.FCStd): a zip archive whose Document.xml lists objects with their properties.

Poses, links and numbers are there; solids are in other files of the archive, and are not read.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element
from zipfile import BadZipFile, ZipFile

import numpy as np

from jaxkin._files import check_file
from jaxkin.geometry.pose import Transform
from jaxkin.io.robot_model import numbers, placed, quaternion
from jaxkin.io.xml_tree import MOST_BYTES, parse_xml

DOCUMENT = "Document.xml"
"""The file of the archive that lists the objects."""

MAX_DOCUMENTS = 200
"""Documents that link to each other."""

MAX_LINKS = 20
"""Links that lead to each other."""

LINKS = ("App::Link", "App::LinkElement", "Assembly::AssemblyLink")
"""Types of objects that stand for another one."""


class Reference(NamedTuple):
    """What a property refers to."""

    file: str
    """Of another document; empty for the same one."""
    name: str
    """Of an object; empty where nothing is referred to."""
    sub: str
    """Objects below it and an element of their shape, with dots between: "Body.Pad.Face6"."""


@dataclass(frozen=True, eq=False)
class Item:
    """An object of a document."""

    name: str
    type: str
    document: Document
    properties: Mapping[str, Element]

    @cached_property
    def label(self) -> str:
        """What FreeCAD shows as its name."""
        return self._value("Label", "String") or self.name

    def __str__(self) -> str:
        """Tell the object, for messages."""
        own = "" if self.label == self.name else f" ({self.name})"
        return f"{self.document.path.name}: {self.type} {self.label!r}{own}"

    def __contains__(self, key: str) -> bool:
        return key in self.properties

    def _value(self, key: str, tag: str) -> str:
        found = self.properties[key].find(tag) if key in self.properties else None
        return "" if found is None else found.get("value", "")

    def number(self, key: str) -> float:
        """Read a number, degrees or mm; zero where there is none."""
        return float(numbers(self._value(key, "Float") or "0", 1, f"{self}: {key}")[0])

    def flag(self, key: str, default: bool = False) -> bool:
        """Read a yes or no."""
        return (self._value(key, "Bool") or str(default)).lower() == "true"

    def choice(self, key: str, names: tuple[str, ...]) -> str:
        """Read the name of a choice, by the list that the document has, or else by `names`."""
        own = [each.get("value", "") for each in self.properties[key].iterfind("CustomEnumList/Enum")]
        number, known = self._value(key, "Integer"), own or names
        if not number.isdecimal() or int(number) >= len(known):
            raise ValueError(f"{self}: {key} is number {number!r} of {', '.join(known)}")
        return known[int(number)]

    def group(self) -> list[str]:
        """List the names of the objects inside."""
        found = self.properties.get("Group")
        return [] if found is None else [each.get("value", "") for each in found.iterfind("LinkList/Link")]

    def refers(self, key: str) -> Reference:
        """Read what a property refers to."""
        found = self.properties.get(key)
        link = None if found is None else next(iter(found), None)
        if link is None:
            return Reference("", "", "")
        sub = link.find("Sub")
        inner = link.get("shadowed") or link.get("sub", "")
        inner = inner if sub is None else sub.get("shadowed") or sub.get("value", "")
        # names of elements that follow edits begin with a semicolon, and may hold dots
        return Reference(link.get("file", ""), link.get("name") or link.get("value", ""), inner.partition(";")[0])

    def place(self, key: str) -> Transform | None:
        """Read a placement; None where there is none."""
        found = self.properties[key].find("PropertyPlacement") if key in self.properties else None
        if found is None:
            return None
        keys = ("Px", "Py", "Pz", "Q3", "Q0", "Q1", "Q2")
        given = numbers(" ".join(found.get(each, "") for each in keys), 7, f"{self}: {key}")
        return placed(quaternion(given[3:], f"{self}: {key}"), given[:3])

    def pose(self, depth: int = 0) -> Transform:
        """Read its pose in what it is in. A link has one of its own, and that of its target where it keeps it, too."""
        own = self.place("LinkPlacement") if self.type in LINKS else None
        own = self.place("Placement") if own is None else own
        own = np.eye(4) if own is None else own
        if self.type in LINKS and self.flag("LinkTransform"):
            return own @ self.target(depth).pose(depth + 1)
        return own

    def target(self, depth: int = 0) -> Item:
        """Find the object that a link leads to; the object itself where it is none."""
        to = self.refers("LinkedObject") if self.type in LINKS else Reference("", "", "")
        if not to.name:
            return self
        if depth >= MAX_LINKS:
            raise ValueError(f"{self}: links lead to each other, {MAX_LINKS} deep or in a circle")
        document = self.document.other(to.file, str(self)) if to.file else self.document
        if to.name not in document.items:
            raise ValueError(f"{self}: it links to {to.name!r}, which is not in {document.path.name}")
        return document.items[to.name].target(depth + 1)


@dataclass(frozen=True, eq=False)
class Document:
    """The objects of a document, by name."""

    path: Path
    items: dict[str, Item]
    known: dict[Path, Document] = field(repr=False)
    """Documents that were read, by path."""

    @staticmethod
    def read(path: Path, known: dict[Path, Document] | None = None) -> Document:
        """Read a document; ValueError, in one line, for what is none."""
        check_file(path, "document of FreeCAD")
        made = Document(path, {}, {} if known is None else known)
        made.known[path.resolve()] = made
        root = parse_xml(_document_xml(path), f"{path.name}: {DOCUMENT}")
        types = {each.get("name", ""): each.get("type", "") for each in root.iterfind("Objects/Object")}
        for each in root.iterfind("ObjectData/Object"):
            name = each.get("name", "")
            own = {found.get("name", ""): found for found in each.iterfind("Properties/Property")}
            made.items[name] = Item(name, types.get(name, ""), made, own)
        return made

    def other(self, file: str, where: str) -> Document:
        """Read a document that this one links to: by its path from here, or beside it."""
        shorter = file.replace("\\", "/").rpartition("/")[2]
        folder = self.path.resolve().parent
        tries = [folder / each for each in (file, shorter) if not Path(each).is_absolute()]
        found = next((each.resolve() for each in tries if each.is_file()), None)
        if found is None:
            raise FileNotFoundError(f"{where}: it links to {file!r}, which is not there; put it beside {self.path}")
        if found not in self.known and len(self.known) >= MAX_DOCUMENTS:
            raise ValueError(f"{where}: its links lead to more than {MAX_DOCUMENTS} documents")
        return self.known[found] if found in self.known else Document.read(found, self.known)

    @cached_property
    def inside(self) -> dict[str, Item]:
        """Map names of objects to the object that they are in."""
        return {name: each for each in self.items.values() for name in each.group()}


def _document_xml(path: Path) -> bytes:
    """Unpack the list of objects, as far as its bound."""
    try:
        with ZipFile(path) as archive:
            if DOCUMENT not in archive.namelist():
                raise ValueError(f"{path.name}: there is no {DOCUMENT} in it: it is no document of FreeCAD")
            with archive.open(DOCUMENT) as file:
                data = file.read(MOST_BYTES + 1)
    except (BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise ValueError(f"{path.name}: expected a document of FreeCAD, a zip archive: {error}") from None
    if len(data) > MOST_BYTES:
        raise ValueError(f"{path.name}: {DOCUMENT} is longer than {MOST_BYTES} bytes, which is all that is read")
    return data
