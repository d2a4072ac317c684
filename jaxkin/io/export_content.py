"""What the export of a CAD system says, placed in the world: instances, joints and mates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jaxkin.geometry.inertial import Inertial


@dataclass(frozen=True, eq=False)
class ExportedPart:
    """An instance of a part, placed."""

    path: tuple[str, ...]
    """Identifiers of the assemblies that hold it, from the root, and its own."""
    names: tuple[str, ...]
    """Names along the path."""
    file: str
    """Name of its STEP file, beside the XML; empty where the export names none."""
    file_unit: tuple[str, float]
    """Unit of its model, which is that of a file that says none itself, such as one of STL: its name, and metres."""
    transform: np.ndarray
    """(4, 4) from its file to the world, metres."""
    inertial: Inertial | None
    """What it weighs: metres, in the axes of its file; None where the export does not say all of it."""
    fixed_in: tuple[str, ...] | None
    """Path of the assembly in which it is fixed, as it is placed there; () in the world, None where it may move."""
    body: tuple[str, ...] | None
    """The rigid group, or the rigid assembly, that holds it, by its path; None where the part moves alone."""

    @property
    def name(self) -> str:
        """Names along the path, joined by "/"."""
        return "/".join(self.names)


@dataclass(frozen=True, eq=False)
class ExportedSide:
    """One side of a joint or mate."""

    path: tuple[str, ...]
    frame: np.ndarray
    """(4, 4) in world coordinates, metres; the axis of a joint is its third column."""


@dataclass(frozen=True, eq=False)
class ExportedJoint:
    """A joint or mate between two instances."""

    name: str
    kind: str
    """The tag that the exporter writes: "Revolute", "Weld", ..."""
    sides: tuple[ExportedSide, ExportedSide]


@dataclass(frozen=True, eq=False)
class MatedFeature:
    """The geometry of an instance that a mate is about."""

    path: tuple[str, ...]
    kind: str
    """As the exporter writes it: "plane", "line", "cylinder", "point", ..."""
    point: np.ndarray
    """(3,) in world coordinates, metres; the origin of the instance where the export has none."""
    axis: np.ndarray | None
    """(3,) unit vector in world coordinates: of a plane its normal; None where the export has none."""


@dataclass(frozen=True, eq=False)
class ExportedMate:
    """A mate between geometry of two instances."""

    name: str
    kind: str
    """The tag that the exporter writes: "Concentric", "Coincident", ..."""
    sides: tuple[MatedFeature, MatedFeature]


@dataclass(frozen=True, eq=False)
class Export:
    """What one XML file says."""

    name: str
    parts: tuple[ExportedPart, ...]
    joints: tuple[ExportedJoint, ...]
    mates: tuple[ExportedMate, ...]
    notes: tuple[str, ...]
    """What is in the file and was not understood, one line each."""
    rounding: float
    """Largest entry by which rows of its rotations are not orthogonal unit vectors: about what the digits leave."""
    marks_rigid: bool
    """Whether its exporter marks what sub-assemblies are rigid: then parts of the others may move against each
    other."""
