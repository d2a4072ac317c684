"""Models of other SDF files in the place of each <include>, nested, or merged into the model around it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from jaxkin.io.robot_model import tag
from jaxkin.io.sdf_frames import MODEL, SdfFrames, is_true, read_pose, relative_to, seven_numbers
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
    found = next((_in_folder(t) if t.is_dir() else t for t in tries if t.exists()), None)
    if found is None or not found.is_file():
        raise FileNotFoundError(f"{file}: it includes {uri!r}, which is not there; put it beside {file}")
    return found, uri


def _in_folder(folder: Path) -> Path:
    """Find the file of a model in its folder: of those that its model.config names the one of the newest version."""
    usual, config = folder / "model.sdf", folder / "model.config"
    if usual.is_file() or not config.is_file():
        return usual
    named = [
        (_version(each.get("version", "")), each.text.strip()) for each in read_xml(config).iter("sdf") if each.text
    ]
    return folder / max(named)[1] if named else usual


def _version(text: str) -> list[int]:
    return [int(part) for part in text.split(".")[:2] if part.isdigit()]


def axis_in_model(axis: Element, version: str) -> bool:
    """Tell whether an axis is in the frame of its model, as it is in files before 1.5, and not in that of its joint."""
    return _version(version) < [1, 5] or is_true(axis.findtext("use_parent_model_frame"))


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
    frames = SdfFrames.of(file, model)
    on = frames.canonical()
    if not on:
        raise ValueError(f"{file}: it merges the model {model.get('name')!r}, in which there is no <link>")
    # its own pose is given in the model around it, whose frame has the name that its own has inside
    own = Element("frame", {"name": name, "attached_to": on})
    pose = SubElement(own, "pose", {"relative_to": relative_to(model, MODEL), "rotation_format": "quat_xyzw"})
    pose.text = seven_numbers(read_pose(model, f"{file}: {tag(model)}") @ frames.placement())
    inside = [each for each in model if each.tag not in ("pose", "static", "self_collide", "enable_wind")]
    for each in inside:
        if each.tag in PLACED:
            written = each.find("pose")
            written = SubElement(each, "pose") if written is None else written
            if not written.get("relative_to") and not (each.tag == "frame" and each.get("attached_to")):
                written.set("relative_to", name)
            if each.tag == "frame" and not each.get("attached_to"):
                each.set("attached_to", on)
    for each in _of_model(inside):
        for key in ("relative_to", "attached_to", "expressed_in"):
            if each.get(key) == MODEL:
                each.set(key, name)
        if each.tag in ("parent", "child") and (each.text or "").strip() == MODEL:
            each.text = name
    return [own, *inside]


def _of_model(elements: Iterable[Element]) -> Iterator[Element]:
    """Yield what is inside a model, but for what is inside the models in it, whose own frame has the same name; the
    poses of these are given in the frames of the model."""
    for each in elements:
        yield each
        yield from each.iterfind("pose") if each.tag == "model" else _of_model(each)
