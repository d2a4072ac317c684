"""Models of other SDF files in the place of each <include>, nested, or merged into the model around it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from jaxkin.io.sdf_frames import MODEL, is_true
from jaxkin.io.xml_tree import read_xml

MAX_INCLUDED = 20
"""Files that include each other, one in the other."""

PLACED = ("link", "frame", "model")
"""Elements of a model whose poses count from its frame where they do not say another one."""


def included(element: Element, folder: Path, file: str, depth: int = 0) -> None:
    """Put the models of other files in the place of each <include>, those that they include too.

    Files are named relative to `folder`. Raises FileNotFoundError where one is not there, and ValueError for includes
    in a circle, and for a file without a model.
    """
    for each in list(element):
        if each.tag == "model":
            included(each, folder, file, depth)
        if each.tag != "include":
            continue
        found, uri = _found(each, folder, file)
        if depth >= MAX_INCLUDED:
            raise ValueError(f"{file}: its includes go {MAX_INCLUDED} deep, or in a circle")
        root = read_xml(found)
        model = root.find("model")
        if model is None:
            raise ValueError(f"{file}: it includes {uri!r}, in which there is no <model>")
        for joint in model.iter("joint"):
            _axes_in_frames(joint, root.get("version", ""))
        _overridden(model, each)
        included(model, found.parent, file, depth + 1)
        merged = is_true(each.get("merge"))
        if merged and element.tag != "model":
            raise ValueError(f"{file}: it merges {uri!r} into what is no <model>; include it without merge")
        number = list(element).index(each)
        element[number : number + 1] = _merged(model, file) if merged else [model]


def _found(include: Element, folder: Path, file: str) -> tuple[Path, str]:
    """Find the file of an include, and what the include calls it."""
    uri = (include.findtext("uri") or "").strip()
    name = uri.removeprefix("model://").removeprefix("file://")
    tries = [base / name for base in (folder, folder.parent, folder.parent.parent)]
    found = next((t / "model.sdf" if t.is_dir() else t for t in tries if t.exists()), None)
    if found is None or not found.is_file():
        raise FileNotFoundError(f"{file}: it includes {uri!r}, which is not there; put it beside {file}")
    return found, uri


def axis_in_model(axis: Element, version: str) -> bool:
    """Tell whether an axis is in the frame of its model, as it is in files before 1.5, and not in that of its joint."""
    old = [int(part) for part in version.split(".")[:2] if part.isdigit()] < [1, 5]
    return old or is_true(axis.findtext("use_parent_model_frame"))


def _axes_in_frames(joint: Element, version: str) -> None:
    """Write into the axes of a joint the frames that they are in: what else says so is the version of their file."""
    for axis in (*joint.iterfind("axis"), *joint.iterfind("axis2")):
        xyz = axis.find("xyz")
        if xyz is not None and not xyz.get("expressed_in"):
            xyz.set("expressed_in", MODEL if axis_in_model(axis, version) else joint.get("name", ""))


def _overridden(model: Element, include: Element) -> None:
    """Give a model the name, the place and the rest of its include."""
    for key in ("name", "placement_frame"):
        if said := (include.findtext(key) or "").strip():
            model.set(key, said)
    for key in ("pose", "static"):
        if (said := include.find(key)) is not None:
            for old in model.findall(key):
                model.remove(old)
            model.append(said)


def _merged(model: Element, file: str) -> list[Element]:
    """List the elements of a model, with a frame in the place of its own, which they count from."""
    name = f"_merged__{model.get('name', '')}__model__"
    first = model.find("link")
    on = model.get("canonical_link") or ("" if first is None else first.get("name", ""))
    if not on:
        raise ValueError(f"{file}: it merges the model {model.get('name')!r}, in which there is no <link>")
    for each in model:
        if each.tag in PLACED:
            pose = each.find("pose")
            pose = SubElement(each, "pose") if pose is None else pose
            if not pose.get("relative_to") and not (each.tag == "frame" and each.get("attached_to")):
                pose.set("relative_to", name)
            if each.tag == "frame" and not each.get("attached_to"):
                each.set("attached_to", on)
    for each in _of_model(model):
        for key in ("relative_to", "attached_to", "expressed_in"):
            if each.get(key) == MODEL:
                each.set(key, name)
        if each.tag in ("parent", "child") and (each.text or "").strip() == MODEL:
            each.text = name
    if said := model.get("placement_frame"):
        raise ValueError(
            f"{file}: it merges the model {model.get('name')!r} placed by its frame {said!r}; include it without merge"
        )
    own = Element("frame", {"name": name, "attached_to": on})
    pose = model.find("pose")
    place = SubElement(own, "pose") if pose is None else pose
    if pose is not None:
        own.append(pose)
    if not place.get("relative_to"):
        place.set("relative_to", MODEL)
    return [own, *(each for each in model if each.tag not in ("pose", "static", "self_collide", "enable_wind"))]


def _of_model(element: Element) -> Iterator[Element]:
    """Yield what is inside a model, but for what is inside the models in it, whose own frame has the same name."""
    for each in element:
        yield each
        if each.tag != "model":
            yield from _of_model(each)
