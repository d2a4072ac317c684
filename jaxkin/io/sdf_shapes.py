"""The solids of links of SDF."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.geometry.pose import inverse
from jaxkin.io.robot_model import LinkShape, numbers, tag
from jaxkin.io.sdf_frames import SdfFrames, read_pose, relative_to


def shapes_of(link: Element, what: str, frames: SdfFrames, notes: list[str]) -> tuple[LinkShape, ...]:
    """Read the solids of the elements `what` of a link: "visual" or "collision". What is no known solid is noted.

    They are given in the frame of the link, or in another one of the `frames` of its model.
    """
    file, name, found = frames.file, link.get("name", ""), []
    for each in link.iterfind(what):
        pose = read_pose(each, f"{file}: {tag(link)}")
        if (base := relative_to(each, name)) != name:
            pose = inverse(frames.in_model(name)) @ frames.in_model(base) @ pose
        where = f"{file}: {tag(link)}: {tag(each)}"
        for solid in each.iterfind("geometry/*"):
            sizes = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"),
                     "capsule": ("radius", "length"), "ellipsoid": ("radii",)}  # fmt: skip
            if solid.tag == "mesh":
                scale = tuple(numbers(solid.findtext("scale"), 3, where, (1, 1, 1)))
                found.append(LinkShape(pose, "mesh", scale, (solid.findtext("uri") or "").strip()))
            elif solid.tag in sizes:
                size = [numbers(solid.findtext(key), 3 if key in ("size", "radii") else 1, where)
                        for key in sizes[solid.tag]]  # fmt: skip
                kind = "sphere" if solid.tag == "ellipsoid" else solid.tag
                found.append(LinkShape(pose, kind, tuple(np.concatenate(size).tolist())))
            elif solid.tag not in ("plane", "empty"):
                notes.append(f"{where}: {tag(solid)} is no solid that is known; left out")
    return tuple(found)
