"""Assemblies of FreeCAD 1.0 and later, in its own documents: parts with their placements, joints between two of them.

A joint refers to an element of each part, and keeps a placement relative to the object that the element is of, with
its offset. FreeCAD gives both to its solver as markers, and so does the reader.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from jaxkin.geometry.pose import Transform, unit
from jaxkin.io.fcstd_document import Document, Item, Reference
from jaxkin.io.marker_joints import ANGLE, RIGHT_ANGLE, STRAIGHT, Marker, MarkerJoints
from jaxkin.io.marker_ties import GEAR, RACK, SCREW, SLIDES, TIES, MarkerTie, RigidGroups, add_tie
from jaxkin.io.names import unique
from jaxkin.io.robot_model import RobotLink, RobotModel, placed

ASSEMBLY, FLEXIBLE, JOINTS = "Assembly::AssemblyObject", "Assembly::AssemblyLink", "Assembly::JointGroup"

GROUPS = ("App::DocumentObjectGroup", "App::DocumentObjectGroupPython", "App::LinkGroup")
"""Types of objects that hold parts and are none."""

PARTS = ("App::Link", "App::LinkElement", "App::Part", "PartDesign::Body", "Part::", ASSEMBLY, FLEXIBLE)
"""Types, or beginnings of types, of the objects in an assembly that are parts."""

BODY = "PartDesign::Body"

DATUMS = ("PartDesign::Point", "PartDesign::Line", "PartDesign::Plane", "PartDesign::CoordinateSystem", "App::Point",
          "App::Line", "App::Plane", "App::LocalCoordinateSystem", "App::Origin", "Part::Datum",
          "Part::LocalCoordinateSystem", "Sketcher::SketchObject")  # fmt: skip
"""Beginnings of the types of objects in a body that placements are relative to; of features these are of the body."""

TYPES = ("Fixed", "Revolute", "Cylindrical", "Slider", "Ball", "Distance", "Parallel", "Perpendicular", "Angle",
         "RackPinion", "Screw", "Gears", "Belt")  # fmt: skip
"""Types of joints, in the order of FreeCAD's list."""

JOINT_OF = {
    "Fixed": "FixedJoint", "Revolute": "RevoluteJoint", "Cylindrical": "CylindricalJoint",
    "Slider": "TranslationalJoint", "Ball": "SphericalJoint", "Parallel": "ParallelAxesJoint",
    "Perpendicular": RIGHT_ANGLE, "Angle": ANGLE, "RackPinion": RACK, "Screw": SCREW, "Gears": GEAR,
    "Belt": GEAR,
}  # fmt: skip
"""Type of joint -> the joint of its solver."""

MOTIONS = {"Angular": "phi", "Linear": "z"}
"""Type of a motion -> the coordinate that it drives."""

LIMITED = {
    "Slider": (("z", "Length", 1.0),),
    "Revolute": (("phi", "Angle", np.pi / 180.0),),
    "Cylindrical": (("z", "Length", 1.0), ("phi", "Angle", np.pi / 180.0)),
}
"""Type of joint -> coordinates with limits, the name of these, and their unit."""


def read_fcstd(path: Path) -> RobotModel:
    """Read the assemblies of a document; ValueError, in one line, for what is none or not understood.

    Raises FileNotFoundError where a joint needs an object of another document that is not there.
    """
    return _Reader(Document.read(path)).model()


class _Reader:
    """The parts and joints of a document."""

    def __init__(self, document: Document) -> None:
        self.document, self.file = document, document.path.name
        self.made = MarkerJoints(self.file, {})
        tops = [each for each in document.items.values() if each.type == ASSEMBLY and not self._in_assembly(each)]
        if not tops:
            raise ValueError(
                f"{self.file}: there is no assembly of FreeCAD's own workbench, 1.0 or later, in it; export solids as "
                "STEP, and jk.load finds their joints"
            )
        self.open = {each.name for each in tops}
        """Assemblies whose parts move against each other."""
        self.contents = [each for top in tops for each in self._contents(top)]
        """Objects in the assemblies: parts, and joints."""
        parts = [each for each in self.contents if each.type.startswith(PARTS)]
        self.names = dict(zip((each.name for each in parts), unique(each.label for each in parts), strict=True))
        joints = [each for each in self.contents if "JointType" in each]
        own = unique([*self.names.values(), *(each.label for each in joints)])[len(self.names) :]
        self.joints = dict(zip((each.name for each in joints), own, strict=True))

    def model(self) -> RobotModel:
        made, items = self.made, self.document.items
        for name, label in self.names.items():
            made.links[label] = RobotLink(label, self._chain(items[name])[-1][1])
        if not made.links:
            raise ValueError(f"{self.file}: there are no parts in its assembly")
        made.notes.append(f"{self.file}: solids are not read, which takes a CAD kernel; parts are drawn as small boxes")
        fixed: list[str] = []
        ends: dict[str, tuple[Marker, Marker]] = {}
        for each in self.contents:
            if "ObjectToGround" in each:
                fixed += self._held(each)
            elif "JointType" in each and (found := self._ends(each)) is not None:
                ends[each.name] = found
                self._joint(each, *found)
        bodies = RigidGroups.among(made, fixed)
        ties = [items[name] for name in ends if self._kind(items[name]) in TIES]
        for each in sorted(ties, key=lambda tie: self._kind(tie) != SCREW):  # screws first: gears may turn them
            self._tie(each, bodies, *ends[each.name])
        motors = [motor for each in items.values() if "MotionType" in each and (motor := self._motor(each))]
        for each in self.contents:
            if each.name in ends:
                self._limits(each)
        joints, links = tuple(made.joints.values()), tuple(made.links.values())
        driven = tuple(dict.fromkeys(motors))
        return RobotModel(
            links, joints, tuple(dict.fromkeys(fixed)), driven, tuple(made.notes), tuple(made.couplings), unit="mm"
        )

    def _held(self, ground: Item) -> tuple[str, ...]:
        """Find the part that is at rest; none, and a note, where there is no such part."""
        item = self.document.items.get(ground.refers("ObjectToGround").name)
        if item is not None and (part := self._moving(self._chain(item))) is not None:
            return (part,)
        self.made.notes.append(f"{ground} holds what is no part of the assembly; left out")
        return ()

    def _in_assembly(self, item: Item) -> bool:
        """Tell whether an object is inside of an assembly, at any depth."""
        return any(each.type in (ASSEMBLY, FLEXIBLE) for each in self._around(item))

    def _around(self, item: Item) -> list[Item]:
        """List the objects that an object is in, the innermost first."""
        found: list[Item] = []
        while (outer := self.document.inside.get(item.name)) is not None and outer not in found:
            found.append(outer)
            item = outer
        return found

    def _contents(self, assembly: Item) -> Iterator[Item]:
        """Yield what is in an assembly, through groups and the assemblies in it whose parts move."""
        seen = {assembly.name}
        waiting = [assembly]
        while waiting:
            for name in waiting.pop(0).group():
                item = self.document.items.get(name)
                if item is None or name in seen:
                    continue
                seen.add(name)
                if item.type == FLEXIBLE and not item.flag("Rigid", True):
                    self.open.add(name)
                if name in self.open or item.type in (*GROUPS, JOINTS):
                    waiting.append(item)
                else:
                    yield item

    def _chain(self, item: Item, sub: str = "") -> list[tuple[Item, Transform]]:
        """List the objects from the outermost one to the one that a placement is relative to, with world poses.

        Raises ValueError for an object that is not there.
        """
        items = [*reversed(self._around(item)), item]
        below = sub.split(".")[:-1] if sub else []
        while below:
            own = below[0] in items[-1].group()  # of a link to an assembly, too, whose parts are copied
            last = items[-1] if own else items[-1].target()
            if (found := last.document.items.get(below[0])) is None:
                raise ValueError(f"{below[0]!r} is not in {last.document.path.name}")
            datum = found.type.startswith(DATUMS)
            if not datum and (last.type == BODY or last.type.startswith("Part::")):
                break  # a feature of a solid: the placement is relative to the solid
            items.append(found)
            below = below[1:]
        poses, pose = [], np.eye(4)
        for each in items:
            pose = pose @ each.pose()
            poses.append((each, pose))
        return poses

    def _moving(self, chain: list[tuple[Item, Transform]]) -> str | None:
        """Find the part that moves as one with the last object of a chain; None outside of the assemblies."""
        inside = [number for number, (each, _) in enumerate(chain) if each.name in self.open]
        if not inside:
            return None
        behind = (each for each, _ in chain[inside[-1] + 1 :] if each.type not in GROUPS)
        return self.names.get(found.name) if (found := next(behind, None)) is not None else None

    def _ends(self, joint: Item) -> tuple[Marker, Marker] | None:
        """Find the two markers of a joint; None, and a note, where it is left out."""
        if joint.flag("Suppressed") or not joint.flag("Activated", True):
            self.made.notes.append(f"{joint} is suppressed; left out")
            return None
        markers = []
        for side in "12":
            to = joint.refers(f"Reference{side}")
            made = self._marker(joint, to, side)
            if isinstance(made, str):
                self.made.notes.append(f"{joint} is left out: {made}")
                return None
            markers.append(made)
        return markers[0], markers[1]

    def _marker(self, joint: Item, to: Reference, side: str) -> Marker | str:
        """Make the marker of one side of a joint; why there is none."""
        if not to.name:
            older = f"Object{side}" in joint
            return f"it has no Reference{side}{'; save it with FreeCAD 1.0 or later' if older else ''}"
        if to.file or to.name not in self.document.items:
            return f"its Reference{side} is {to.file or to.name!r}, which is not in the document"
        try:
            chain = self._chain(self.document.items[to.name], to.sub)
        except ValueError as error:
            return f"its Reference{side}: {error}"
        place = joint.place(f"Placement{side}")
        if (part := self._moving(chain)) is None or place is None:
            return f"its Reference{side}, {to.name!r}, is no part of the assembly, or it has no Placement{side}"
        return Marker(part, chain[-1][1] @ place)

    def _kind(self, joint: Item) -> str | None:
        """Name the joint of the solver; None for a distance that depends on the shapes of faces and edges."""
        said = joint.choice("JointType", TYPES)
        if said == "Distance":
            elements = [joint.refers(f"Reference{side}").sub.rpartition(".")[2] for side in "12"]
            return "SphSphJoint" if all(each.startswith("Vertex") for each in elements) else None
        if said == "Angle" and abs(np.sin(self._angle(joint))) < STRAIGHT:
            return "ParallelAxesJoint"
        if said not in JOINT_OF:
            raise ValueError(f"{joint}: expected a JointType of {', '.join(TYPES)}, got {said!r}")
        return JOINT_OF[said]

    @staticmethod
    def _angle(joint: Item) -> float:
        """Read the angle of a joint, which the first versions kept as a distance; radians."""
        return float(np.deg2rad(abs(joint.number("Angle" if "Angle" in joint else "Distance"))))

    def _joint(self, joint: Item, one: Marker, other: Marker) -> None:
        """Add a joint; one that ties others is for later."""
        if (kind := self._kind(joint)) is None:
            self.made.notes.append(
                f"{joint} is left out: what a Distance of faces or edges keeps depends on their shapes, which takes a "
                "CAD kernel"
            )
        elif kind not in TIES:
            sizes = {"distance": joint.number("Distance"), "angle": self._angle(joint)}
            keep = {"SphSphJoint": ("distance",), ANGLE: ("angle",)}.get(kind, ())
            self.made.add(
                kind, self.joints[joint.name], one, other, {key: sizes[key] for key in keep}, self._text(joint)
            )

    def _text(self, joint: Item) -> str:
        """Call a joint by its type and label."""
        return f"{joint.choice('JointType', TYPES)} {joint.label!r}"

    def _tie(self, joint: Item, bodies: RigidGroups, one: Marker, other: Marker) -> None:
        """Add what ties other joints: gears, belts, racks and screws."""
        kind, first, second = self._kind(joint) or "", joint.number("Distance"), joint.number("Distance2")
        sizes = {
            GEAR: {"radius_i": first, "radius_j": -second if self._text(joint).startswith("Belt") else second},
            RACK: {"radius": first},
            SCREW: {"pitch": first},
        }[kind]
        if kind == RACK:
            if not any(bodies.carried(self.made, one.link, SLIDES, "z", one.pose[:3, 2])):
                one, other = other, one
            one = _along_rack(one, other)
        tie = MarkerTie(kind, self.joints[joint.name], one, other, sizes, self._text(joint))
        add_tie(self.made, bodies, tie)

    def _motor(self, motion: Item) -> str | None:
        coordinate = MOTIONS.get(motion.choice("MotionType", tuple(MOTIONS)))
        name = self.joints.get(motion.refers("Joint").name)
        return self.made.motor(name, coordinate, f"motion {motion.label!r}")

    def _limits(self, joint: Item) -> None:
        for coordinate, name, size in LIMITED.get(joint.choice("JointType", TYPES), ()):
            low, high = (
                joint.number(f"{name}{end}") * size if joint.flag(f"Enable{name}{end}") else none
                for end, none in (("Min", -np.inf), ("Max", np.inf))
            )
            if np.isfinite(low) and np.isfinite(high):
                low, high = min(low, high), max(low, high)  # as FreeCAD does
            if np.isfinite([low, high]).any():
                self.made.limit(self.joints[joint.name], coordinate, low, high, f"a limit of {self._text(joint)}")


def _along_rack(rack: Marker, pinion: Marker) -> Marker:
    """Turn the marker of a rack, whose z axis is along the rack, as the solver has it: x along it, z that of the
    pinion."""
    z = pinion.pose[:3, 2]
    along = rack.pose[:3, 2] - (rack.pose[:3, 2] @ z) * z
    x = unit(along) if np.linalg.norm(along) > STRAIGHT else rack.pose[:3, 0]
    return Marker(rack.link, placed(np.stack([x, np.cross(z, x), z], axis=1), rack.pose[:3, 3]))
