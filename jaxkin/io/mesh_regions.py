"""Faces recovered from the welded triangles of a solid, and what of it lies on none of the four surfaces."""

from __future__ import annotations

from jaxkin.geometry.facets import facets
from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face
from jaxkin.geometry.regions import regions
from jaxkin.geometry.torus import Torus
from jaxkin.geometry.weld import Welded


def recovered_faces(welded: Welded, tolerance: float) -> tuple[tuple[Face, ...], list[str]]:
    """Recover the faces of a solid whose triangles are wound outwards; returns these, and notes on what is no face.

    `tolerance`, a length, is the rounding of the file.
    """
    corners = welded.points[welded.triangles]
    mesh = facets(welded.points, welded.triangles, welded.pairs, tolerance)
    faces, notes = [], []
    for number, region in enumerate(regions(mesh), start=1):
        label = f"face {number}"
        if isinstance(region.surface, Torus) or region.surface is None:
            kind = "torus" if region.surface else f"freeform surface of {len(region.rows)} triangles"
            notes.append(f"{label}: {kind}, not one of the four surfaces")
        else:
            faces.append(Face(label, region.surface, corners[region.rows]))
    return merge_faces(faces, tolerance), notes
