"""The frames of an SDF model, or of a world: where what is in it is, and on which link each frame is."""

from __future__ import annotations

from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import nearest
from jaxkin.geometry.pose import Transform
from jaxkin.io.robot_model import WORLD, numbers, placed, quaternion, roll_pitch_yaw, tag

MODEL = "__model__"
"""What a file calls the frame of the model itself."""

IN_ANOTHER = "::"
"""Between the name of a model and that of something in it."""


class SdfFrame(NamedTuple):
    """A frame as it is written."""

    element: Element | None
    pose: Transform
    """In the frame that it is relative to."""
    relative_to: str
    attached_to: str
    """The link or frame that it moves with; a link is attached to itself."""


def is_true(text: str | None) -> bool:
    """Read a boolean as SDF has it: 1, or true in letters of any case; what is not written is false."""
    return (text or "").strip().lower() in ("1", "true")


def read_pose(element: Element | None, where: str) -> Transform:
    """Read the <pose> of an element, metres; the identity where there is none, or an empty one."""
    found = None if element is None else element.find("pose")
    if found is None or not (found.text or "").strip():
        return np.eye(4)
    if found.get("rotation_format") == "quat_xyzw":
        x, y, z, *turn = numbers(found.text, 7, f"{where}: pose")
        return placed(quaternion([turn[3], *turn[:3]], where), (x, y, z))
    x, y, z, *angles = numbers(found.text, 6, f"{where}: pose")
    unit = np.pi / 180 if is_true(found.get("degrees")) else 1.0
    return placed(roll_pitch_yaw(unit * np.array(angles)), (x, y, z))


def seven_numbers(pose: Transform) -> str:
    """Write a pose as its place and its quaternion, x y z w: the `rotation_format` quat_xyzw."""
    from scipy.spatial.transform import Rotation

    return " ".join(map(repr, [*pose[:3, 3].tolist(), *Rotation.from_matrix(pose[:3, :3]).as_quat().tolist()]))


def relative_to(element: Element, default: str) -> str:
    """Find the frame that the <pose> of an element is given in."""
    found = element.find("pose")
    return (None if found is None else found.get("relative_to") or found.get("frame")) or default


class SdfFrames:
    """The frames of one model, by their names in it; those of models in it have its name before theirs."""

    def __init__(self, file: str, model: Element, inner: dict[str, SdfFrames]) -> None:
        """Take the links, joints and frames of a model; `inner` are the frames of the models in it."""
        self.file, self.model, self.inner = file, model, inner
        self.known: dict[str, SdfFrame] = {}
        for each in model:
            name = each.get("name", "")
            if each.tag not in ("link", "joint", "frame", "model"):
                continue
            if name in self.known:
                raise ValueError(f"{file}: {tag(model)} has two elements of the name {name!r}")
            pose = read_pose(each, f"{file}: {tag(each)}")
            base, on = MODEL, name
            if each.tag == "joint":
                base = on = (each.findtext("child") or "").strip()
            elif each.tag == "frame":
                base = on = each.get("attached_to") or MODEL
            elif each.tag == "model":
                on = f"{name}{IN_ANOTHER}{inner[name].canonical()}"
            self.known[name] = SdfFrame(each, pose, relative_to(each, base), on)
        first = model.find("link")
        self.links = tuple(each.get("name", "") for each in model.iterfind("link"))
        self.first = "" if first is None else first.get("name", "")

    @classmethod
    def of(cls, file: str, model: Element) -> SdfFrames:
        """Make the frames of a model, and of those in it."""
        return cls(file, model, {each.get("name", ""): cls.of(file, each) for each in model.iterfind("model")})

    def canonical(self) -> str:
        """Name of the link that the frame of the model is on."""
        said = self.model.get("canonical_link") or self.first
        if said:
            return said
        inner = next(iter(self.inner), None)
        return "" if inner is None else f"{inner}{IN_ANOTHER}{self.inner[inner].canonical()}"

    def in_model(self, name: str, seen: tuple[str, ...] = ()) -> Transform:
        """Compute the pose of a frame in that of the model; ValueError for unknown names, and for frames in a
        circle."""
        if name in (MODEL, "") or (name == WORLD and self.model.tag != "model"):
            return np.eye(4)
        if name in seen:
            raise ValueError(f"{self.file}: the frame {name!r} of {tag(self.model)} is relative to itself")
        if name in self.known:
            frame = self.known[name]
            if frame.element is not None and frame.element.tag == "model":
                return self.in_model(frame.relative_to, (*seen, name)) @ frame.pose @ self.inner[name].placement()
            return self.in_model(frame.relative_to, (*seen, name)) @ frame.pose
        outer, _, rest = name.partition(IN_ANOTHER)
        if rest and outer in self.inner:
            return self.in_model(outer, seen) @ self.inner[outer].in_model(rest)
        raise self.unknown(name)

    def placement(self) -> Transform:
        """Compute the pose from the frame of the model to the frame that its pose places."""
        name = self.model.get("placement_frame")
        return np.linalg.inv(self.in_model(name)) if name else np.eye(4)

    def link_of(self, name: str, seen: tuple[str, ...] = ()) -> str:
        """Find the link that a frame moves with; "world" is its own."""
        if name == WORLD or name in self.links:
            return name
        if name == MODEL:
            return self.canonical()
        if name in seen:
            raise ValueError(f"{self.file}: the frame {name!r} of {tag(self.model)} is attached to itself")
        if name in self.known:
            return self.link_of(self.known[name].attached_to, (*seen, name))
        outer, _, rest = name.partition(IN_ANOTHER)
        if rest and outer in self.inner:
            return f"{outer}{IN_ANOTHER}{self.inner[outer].link_of(rest)}"
        raise self.unknown(name)

    def unknown(self, name: str) -> ValueError:
        return ValueError(f"{self.file}: {tag(self.model)} has no link or frame {name!r}{nearest(name, self.known)}")
