"""Reads the parts of 3MF files (core specification 1.3, production extension 1.2); the program of `mesh_worker.py`.

It imports nothing of jaxkin. Objects may be in several model files of the archive, each with identifiers of its own.
"""

import xml.etree.ElementTree as ElementTree
import zipfile
from collections import Counter
from typing import Any, NamedTuple

import numpy as np

ROOT = "3d/3dmodel.model"
"""Where, in any case of letters, the model is whose build says what is made."""

DEEPEST = 100
"""Objects that hold each other: more of them go round in a circle."""

PART = "model"
"""The type of objects that are what is made; others are supports, surfaces, and what is never made."""


class Refused(Exception):
    """What is no model, or too much of one."""


class Place(NamedTuple):
    """An object that another one, or the build, has at a place."""

    at: tuple[str, str]
    """Its model file, and its identifier there."""
    pose: np.ndarray
    """(4, 4)"""


class Object(NamedTuple):
    """What a model file says of an object: its triangles, or where others are in it."""

    name: str
    kind: str
    corners: np.ndarray
    """(triangles, 3, 3)"""
    components: list[Place]


def read_3mf(file, most: int, parts: int) -> tuple[list[dict], list[str]]:
    """Read the nodes of a file, those of one object in several places as often, and say what was left out and why.

    A node has its name, that of its object or of the nearest object around it with a name, no colour, its corners
    (triangles, 3, 3), and their pose in the world (4, 4). Raises Refused for more than `most` triangles or `parts`
    nodes, for objects inside themselves, and for what is no model.
    """
    with zipfile.ZipFile(file) as archive:
        files = {name.lower(): name for name in archive.namelist()}
        root = next(name for name in files if ROOT in name)
        models: dict[str, tuple[dict[str, Object], list[Place]]] = {}

        def model(path: str) -> tuple[dict[str, Object], list[Place]]:
            if path not in models:
                with archive.open(files[path]) as opened:
                    models[path] = _model(opened, path, most)
            return models[path]

        nodes, left_out, total = [], Counter(), 0
        todo = [("", 0, place) for place in model(root)[1]][::-1]
        if not todo:
            raise Refused("its build has no items, and places none of its objects")
        while todo:
            above, depth, (at, pose) = todo.pop()
            if depth > DEEPEST:
                raise RecursionError
            found = model(at[0])[0].get(at[1]) if at[0] in files else None
            if found is None:
                left_out[f"the object {at[1]!r} (it is not in the file)"] += 1
                continue
            name = found.name or above
            inside = [(name, depth + 1, Place(each.at, pose @ each.pose)) for each in found.components]
            todo += inside[::-1]
            if len(nodes) + len(todo) > parts:
                raise Refused(f"it holds more than {parts} parts")
            if inside:
                continue  # the type of what holds others is ignored
            if found.kind != PART:
                left_out[f"the object {name or at[1]!r} (of the type {found.kind!r})"] += 1
            elif not len(found.corners):
                left_out[f"the object {name or at[1]!r} (without triangles)"] += 1
            else:
                total += len(found.corners)
                if total > most:
                    raise Refused(f"it holds more than {most} triangles")
                nodes.append({"name": name, "color": None, "corners": found.corners, "pose": pose})
    return nodes, [f"{what} ({times} times)" if times > 1 else what for what, times in left_out.items()]


def _model(file, path: str, most: int) -> tuple[dict[str, Object], list[Place]]:
    """Read a model file: its objects by their identifiers, and the items of its build."""
    objects: dict[str, Object] = {}
    items: list[Place] = []
    corners: list[list[str]] = []
    triangles: list[list[str]] = []
    components: list[Place] = []
    space = None
    for event, element in ElementTree.iterparse(file, ("start", "end")):
        own, _, kind = element.tag.rpartition("}")
        space = own if space is None else space
        if event == "start" or own != space:
            continue  # extensions have corners and objects of their own
        said = element.attrib
        if kind == "vertex":
            corners.append([said["x"], said["y"], said["z"]])
        elif kind == "triangle":
            triangles.append([said["v1"], said["v2"], said["v3"]])
            if len(triangles) > most:
                raise Refused(f"it holds more than {most} triangles")
        elif kind == "component":
            components.append(_place(said, path))
        elif kind == "item":
            items.append(_place(said, path))
        elif kind == "object":
            if said["id"] in objects:
                raise Refused(f"two of its objects have the identifier {said['id']!r}")
            made = _corners(corners, triangles)
            objects[said["id"]] = Object(said.get("name", ""), said.get("type", PART), made, components)
            corners, triangles, components = [], [], []
        else:
            continue
        element.clear()
    return objects, items


def _place(said: dict[str, Any], path: str) -> Place:
    """Read where an object is put; `path` is the model file in which that is said."""
    elsewhere = next((text for key, text in said.items() if key.rpartition("}")[2] == "path"), None)
    pose = np.eye(4)
    if "transform" in said:
        numbers = _numbers(said["transform"].split(), "transform")
        if len(numbers) != 12:
            raise Refused(f"a transform of it has {len(numbers)} numbers in place of 12")
        pose[:3] = numbers.reshape(4, 3).T  # rows of the format are columns here
    return Place((path if elsewhere is None else elsewhere.strip("/").lower(), said["objectid"]), pose)


def _corners(corners: list[list[str]], triangles: list[list[str]]) -> np.ndarray:
    """Make triangles (n, 3, 3) of the numbers of corners and the corners of triangles, as they are written."""
    points = _numbers([number for corner in corners for number in corner], "corner").reshape(-1, 3)
    rows = np.array([[int(number) for number in each] for each in triangles], int).reshape(-1, 3)
    if len(rows) and (rows.min() < 0 or rows.max() >= len(points)):
        raise Refused("its triangles name corners that are not there")
    return points[rows]


def _numbers(texts: list[str], what: str) -> np.ndarray:
    """Read numbers; Refused, with the first that is none."""
    try:
        return np.array([float(text) for text in texts])
    except ValueError:
        bad = next(text for text in texts if not _is_number(text))
        comma = "; numbers have decimal points, and no commas" if "," in bad else ""
        raise Refused(f"a {what} of it has {bad[:40]!r} where a number is expected{comma}") from None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
