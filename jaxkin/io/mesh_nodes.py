"""Mesh files as nodes, each a set of triangles with a name: read by trimesh in a process of its own.

With bounds on its time and memory, and nothing printed, whatever the file makes of the reader.
"""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxkin._names import listed
from jaxkin.geometry.pose import apply
from jaxkin.io.gltf_colors import Color, from_gltf
from jaxkin.io.mesh_check import MAX_MESH_NODES, MAX_TRIANGLES, check, is_binary_stl
from jaxkin.io.sandbox import run_apart
from jaxkin.io.time_limit import TimeLimit

MESH_MEMORY = 8 << 30
"""Bytes of address space for the reader, most of it never used: `MAX_TRIANGLES` triangles as text take two."""

_CALLER = 7
"""Calls from a warning to `load`."""

_LEAST, _GREATEST = 1e-15, 1e15
"""Sizes of parts, from what is a micrometre in thousands of kilometres to the other way round."""


@dataclass(frozen=True, eq=False)
class MeshNode:
    """Triangles that a file keeps together."""

    name: str
    color: Color | None
    corners: Float[np.ndarray, "triangles 3 3"]
    """In world coordinates, in the unit of the file."""
    vertex_resolution: float
    """The length by which numbers as large as those of the file are rounded."""

    @property
    def tolerance(self) -> float:
        """The length by which corners may miss the surface that they were made on: see `rounding`."""
        return max(1e-6 * float(np.linalg.norm(np.ptp(self.corners.reshape(-1, 3), axis=0))), self.vertex_resolution)


def read_nodes(path: Path, limit: TimeLimit) -> tuple[list[MeshNode], str]:
    """Read the nodes of a mesh file that have triangles, and its unit, "" where the format has none.

    Raises ValueError where it is no mesh that can be read, or not within the limit.
    """
    unit = check(path)
    found = _binary_stl(path) if is_binary_stl(path) else _by_trimesh([path], limit)[path]
    if isinstance(found, ValueError):
        raise found
    return found, unit or ""


def read_several(paths: Iterable[Path], seconds: float | None = None) -> dict[Path, list[MeshNode] | ValueError]:
    """Read the nodes of mesh files, or why there are none; `seconds` is the time allowed for each.

    The program that reads takes most of a second to start: one reads all of them. Where a file ends it, the next begins
    with that file, to which all of its time belongs.
    """
    found: dict[Path, list[MeshNode] | ValueError] = {}
    rest = []
    for path in paths:
        try:
            check(path)
            if is_binary_stl(path):
                found[path] = _binary_stl(path)
            else:
                rest.append(path)
        except ValueError as error:
            found[path] = error
    while rest:
        found |= (read := _by_trimesh(rest, TimeLimit.start(rest[0], seconds)))
        rest = rest[len(read) :]
    return found


def _binary_stl(path: Path) -> list[MeshNode]:
    """Read records of 50 bytes after the header, each a normal, three corners and two bytes of no meaning here.

    The commonest of all mesh files, one for every part; to start trimesh takes longer than to read a hundred of them.
    """
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("about", "<u2")])
    return [_node(path.stem, None, np.fromfile(path, record, offset=84)["corners"], np.eye(4), path.name)]


def _by_trimesh(paths: list[Path], limit: TimeLimit) -> dict[Path, list[MeshNode] | ValueError]:
    """Read as many of the files, in their order, as one program does before one of them ends it; at least the first."""
    with tempfile.TemporaryDirectory() as folder:
        files = [path.resolve() for path in paths]
        try:
            _, said = run_apart(
                "mesh_worker.py",
                MAX_TRIANGLES,
                MAX_MESH_NODES,
                folder,
                *files,
                folder=folder,
                limit=limit,
                memory=MESH_MEMORY,
            )
            ended = _unreadable(paths[0], (said.strip().splitlines() or ["the reader crashed on it"])[-1])
        except ValueError as overtime:
            ended = overtime
        found = {}
        for k, path in enumerate(paths):
            nodes, reason = Path(folder) / f"{k}.npz", Path(folder) / f"{k}.txt"
            if reason.exists():
                found[path] = _unreadable(path, reason.read_text())
            elif nodes.exists():
                found[path] = _nodes(path, nodes)
            else:
                break
        return found or {paths[0]: ended}


def _unreadable(path: Path, why: str) -> ValueError:
    kind = path.suffix.removeprefix(".").upper()
    return ValueError(f"{path.name} cannot be read as {kind}: {why}; export it again")


def _nodes(path: Path, written: Path) -> list[MeshNode] | ValueError:
    """Make the nodes of a file of what the reader wrote."""
    with np.load(written) as data:
        entries, left_out = json.loads(str(data["about"])), json.loads(str(data["left_out"]))
        try:
            nodes = [
                _node(entry["name"], _color(path, entry["color"]), data[f"corners{k}"], data[f"pose{k}"], path.name)
                for k, entry in enumerate(entries)
            ]
        except ValueError as error:
            return error
    others = f"{listed(left_out)} {'is' if len(left_out) == 1 else 'are'} no part, and left out" if left_out else ""
    if not nodes:
        none = f"holds no parts: {others}; " if others else "holds no triangles: "
        return ValueError(f"{path.name} {none}export the parts as solids")
    if others:
        warnings.warn(f"{path.name}: {others}; export them as solids if they matter", stacklevel=_CALLER)
    return nodes


def _color(path: Path, written: list[float] | None) -> Color | None:
    """Return the colour of a node as on the screen, which is how all formats but glTF have it."""
    if written is None:
        return None
    return from_gltf(written) if path.suffix.lower() == ".glb" else (written[0], written[1], written[2])


@np.errstate(over="ignore", invalid="ignore")  # sizes that are infinite are refused below
def _node(name: str, color: Color | None, corners: np.ndarray, pose: np.ndarray, source: str) -> MeshNode:
    corners, pose = np.asarray(corners, float), np.asarray(pose, float)
    bad = int(np.sum(~np.isfinite(corners).all(axis=(1, 2))))
    if bad or not np.all(np.isfinite(pose)):
        raise ValueError(f"{source}: {bad or 'all'} of its triangles have coordinates that are no numbers; repair it")
    scale = np.linalg.svd(pose[:3, :3], compute_uv=False)
    if np.linalg.det(pose[:3, :3]) < 0:
        corners = corners[:, ::-1]
    vertex_resolution = 3e-7 * float(np.abs(corners).max() * scale.max())
    node = MeshNode(name, color, apply(pose, corners), vertex_resolution)
    size = float(np.linalg.norm(np.ptp(node.corners.reshape(-1, 3), axis=0)))
    if size == 0:
        raise ValueError(f"{source}: all its triangles are one point: export the part as a solid")
    if not _LEAST < size < _GREATEST:
        raise ValueError(f"{source}: a part of the size {size:.2g} is none in any unit: export it in a usual one")
    if size < 200 * vertex_resolution:
        raise ValueError(
            f"{source}: coordinates up to {np.abs(node.corners).max():.2g} leave too few digits for a part of the size "
            f"{size:.2g}: export it nearer to the origin"
        )
    return node
