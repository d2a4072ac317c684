"""Faces recovered from the welded triangles of a solid, and what of it lies on none of the four surfaces."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.facets import facets
from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face
from jaxkin.geometry.regions import regions
from jaxkin.geometry.torus import Torus
from jaxkin.geometry.weld import Welded

_INSTEAD = "export the part as STEP, whose faces are known, or coarser, or write the joints there by hand"
"""What to do where faces may be missed."""


def recovered_faces(welded: Welded, tolerance: float) -> tuple[tuple[Face, ...], list[str]]:
    """Recover the faces of a solid whose triangles are wound outwards; returns these, and notes on what is no face.

    `tolerance`, a length, is the rounding of the file.
    """
    corners = welded.points[welded.triangles]
    mesh = facets(welded.points, welded.triangles, welded.pairs, tolerance)
    faces, notes = [], []
    found = regions(mesh)
    unknown = [np.zeros(0, int)]
    for number, region in enumerate(found.regions, start=1):
        label = f"face {number}"
        if isinstance(region.surface, Torus) or region.surface is None:
            kind = "torus" if region.surface else f"freeform surface of {len(region.rows)} triangles"
            notes.append(f"{label}: {kind}, not one of the four surfaces")
            unknown += [region.rows] if region.surface is None else []
        else:
            faces.append(Face(label, region.surface, corners[region.rows]))
    if left := len(np.intersect1d(found.untried, np.concatenate(unknown))):
        notes.append(
            f"the search for round faces ended at its bounds, with {left} triangles of free-form faces untried: round "
            f"faces among them may be missed; {_INSTEAD}"
        )
    if found.pairs:
        notes.append(
            f"the search for pieces of one round face ended at its bounds, with {found.pairs} pairs of pieces untried: "
            f"faces may be in pieces; {_INSTEAD}"
        )
    return merge_faces(faces, tolerance), notes
