"""Read parts from mesh files: closed solids, whose faces are recovered from their triangles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from jaxkin._files import check_file
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Points
from jaxkin.geometry.shells import bodies, holes_and_cracks, shells, volume, wrong_side
from jaxkin.geometry.triangles import total_area
from jaxkin.geometry.weld import weld
from jaxkin.io.mesh_check import MAX_MESH_NODES
from jaxkin.io.mesh_nodes import MeshNode, read_nodes
from jaxkin.io.mesh_regions import recovered_faces
from jaxkin.io.names import cleaned, unique
from jaxkin.io.time_limit import TimeLimit

_TOLD_HOLES = 3
"""Holes of a mesh that are told: the largest, by which the others are found."""

MESHES = (".stl", ".obj", ".ply", ".3mf", ".glb")


def read_mesh(path: str | Path, whole: str | None = None, seconds: float | None = None) -> tuple[tuple[Part, ...], str]:
    """Read the parts of a mesh file, in its coordinates, and the unit of its lengths, "" where it has none.

    A part is a node of the file; in a file of one node it is a connected body, called as the file, or "part 1",
    "part 2", where there are several. With `whole`, all of the file is one part of that name. Faces that lie on none of
    the four surfaces, and what was repaired, are in the notes of the part. `seconds` is the time allowed, by default
    that of `TimeLimit`.

    Raises FileNotFoundError where there is no such file, and ValueError where it holds no closed solids, or is not read
    in time.
    """
    path = Path(path)
    check_file(path, "mesh file")
    limit = TimeLimit.start(path, seconds)
    nodes, unit = read_nodes(path, limit)
    if whole is not None:
        corners = np.concatenate([node.corners for node in nodes])
        solids = [MeshNode(whole, nodes[0].color, corners, max(node.vertex_resolution for node in nodes))]
    elif len(nodes) > 1:
        solids = nodes
    else:
        solids = _bodies(nodes[0], path)
    # the caller's own name for a whole file is kept as it is
    names = unique(
        solid.name if whole is not None else cleaned(solid.name) or f"part {number}"
        for number, solid in enumerate(solids, start=1)
    )
    parts = []
    for name, solid in zip(names, solids, strict=True):
        limit.remaining()
        parts.append(replace(_part(name, solid, path.name), original_name=solid.name))
    return tuple(parts), unit


def _bodies(node: MeshNode, path: Path) -> list[MeshNode]:
    """Find the connected bodies of a node."""
    welded = weld(node.corners, 2 * node.tolerance)
    corners = welded.points[welded.triangles]
    closed = shells(welded) if len(corners) else []
    if len(closed) > MAX_MESH_NODES:
        raise ValueError(f"{path.name} holds {len(closed)} bodies, more than {MAX_MESH_NODES}: export it part by part")
    found = bodies(corners, closed) if closed else []
    if len(found) < 2 or len(welded.open_edges):
        return [MeshNode(path.stem, node.color, node.corners, node.vertex_resolution)]
    return [
        MeshNode(f"part {number}", node.color, corners[rows], node.vertex_resolution)
        for number, rows in enumerate(found, start=1)
    ]


def _part(name: str, solid: MeshNode, source: str) -> Part:
    """Make a part of the triangles of a node: corners welded, wound outwards, grouped into faces.

    Raises ValueError for what is not closed, holds no volume, or cuts itself; `source` is the file that messages name.
    """
    welded = weld(solid.corners, 2 * solid.tolerance)
    corners = welded.points[welded.triangles]
    notes = []
    where = f"{source}: the part {name!r}"
    if not len(corners):
        raise ValueError(f"{where} has no triangles but points and lines: export it as a solid")
    loops, cracks = holes_and_cracks(welded, solid.tolerance)
    if loops:
        raise ValueError(
            f"{where} is not closed, or its triangles are not all wound the same way: there {_holes(loops)}; close "
            "them in a program for meshes, export the part again with a coarser or finer tolerance, or as a STEP file"
        )
    if cracks:
        place = ", ".join(f"{x:.4g}" for x in cracks[0].place)
        notes.append(
            f"its faces do not meet along {len(cracks)} of their edges, the first near ({place}), by up to "
            f"{max(crack.width for crack in cracks):.2g}: export it with shared corners if faces are missed there"
        )
    triangles = welded.triangles
    if abs(volume(corners)) <= 2 * solid.tolerance * total_area(corners):
        raise ValueError(f"{where} is a sheet, or nothing: its triangles hold no volume; export it as a solid")
    if volume(corners) < 0:
        triangles, corners = triangles[:, ::-1], corners[:, ::-1]
        notes.append("its triangles faced inwards: turned round")
    if (place := wrong_side(corners, solid.tolerance)) is not None:
        near = ", ".join(f"{x:.4g}" for x in place)
        raise ValueError(
            f"{where} cuts itself, or solids touch or overlap in it, near ({near}): unite them, or give each as a part"
        )
    faces, unknown = recovered_faces(replace(welded, triangles=triangles), solid.tolerance)
    return Part(name, faces, corners, solid.color, (*notes, *unknown), solid.vertex_resolution)


def _holes(loops: list[Points]) -> str:
    """Tell where the largest of some holes are, each by the points of its rim, how wide, and how many edges they
    have."""
    widest = sorted(loops, key=lambda rim: -float(np.linalg.norm(np.ptp(rim, axis=0))))[:_TOLD_HOLES]
    told = [
        f"near ({', '.join(f'{x:.4g}' for x in rim.mean(axis=0))}), {np.linalg.norm(np.ptp(rim, axis=0)):.3g} across "
        f"with {len(rim)} edges"
        for rim in widest
    ]
    if len(loops) == 1:
        return f"is a hole {told[0]}"
    return f"are {len(loops)} holes, the largest {'; '.join(told)}"
