"""What a CAD system exports for Simscape Multibody: instances, placements, joints, mates and masses, in metres."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.geometry.inertial import Inertial
from jaxkin.io.export_content import Export, ExportedJoint, ExportedMate, ExportedPart, ExportedSide, MatedFeature
from jaxkin.io.export_units import KILOGRAMS_BY_NAME, METRES_BY_NAME, factor, model_unit, unit_of
from jaxkin.io.xml_tree import read_xml

ROOTS = ("SimscapeMultibodyImportXML", "SimMechanicsImportXML")
"""Outermost elements: of version 2.0, and of 1.0, which SimMechanics Link wrote until 2015."""

_OTHERS = {
    "PhysicalModelingXMLFile": ", the first generation of SimMechanics Link: export the assembly by Simscape Multibody "
    "Link, or as STEP"
}
"""Outermost elements of files that are refused -> what to do."""

ORTHOGONAL = 1e-5
"""Largest entry by which rows of a rotation are not orthogonal unit vectors: those of six digits are not by 2e-6."""

HUGE = 1e30
"""Numbers of no machine, in any unit, whose squares still can be computed with."""

RELATIONS = ("Joints/*", "Constraints/*")
"""Where an assembly has its joints and mates."""

MARKS_RIGID = "link"
"""In the name of an exporter that marks all sub-assemblies that are rigid: Simscape Multibody Link and SimMechanics
Link, of SolidWorks, Creo and Inventor. That of Onshape marks none, and is named otherwise."""

RIGID = "Rigid"
"""A constraint of Creo: of two instances that they do not move against each other, of one that it is fixed in the
assembly. It has no frames or features."""


class _Above(NamedTuple):
    """An assembly that holds instances; the root has the empty path."""

    path: tuple[str, ...]
    names: tuple[str, ...]
    place: np.ndarray
    """(4, 4), metres."""
    stands_in: tuple[str, ...]
    """Path of the outermost assembly in which its frame is fixed: its own where it may move, () where it stands in the
    world."""
    body: tuple[str, ...] | None
    """The rigid group or rigid assembly that holds it."""
    holds_all: bool = False
    """Whether all in it is fixed, unless it says which: it is fixed itself, and has no joints or mates."""
    held: Mapping[tuple[str, ...], tuple[str, ...]] = MappingProxyType({})
    """Paths below it of what is held by constraints -> path of the assembly in which it is fixed."""


def read_export(path: str | Path, root: Element | None = None) -> Export:
    """Read the XML of Simscape Multibody Link or of a CAD system that writes the same; `root` where it is parsed.

    Raises FileNotFoundError where there is no file, and ValueError where the XML is damaged, is of another kind, has
    an unknown unit, or places an instance by numbers that are not finite.
    """
    path = Path(path)
    root = read_xml(path) if root is None else root
    if root.tag not in ROOTS or (assembly := root.find("RootAssembly")) is None:
        raise ValueError(
            f"{path.name}: expected {ROOTS[0]} with a RootAssembly, got <{root.tag}>{_OTHERS.get(root.tag, '')}"
        )
    return _Reader(path.name, root).export(assembly)


class _Reader:
    """The definitions of one file, and what was not understood in it."""

    def __init__(self, file: str, root: Element) -> None:
        self.file, self.notes = file, []
        self.metres = self._metres(unit_of(root, "length", "meter"))
        self.kilograms = self._kilograms(unit_of(root, "mass", "kilogram"))
        self.root = root
        self.part_of = {_uid(part): part for part in root.iterfind("Parts/Part")}
        self.assembly_of = {_uid(one): one for one in root.iterfind("Assemblies/Assembly")}
        self.rounding = 0.0
        self.uid_of: dict[tuple[str, ...], str] = {}
        self.placed: dict[tuple[str, ...], np.ndarray] = {(): np.eye(4)}

    def export(self, root: Element) -> Export:
        """Place all instances, then the joints of the root and of each sub-assembly where it is placed."""
        tree, parts, assemblies = root.find("InstanceTree"), [], [((), root)]
        if tree is not None:
            world = _Above((), (), np.eye(4), (), None, held=_held(root, ()))
            for path, names, instance, fixed_in, body in self._instances(tree, world):
                uid = _uid(instance, "entityUid")
                if uid in self.part_of:
                    parts.append(self._part(self.part_of[uid], path, names, fixed_in, body))
                elif uid in self.assembly_of:
                    assemblies.append((path, self.assembly_of[uid]))
                else:
                    self.notes.append(f"{'/'.join(names)}: no part or assembly {uid!r} in the file; left out")
        self.uid_of = {path: _uid(assembly) for path, assembly in assemblies}
        found = [one for path, assembly in assemblies for one in self._relations(assembly, path)]
        joints = tuple(one for one in found if isinstance(one, ExportedJoint))
        mates = tuple(one for one in found if isinstance(one, ExportedMate))
        created = self.root.find("Created")
        marks_rigid = created is not None and MARKS_RIGID in created.get("using", "").casefold()
        marks_rigid |= tree is not None and any(_true(each, "rigid") for each in tree.iter("Instance"))
        return Export(root.get("name", ""), tuple(parts), joints, mates, tuple(self.notes), self.rounding, marks_rigid)

    def _instances(self, at: Element, above: _Above) -> Iterator[tuple]:
        """Yield (path, names, element, fixed in, body) of the instances inside an element, outer ones first.

        Parts of one rigid group, and of an assembly that is rigid, do not move against each other; of several, one
        inside the other, the outermost decides. An instance that is grounded is fixed in the assembly that it is in,
        and in the world only if that is: the first part of most assemblies is, also of those that move.
        """
        inside = at.findall("Instance")
        grounded = {_uid(one) for one in inside if _true(one, "grounded")}
        held = {**{(uid,): above.stands_in for uid in grounded}, **above.held}
        everything = above.holds_all and not grounded
        for one in inside:
            inner, called = (*above.path, _uid(one)), (*above.names, one.get("name", ""))
            group = one.get("rigidGroup")
            body = above.body or ((*above.path, f"group {group}") if group else inner if _true(one, "rigid") else None)
            if inner in self.placed:
                self.notes.append(
                    f"{'/'.join(called)}: another instance has its identifier {inner[-1]!r}; taken for one body"
                )
            self.placed[inner] = above.place @ self._transform(one.find("Transform"), "/".join(called))
            fixed_in = above.stands_in if everything else held.get((inner[-1],))
            yield inner, called, one, fixed_in, body
            definition = self.assembly_of.get(_uid(one, "entityUid"))
            tied = definition is not None and any(definition.find(each) is not None for each in RELATIONS)
            stands_in, holds_all = (inner, False) if fixed_in is None else (fixed_in, not tied)
            below = {path[1:]: at for path, at in held.items() if path[0] == inner[-1] and len(path) > 1}
            below |= {} if definition is None else _held(definition, stands_in)
            yield from self._instances(
                one, _Above(inner, called, self.placed[inner], stands_in, body, holds_all, below)
            )

    def _part(
        self, part: Element, path: tuple, names: tuple, fixed_in: tuple | None, body: tuple | None
    ) -> ExportedPart:
        geometry = part.find("GeometryFile")
        file = "" if geometry is None else geometry.get("name", "")
        unit = model_unit(self.root, part)
        metres = factor(unit, METRES_BY_NAME)
        said = (unit, metres) if metres else ("metres", 1.0)
        return ExportedPart(path, names, file, said, self.placed[path], self._inertial(part, names[-1]), fixed_in, body)

    def _inertial(self, part: Element, name: str) -> Inertial | None:
        """Read what a part weighs; None, and a note, for a mass below zero."""
        texts = [part.findtext(f"MassProperties/{each}") for each in ("Mass", "CenterOfMass", "Inertia")]
        if None in texts or self.kilograms is None:
            return None
        (mass,), centre, six = (self._numbers(text, n, name) for text, n in zip(texts, (1, 3, 6), strict=True))
        if mass < 0:
            self.notes.append(f"{name}: expected a mass from 0 on, got {mass:g}; it is not taken")
            return None
        xx, yy, zz, yz, zx, xy = six * self.kilograms * self.metres**2
        inertia = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
        return Inertial(float(mass) * self.kilograms, centre * self.metres, inertia)

    def _relations(self, assembly: Element, path: tuple) -> Iterator[ExportedJoint | ExportedMate]:
        """Yield the joints and mates of an assembly at a path; note those that are neither."""
        for one in (each for place in RELATIONS for each in assembly.iterfind(place)):
            name = one.get("name", "")
            frames = [self._side(frame, path, name) for frame in (one.find("BaseFrame"), one.find("FollowerFrame"))]
            paths = [self._path(each, path) for each in one.iterfind("InstancePath")]
            known = all(each in self.placed for each in paths)
            features = [self._feature(each, path, name) for each in one.iterfind("ConstraintGeometry")]
            if frames[0] and frames[1]:
                yield ExportedJoint(name, one.tag, (frames[0], frames[1]))
            elif len(features) == 2 and features[0] and features[1]:
                yield ExportedMate(name, one.tag, (features[0], features[1]))
            elif len(paths) == 2 and known:
                bare = [MatedFeature(each, "", self.placed[each][:3, 3], None) for each in paths]
                yield ExportedMate(name, one.tag, (bare[0], bare[1]))
            elif not (one.tag == RIGID and len(paths) == 1 and known):  # those are read with the instances
                several = f"it is of {len(features)} features, and only relations of two are kept"
                why = several if len(features) > 2 else "no two frames or features of instances of the file"
                self.notes.append(f"{one.tag} {name!r}: {why}; left out")

    def _side(self, frame: Element | None, above: tuple, name: str) -> ExportedSide | None:
        if frame is None or (path := self._path(frame.find("InstancePath"), above)) not in self.placed:
            return None
        return ExportedSide(path, self.placed[path] @ self._transform(frame.find("Transform"), name))

    def _feature(self, geometry: Element, above: tuple, name: str) -> MatedFeature | None:
        if (path := self._path(geometry.find("InstancePath"), above)) not in self.placed:
            return None
        place, axis, point = self.placed[path], None, np.zeros(3)
        if (written := geometry.findtext("Position")) is not None:
            point = self._numbers(written, 3, name) * self.metres
        if (written := geometry.findtext("Axis")) is not None:
            axis = self._numbers(written, 3, name)
            if not (length := float(np.linalg.norm(axis))):
                raise ValueError(f"{self.file}: {name!r}: expected the direction of an axis, got {written!r}")
            axis = place[:3, :3] @ (axis / length)
        return MatedFeature(path, geometry.get("geomType", ""), place[:3, :3] @ point + place[:3, 3], axis)

    def _transform(self, at: Element | None, name: str) -> np.ndarray:
        """Read a (4, 4) transform, metres; rotations are written row by row. The identity where there is none."""
        transform = np.eye(4)
        if at is not None:
            rotation = self._numbers(at.findtext("Rotation"), 9, name).reshape(3, 3)
            rounding = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
            if rounding > ORTHOGONAL or np.linalg.det(rotation) < 0:
                raise ValueError(
                    f"{self.file}: {name!r}: expected a rotation, nine numbers row by row, got {rotation.tolist()}; "
                    "parts that are mirrored or scaled have to be exported as parts of their own"
                )
            self.rounding = max(self.rounding, rounding)
            left, _, right = np.linalg.svd(rotation)
            transform[:3, :3] = left @ right  # the nearest rotation
            transform[:3, 3] = self._numbers(at.findtext("Translation"), 3, name) * self.metres
        return transform

    def _path(self, inside: Element | None, above: tuple[str, ...]) -> tuple[str, ...]:
        """Read the identifiers from the root to the instance that a side of a joint or mate is on.

        What is on the assembly itself has no path, or one with the identifier of the root or of the assembly only.
        """
        path = _uids(inside)
        itself = path in ((self.uid_of[()],), (self.uid_of[above],)) and (*above, *path) not in self.placed
        return above if itself else (*above, *path)

    def _numbers(self, text: str | None, count: int, name: str) -> np.ndarray:
        try:
            numbers = np.array((text or "").split(), float)
        except ValueError:
            numbers = np.empty(0)
        if len(numbers) != count or not (np.abs(numbers) < HUGE).all():  # NaN, too
            raise ValueError(
                f"{self.file}: {name!r}: expected {count} numbers, finite and below {HUGE:g}, got {text!r}"
            )
        return numbers

    def _metres(self, unit: str) -> float:
        metres = factor(unit, METRES_BY_NAME)
        if metres is None:
            expected = ", ".join(METRES_BY_NAME)
            raise ValueError(f"{self.file}: unit of length {unit!r} is not known; expected one of {expected}")
        return metres

    def _kilograms(self, unit: str) -> float | None:
        """Look up a unit of mass; None, and a note, for one that is not known."""
        kilograms = factor(unit, KILOGRAMS_BY_NAME)
        if kilograms is None:
            self.notes.append(f"unit of mass {unit!r} is not known, and masses are not taken")
        return kilograms


def _true(instance: Element, attribute: str) -> bool:
    return instance.get(attribute, "").strip().lower() == "true"


def _uid(of: Element, attribute: str = "uid") -> str:
    return of.get(attribute, "").strip()


def _uids(path: Element | None) -> tuple[str, ...]:
    return () if path is None else tuple((uid.text or "").strip() for uid in path.iterfind("Uid"))


def _held(assembly: Element, stands_in: tuple[str, ...]) -> dict[tuple[str, ...], tuple[str, ...]]:
    """List the paths, below an assembly, of what its constraints fix in it."""
    alone = [each.findall("InstancePath") for each in assembly.iterfind(f"Constraints/{RIGID}")]
    return {_uids(paths[0]): stands_in for paths in alone if len(paths) == 1 and _uids(paths[0])}
