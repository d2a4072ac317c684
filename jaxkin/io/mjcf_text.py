"""The text of a MuJoCo model: files that it includes, its compiler settings, default classes and poses."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import nearest
from jaxkin.geometry.pose import Transform, rotation
from jaxkin.io.robot_model import along, direction, numbers, placed, quaternion, tag
from jaxkin.io.xml_tree import read_xml

MAX_INCLUDES = 1000
"""Files that one model includes: a scene with a hand has a dozen."""

MAX_COPIED = 100_000
"""Elements that all <replicate> of a model make together; a wall of bricks has thousands."""

MAIN = "main"
"""Name of the outermost default class where the file gives none."""

TURNS = ("quat", "axisangle", "euler", "xyaxes", "zaxis")
"""Attributes that give the orientation of an element, each in its way."""

PARTLY = ("size", "polycoef")
"""Lists of which an element may write the first numbers only: the others are those of its class."""

WRITTEN_OUT = "(written out)"
"""Class of elements that have all attributes themselves: those of attached models."""


def included(root: Element, path: Path) -> Element:
    """Put the elements of included files in the place of each <include>, those of the files that they include too.

    Files are named relative to the folder of `path`, the model. Raises FileNotFoundError where one is not there, and
    ValueError where one is included twice, as in a circle.
    """
    seen = {path.resolve()}
    todo = [root]
    while todo:
        element = todo.pop()
        position = 0
        while position < len(element):
            child = element[position]
            if child.tag != "include":
                todo.append(child)
                position += 1
                continue
            file = path.parent / child.get("file", "")
            if not file.is_file():
                raise FileNotFoundError(f"{path.name}: it includes {child.get('file')!r}, which is not there: {file}")
            if file.resolve() in seen or len(seen) > MAX_INCLUDES:
                raise ValueError(f"{path.name}: {child.get('file')!r} is included twice, or in a circle")
            seen.add(file.resolve())
            element[position : position + 1] = list(read_xml(file))  # what it includes itself is met next
    return root


def replicated(root: Element, compiler: Compiler) -> Element:
    """Put as many frames in the place of each <replicate> as it counts, each with a copy of what is inside.

    As MuJoCo has it, copy k is turned by k times the angles `euler`, and displaced by `offset`, along axes that turn
    along, from the one before; names in it end in `sep` and its number, those of an inner <replicate> first. Raises
    ValueError for a count that is no positive whole number, and for too many copies.
    """
    inside_out = [root]
    for element in inside_out:
        inside_out += element
    made = 0
    for element in reversed(inside_out):
        for position, each in reversed([*enumerate(element)]):
            if each.tag == "replicate":
                copies = _copies(each, compiler)
                made += sum(len([*copy.iter()]) for copy in copies)
                if made > MAX_COPIED:
                    raise ValueError(f"{compiler.file}: its <replicate> make more than {MAX_COPIED} elements")
                element[position : position + 1] = copies
    return root


def _copies(element: Element, compiler: Compiler) -> list[Element]:
    """Make the frames that take the place of one <replicate>."""
    where = f"{compiler.file}: <replicate>"
    count = element.get("count", "")
    if not count.isdigit() or not 0 < int(count) * len([*element.iter()]) <= MAX_COPIED:
        raise ValueError(f"{where}: expected a count of 1 or more, and at most {MAX_COPIED} elements, got {count!r}")
    angles = numbers(element.get("euler"), 3, where, (0, 0, 0)) * compiler.radians
    offset = numbers(element.get("offset"), 3, where, (0, 0, 0))
    place, copies = np.zeros(3), []
    for number in range(int(count)):
        turn = compiler.turned(number * angles)
        frame = Element("frame", pos=_written(place), xyaxes=_written(turn[:, :2].T))
        if said := element.get("childclass"):
            frame.set("childclass", said)
        frame.extend(deepcopy(each) for each in element)
        for each in frame.iter():
            if "name" in each.attrib:
                each.set("name", f"{each.get('name')}{element.get('sep', '')}{number:0{len(str(int(count) - 1))}d}")
        copies.append(frame)
        place = place + turn @ offset
    return copies


def _written(values: np.ndarray) -> str:
    return " ".join(map(repr, values.ravel().tolist()))


class Compiler:
    """The settings of all <compiler> elements together."""

    def __init__(self, root: Element, file: str) -> None:
        self.file = file
        self.said: dict[str, str] = {}
        for each in root.iterfind("compiler"):
            self.said |= each.attrib
        if self.said.get("coordinate", "local") != "local":
            raise ValueError(f"{file}: <compiler coordinate={self.said['coordinate']!r}>: only local is read")
        angle = self.said.get("angle", "degree")
        if angle not in ("degree", "radian"):
            raise ValueError(f"{file}: <compiler angle={angle!r}>: expected degree or radian")
        self.radians = np.pi / 180 if angle == "degree" else 1.0
        """Radians in one unit of angle of the file."""
        self.sequence = self.said.get("eulerseq", "xyz")
        if len(self.sequence) != 3 or not {*self.sequence.lower()} <= {*"xyz"}:
            raise ValueError(f"{file}: <compiler eulerseq={self.sequence!r}>: expected three of x, y, z, X, Y, Z")
        self.auto_limits = self.said.get("autolimits", "true") == "true"
        self.folder = self.said.get("meshdir", self.said.get("assetdir", ""))
        self.strip = self.said.get("strippath", "false") == "true"

    def pose(self, said: Mapping[str, str], where: str) -> Transform:
        """Read the place of an element from its attributes, metres: one between two points is in the middle of them,
        and its z axis points to the first."""
        if "fromto" in said:
            start, end = numbers(said["fromto"], 6, where).reshape(2, 3)
            return placed(along(direction(start - end, where)), (start + end) / 2)
        return placed(self.turn(said, where), numbers(said.get("pos"), 3, where, (0, 0, 0)))

    def turn(self, said: Mapping[str, str], where: str) -> np.ndarray:
        """Read the rotation matrix of an element from whichever attribute gives it; none is the identity."""
        if "quat" in said:
            return quaternion(numbers(said["quat"], 4, where), where)
        if "axisangle" in said:
            x, y, z, angle = numbers(said["axisangle"], 4, where)
            return rotation(direction(np.array([x, y, z]), where), angle * self.radians)
        if "euler" in said:
            return self.turned(numbers(said["euler"], 3, where) * self.radians)
        if "xyaxes" in said:
            x, y = numbers(said["xyaxes"], 6, where).reshape(2, 3)
            x = direction(x, where)
            y = direction(y - (y @ x) * x, where)
            return np.stack([x, y, np.cross(x, y)], axis=1)
        if "zaxis" in said:
            return along(direction(numbers(said["zaxis"], 3, where), where))
        return np.eye(3)

    def turned(self, angles: np.ndarray) -> np.ndarray:
        """Multiply three rotations: about axes that turn along for small letters, about fixed ones for capitals."""
        turn = np.eye(3)
        for letter, angle in zip(self.sequence, angles, strict=True):
            step = rotation(np.eye(3)["xyz".index(letter.lower())], angle)
            turn = turn @ step if letter.islower() else step @ turn
        return turn


class Defaults:
    """The default classes: what elements of a tag have where they do not say otherwise."""

    def __init__(self, root: Element, file: str) -> None:
        self.file = file
        self.main = MAIN
        self.classes: dict[str, dict[str, dict[str, str]]] = {}
        for number, each in enumerate(root.iterfind("default")):
            name = each.get("class", MAIN)
            self.main = name if number == 0 else self.main
            self._read(each, name, self.classes.get(name, {}))
        self.classes.setdefault(self.main, {})
        self.classes[WRITTEN_OUT] = {}

    def _read(self, element: Element, name: str, above: Mapping[str, dict[str, str]]) -> None:
        """Read a class and those in it; each has what the one around it has."""
        own = {key: dict(attributes) for key, attributes in above.items()}
        for each in element:
            if each.tag != "default":
                own[each.tag] = _over(own.get(each.tag, {}), each.attrib)
        self.classes[name] = own
        for each in element.iterfind("default"):
            if not (inner := each.get("class", "")):
                raise ValueError(f"{self.file}: a <default> in class {name!r} has no class of its own")
            self._read(each, inner, own)

    def said(self, element: Element, child_class: str | None = None, key: str | None = None) -> dict[str, str]:
        """Collect the attributes of an element with those of its class, by its tag or the `key` of its defaults.

        `child_class` is the class that the bodies around it give it. Raises ValueError for an unknown class.
        """
        name = element.get("class") or child_class or self.main
        if name not in self.classes:
            known = [each for each in self.classes if each != WRITTEN_OUT]
            raise ValueError(f"{self.file}: {tag(element)}: unknown class {name!r}{nearest(name, known)}")
        return _over(self.classes[name].get(key or element.tag, {}), element.attrib)


def _over(given: Mapping[str, str], said: Mapping[str, str]) -> dict[str, str]:
    """Put attributes over those of a class; an orientation in one way over one in another, and of lists that may be
    shorter those numbers that are written."""
    turned = any(key in said for key in TURNS)
    kept = {key: value for key, value in given.items() if not (turned and key in TURNS)}
    longer = {key: (said[key].split(), kept[key].split()) for key in PARTLY if key in said and key in kept}
    return kept | dict(said) | {key: " ".join(own + rest[len(own) :]) for key, (own, rest) in longer.items()}
