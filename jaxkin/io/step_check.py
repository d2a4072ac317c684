"""What was read from a STEP file, held against what the file says and against what a solid is."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from jaxkin.geometry.pose import Points, Transform, apply
from jaxkin.geometry.shells import open_loops, shells, volume, wrong_side
from jaxkin.geometry.triangles import Triangles, total_area
from jaxkin.geometry.weld import Welded, weld
from jaxkin.io.step_glb import Instance
from jaxkin.io.step_rounding import SINGLE

_CUT_SAMPLES = 24
"""Triangles of a part at which it is looked whether it cuts itself."""

MAX_FAR = 2e4
"""Distance of a part from an origin over its size up to which single precision leaves it right to a thousandth of its
size. Small screws of an aileron are 6e2 of their size away."""

_SAME_BOX = 0.02
"""Of the size of a solid: how far the box of its tessellation may be off its own; chords cut off less."""

_OUTER = re.compile(r"\b(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP)\s*\(\s*'(?:[^']|'')*'\s*,\s*#(\d+)")

_SHELL = re.compile(r"#(\d+)\s*=\s*CLOSED_SHELL\s*\(\s*'(?:[^']|'')*'\s*,\s*\(([^()]*)\)")


@dataclass(frozen=True)
class Defect:
    """Something amiss in a solid, at a place in the frame of its mesh."""

    what: str
    place: Points
    remedy: str
    damage: bool
    """Whether no sound file comes so."""

    def note(self, pose: Transform) -> str:
        """Tell the defect in words, the place in the world; `pose` is that of the mesh."""
        near = ", ".join(f"{x:.4g}" for x in apply(pose, self.place))
        return f"{self.what}, near ({near}): {self.remedy}"


def unsound(triangles: Triangles, tolerance: float) -> list[Defect]:
    """Find what is amiss in the triangles of a solid: holes, no volume, or else several solids and what cuts itself."""
    welded = weld(triangles, 2 * tolerance)
    if holes := open_loops(welded, tolerance):
        return [Defect("it is not closed, there is a hole", holes[0].mean(axis=0), "a face is missing or wrong", True)]
    if volume(triangles) <= tolerance * total_area(triangles):
        middle = triangles.mean(axis=(0, 1))
        return [Defect("it holds no volume, or is inside out", middle, "a face is missing or wrong", True)]
    return [*_several(welded), *_cut(triangles, tolerance)]


def _several(welded: Welded) -> list[Defect]:
    """Find whether a part is made of several solids: some systems write a whole mechanism so."""
    corners = welded.points[welded.triangles]
    pieces = [corners[rows] for rows in shells(welded)]
    sizes = {number: size for number, piece in enumerate(pieces) if (size := volume(piece)) > 0}  # others are cavities
    if len(sizes) < 2:
        return []
    smallest = pieces[min(sizes, key=lambda number: sizes[number])]
    what = f"it is made of {len(sizes)} solids that count as one body, the smallest"
    return [Defect(what, smallest.mean(axis=(0, 1)), "export them as parts if they move on each other", False)]


def _cut(triangles: Triangles, tolerance: float) -> list[Defect]:
    """Find where a part cuts itself; no damage: its faces are known exactly, and overlapping bodies are common in real
    assemblies."""
    if (place := wrong_side(triangles, tolerance, _CUT_SAMPLES)) is not None:
        what = "it cuts itself, or bodies touch or overlap in it"
        return [Defect(what, place, "unite them if they move apart", False)]
    return []


def without_tessellations(found: Sequence[Instance]) -> list[Instance]:
    """Leave out the tessellation of a solid that the same product has with exact geometry, as AP242 allows."""
    exact: dict[tuple[str, ...], list[tuple[Points, Points]]] = {}
    for each in found:
        if each.path and not each.mesh.tessellated:
            exact.setdefault(each.path, []).append(_box(each))
    return [each for each in found if not (each.mesh.tessellated and _among(_box(each), exact.get(each.path, ())))]


def _box(instance: Instance) -> tuple[Points, Points]:
    """Find the two opposite corners of the box of an instance, which is along the axes of its mesh."""
    return instance.pose @ [*instance.mesh.outline[0], 1.0], instance.pose @ [*instance.mesh.outline[-1], 1.0]


def _among(box: tuple[Points, Points], others: Sequence[tuple[Points, Points]]) -> bool:
    """Tell whether a box is one of some others."""
    near = _SAME_BOX * np.linalg.norm(box[1] - box[0])
    return any(max(np.abs(one - other).max() for one, other in zip(box, each, strict=True)) <= near for each in others)


def far_away(found: Sequence[Instance]) -> list[str]:
    """Find parts so far from an origin that single precision, in which they are read, leaves too few digits of them.

    Corners are from the origin of their part, rounded places from that of the assembly; lengths in metres.
    """
    worst, least = None, 0.0
    for instance in found:
        corners = instance.mesh.triangles.reshape(-1, 3)
        if len(corners):
            size = float(np.linalg.norm(np.ptp(corners, axis=0))) or np.finfo(float).tiny
            far = max(np.abs(each).max() for each in (corners, *_rounded_places(instance)))
            if far / size > max(least, MAX_FAR):
                worst, least = instance, far / size
    if worst is None:
        return []
    name = next(filter(None, worst.names), "without a name")
    return [
        f"the part {name!r} is {least:.2g} times its size from the origin, so that it is right to "
        f"{least * SINGLE:.1g} of its size only: export it nearer to the origin"
    ]


def _rounded_places(instance: Instance) -> list[Points]:
    """List where assemblies place an instance, as far as that is rounded more than the file does."""
    return [pose[:3, 3] for pose, rounding in instance.places if rounding]


def missing(text: str, placed: int, found: Sequence[Instance]) -> list[str]:
    """Find what the text of a file announces and the reader did not make.

    `placed` is how many parts its assemblies place, 0 without assemblies. The faces counted in the text are those of
    the outer shells of its solids, each once, however often it is placed: never more than there have to be.
    """
    said = []
    if placed and len(found) < placed:
        said.append(f"{placed} parts are placed in it, {len(found)} can be made as solids")
    outer, shells = set(), {}
    for statement in text.split(";"):  # a pattern over all of the text may take a time that grows with its square
        if solid := _OUTER.search(statement):
            outer.add(solid[1])
        elif "CLOSED_SHELL" in statement and (shell := _SHELL.search(statement)):
            shells[shell[1]] = shell[2].count("#")
    announced = sum(faces for number, faces in shells.items() if number in outer)
    if (made := sum(len(instance.mesh.faces) for instance in found)) < announced:
        said.append(f"its solids have {announced} faces, {made} can be made")
    return said
