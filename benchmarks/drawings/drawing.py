"""An assembly with known joints, drawn at a place and in an order at random, and all kinds by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, NamedTuple

import cadquery as cq
import numpy as np
from OCP.Interface import Interface_Static

from drawings.shapes import Shape

Unit = Literal["MM", "INCH"]


class TrueJoint(NamedTuple):
    """What a designer means by two parts."""

    kind: str
    """Weld, Revolute, Cylindrical, Prismatic or Spherical."""
    parts: tuple[str, str]
    point: np.ndarray
    axis: np.ndarray


@dataclass
class Drawing:
    """Solids and the joints that they are meant to have; lengths in millimetres."""

    fixed: Sequence[str]
    unit: Unit = "MM"
    """That of the STEP file."""
    parts: dict[str, Shape] = field(default_factory=dict)
    joints: list[TrueJoint] = field(default_factory=list)

    def add(self, name: str, shape: Shape) -> None:
        """Draw a part."""
        if name in self.parts:
            raise ValueError(f"part {name!r} is drawn twice")
        self.parts[name] = shape

    def joint(self, kind: str, one: str, other: str, point=(0, 0, 0), axis=(0, 0, 1)) -> None:
        """Say what two parts are meant to be to each other."""
        unit = np.asarray(axis, float) / np.linalg.norm(axis)
        self.joints.append(TrueJoint(kind, (one, other), np.asarray(point, float), unit))


KINDS: dict[str, Callable[[np.random.Generator], Drawing]] = {}


def kind(draw: Callable[[np.random.Generator], Drawing]) -> Callable[[np.random.Generator], Drawing]:
    """Put a function that draws one kind of assembly, at sizes of the generator, on the list."""
    KINDS[draw.__name__] = draw
    return draw


def write(drawing: Drawing, path: Path, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Write the STEP file; return how it is turned (3, 3) and then moved (3,), in millimetres."""
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn = turn * np.sign(np.linalg.det(turn))
    shift = random.normal(size=3) * 100
    place = cq.Location(cq.Plane(tuple(shift.tolist()), tuple(turn[:, 0].tolist()), tuple(turn[:, 2].tolist())))
    assembly = cq.Assembly(name="the whole drawing")
    for name in random.permutation(list(drawing.parts)).tolist():
        solids = drawing.parts[name].vals()
        assembly.add(solids[0] if len(solids) == 1 else cq.Compound.makeCompound(solids), name=name, loc=place)
    Interface_Static.SetCVal_s("write.step.unit", drawing.unit)
    assembly.export(str(path))
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    return turn, shift
