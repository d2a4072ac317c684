"""Models of MuJoCo inside of others: the body that an <attach> names, or all bodies, of a <model> among the assets.

A model that is attached has its own compiler settings and default classes. Its elements are therefore written out, with
what their classes give them and with angles in the unit of the model around it, before their names get the prefix.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import nearest
from jaxkin.io.mjcf_keyframe import keys_into_joints
from jaxkin.io.mjcf_text import MAX_COPIED, WRITTEN_OUT, Compiler, Defaults, included, replicated
from jaxkin.io.robot_model import WORLD, numbers, tag
from jaxkin.io.xml_tree import MOST_DEEP, read_xml

MAX_DEEP = 20
"""Models attached to each other, one in the other."""

TURNED = ("body", "frame", "geom", "site", "inertial")
"""Elements inside of bodies that are turned."""

TURNS = ("euler", "axisangle", "xyaxes", "zaxis", "quat")
"""Attributes that turn an element."""

NAMED = {
    "body": ("body", "body1", "body2"),
    "joint": ("joint", "joint1", "joint2", "jointinparent"),
    "site": ("site", "site1", "site2", "refsite", "cranksite", "slidersite", "sidesite"),
    "geom": ("geom", "geom1", "geom2"),
    "tendon": ("tendon", "tendon1", "tendon2"),
}
"""What elements of a model refer to -> the attributes that name it."""

SECTIONS = ("tendon", "equality", "actuator")
"""Elements of a model beside its bodies that come with them, where all that they refer to comes, too; in this order,
since the later ones refer to tendons."""


def attached(root: Element, path: Path, compiler: Compiler, depth: int = 0) -> list[str]:
    """Put attached models in the place of each <attach>, and give notes on what of them is not kept.

    `root` is a model without includes, and `compiler` holds its settings. Raises FileNotFoundError for a model that is
    not there, and ValueError for one without a body or a prefix that an <attach> names, or attached in a circle.
    """
    if depth > MAX_DEEP:
        raise ValueError(f"{path.name}: models are attached to each other more than {MAX_DEEP} deep, or in a circle")
    files = {}
    for each in root.iterfind("asset/model"):
        file = path.parent / each.get("file", "")
        files[each.get("name") or _model_name(file, path)] = file
    models: dict[Path, _Model] = {}
    notes: list[str] = []
    count = 0
    for parent in list(root.iter()):
        for element in [each for each in parent if each.tag == "attach"]:
            where = f"{path.name}: {_called(element)}"
            name, prefix = element.get("model", ""), element.get("prefix")
            if name not in files:
                raise ValueError(f"{where}: there is no <model> {name!r} among the assets{nearest(name, files)}")
            if prefix is None:
                raise ValueError(f"{where}: expected a prefix for the names in it")
            if (file := files[name]) not in models:
                models[file] = _Model(file, path, compiler, depth)
                notes += models[file].notes
            frame, sections = models[file].copied(element.get("body"), prefix, where)
            if (count := count + sum(1 for top in (frame, *sections) for _ in top.iter())) > MAX_COPIED:
                raise ValueError(f"{path.name}: the models that it attaches have more than {MAX_COPIED} elements")
            parent[list(parent).index(element)] = frame
            root.extend(sections)
    level, below = [root], 0
    while level:
        level, below = [inner for each in level for inner in each], below + 1
    if below > MOST_DEEP:
        raise ValueError(f"{path.name}: with the models that it attaches, its elements are nested {below} deep")
    return notes


def _called(element: Element) -> str:
    return f"<attach model={element.get('model', '')!r} body={element.get('body', '')!r}>"


def _there(file: Path, path: Path) -> Element:
    if not file.is_file():
        raise FileNotFoundError(f"{path.name}: it attaches {file.name!r}, which is not there: {file}")
    return read_xml(file)


def _model_name(file: Path, path: Path) -> str:
    """Read what a model calls itself."""
    return _there(file, path).get("model", "MuJoCo Model")


class _Model:
    """One model to attach, its elements written out."""

    def __init__(self, file: Path, path: Path, outer: Compiler, depth: int) -> None:
        root = included(_there(file, path), file)
        self.compiler, self.outer = Compiler(root, file.name), outer
        self.notes = attached(root, file, self.compiler, depth + 1)
        replicated(root, self.compiler)
        self.root, self.defaults = root, Defaults(root, file.name)
        for world in root.iterfind("worldbody"):
            self._written_out(world, None)
        keys_into_joints(root)
        for section in SECTIONS:
            for each in root.iterfind(f"{section}/*"):
                self._said(each, None, "equality" if section == "equality" else None)
        self._meshes(posixpath.relpath(file.parent.resolve().as_posix(), path.parent.resolve().as_posix()))

    def _said(self, each: Element, child_class: str | None, key: str | None = None) -> None:
        """Give an element what its class says, and no class of the model around."""
        each.attrib = {**self.defaults.said(each, child_class, key), "class": WRITTEN_OUT}

    def _meshes(self, folder: str) -> None:
        """Write out names and files of meshes; `folder` is where the model lies from the one around it."""
        for each in self.root.iterfind("asset/mesh"):
            self._said(each, None)
            if file := each.get("file", "").replace("\\", "/"):
                each.set("name", each.get("name", posixpath.splitext(posixpath.basename(file))[0]))
                each.set("file", posixpath.basename(file) if self.compiler.strip else file)
                each.set("folder", posixpath.join(folder, each.get("folder", self.compiler.folder)))

    def _written_out(self, element: Element, child_class: str | None) -> None:
        """Give the elements inside a body what their classes say, without a class, angles in the outer unit."""
        if self.compiler.said.get("inertiafromgeom") == "true":
            for each in element.findall("inertial"):
                element.remove(each)
        for each in element:
            where = f"{self.compiler.file}: {tag(each)}"
            inner = each.get("childclass", child_class)
            if each.tag in ("body", "frame"):
                self._written_out(each, inner)
                each.attrib.pop("childclass", None)
            else:
                self._said(each, child_class)
            if each.tag in TURNED and any(key in each.attrib for key in TURNS):
                turn = self.compiler.turn(each.attrib, where)
                for key in TURNS:
                    each.attrib.pop(key, None)
                each.set("xyaxes", " ".join(map(repr, turn[:, :2].T.ravel().tolist())))
            if each.tag == "joint":
                self._joint(each, where)

    def _joint(self, each: Element, where: str) -> None:
        """Write the range and the value of a joint in the outer unit, and whether it is limited."""
        unit = self.compiler.radians / self.outer.radians if each.get("type", "hinge") != "slide" else 1.0
        for key, size in (("range", 2), ("ref", 1)):
            if key in each.attrib:
                values = numbers(each.get(key), size, where) * unit
                each.set(key, " ".join(map(repr, np.asarray(values).tolist())))
        if each.get("limited", "auto") == "auto" and "range" in each.attrib:
            each.set("limited", "true" if self.compiler.auto_limits else "false")

    def copied(self, body: str | None, prefix: str, where: str) -> tuple[Element, list[Element]]:
        """Copy a body, or all, into a frame, and what comes with it, with the prefix before all names."""
        frame = Element("frame")
        if body is None:
            frame.extend(deepcopy(each) for world in self.root.iterfind("worldbody") for each in world)
        else:
            known = {each.get("name", ""): each for each in self.root.iterfind("worldbody//body")}
            if body not in known:
                raise ValueError(f"{where}: there is no body {body!r} in {self.compiler.file}{nearest(body, known)}")
            frame.append(deepcopy(known[body]))
        names = {kind: {each.get("name", "") for each in frame.iter(kind)} for kind in NAMED}
        names["body"].add(WORLD)
        sections = []
        for section in SECTIONS:
            made = Element(section)
            for each in self.root.iterfind(f"{section}/*"):
                if all(name in names[kind] for inner in each.iter() for kind, name in _referred(inner.attrib)):
                    made.append(deepcopy(each))
                    names["tendon"] |= {each.get("name", "")} if section == "tendon" else set()
            sections.append(made)
        meshes = Element("asset")
        meshes.extend(deepcopy(each) for each in self.root.iterfind("asset/mesh"))
        for top in (frame, meshes, *sections):
            for each in top.iter():
                if each is not top:
                    _prefix(each, prefix)
        return frame, [meshes, *sections]


def _referred(attributes: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield what an element refers to: its kind, and its name."""
    for kind, keys in NAMED.items():
        yield from ((kind, attributes[key]) for key in keys if key in attributes)


def _prefix(element: Element, prefix: str) -> None:
    for key in ("name", "mesh", *(key for keys in NAMED.values() for key in keys)):
        if key in element.attrib and not (key in NAMED["body"] and element.get(key) == WORLD):
            element.set(key, prefix + element.get(key, ""))
