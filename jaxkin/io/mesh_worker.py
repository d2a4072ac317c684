"""Reads mesh files by trimesh, as a program of its own: `python mesh_worker.py TRIANGLES NODES FOLDER FILE...`.

What it reads is not to be trusted: a few bytes may ask for any amount of memory or time. It imports nothing of jaxkin,
so that it starts at once. Of the k-th file FOLDER gets k.npz, the triangles of every node and their names, and what was
left out, or k.txt, the reason why there are none, as one line.
"""

import io
import json
import re
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np

_THREEMF, _GLB, _OBJ = (
    runpy.run_path(str(Path(__file__).with_name(f"{name}.py")))
    for name in ("threemf_reader", "glb_reader", "obj_faces")
)
"""What reads formats of which trimesh mixes up objects, takes supports for parts, or leaves out what it cannot read."""

Refused = _THREEMF["Refused"]
"""What the reader would take, but is too much or makes no sense."""


def main(most: int, parts: int, folder: Path, sources: list[Path]) -> None:
    """Write the nodes of each file, or the reason why there are none."""
    kinds = [source.suffix.lower().removeprefix(".") for source in sources]
    # what trimesh could use and reading does without takes twice as long to import as all the rest
    for module in ("scipy", "matplotlib", "PIL", "networkx"):
        sys.modules[module] = None  # pyright: ignore[reportArgumentType]
    for k, (source, kind) in enumerate(zip(sources, kinds, strict=True)):
        try:
            with source.open("rb") as file:
                nodes, left_out = read(file, kind, most, parts)
            arrays = {f"{key}{n}": node[key] for n, node in enumerate(nodes) for key in ("corners", "pose")}
            about = [{"name": node["name"], "color": node["color"]} for node in nodes]
            arrays |= {"about": np.array(json.dumps(about)), "left_out": np.array(json.dumps(left_out))}
            np.savez(folder / "unfinished.npz", **arrays)
            (folder / "unfinished.npz").replace(folder / f"{k}.npz")
        except Exception as error:  # the loaders raise whatever a damaged file makes them stumble over
            (folder / f"{k}.txt").write_text(reason(error))


def reason(error: Exception) -> str:
    """Say in one line why a file is not read."""
    if isinstance(error, MemoryError):
        return "it asks for more memory than a mesh of that size needs"
    if isinstance(error, RecursionError):
        return "its nodes are nested without end"
    if isinstance(error, (Refused, _GLB["Refused"])):
        return str(error)
    return f"{type(error).__name__}: {error}".splitlines()[0][:200]


def read(file, kind: str, most: int, parts: int) -> tuple[list[dict], list[str]]:
    """Read nodes with triangles, each with its name, its colour, its corners in its own frame, and its pose in the
    world; and say what was left out."""
    if kind == "3mf":
        return _THREEMF["read_3mf"](file, most, parts)
    if kind == "glb":
        return _GLB["read_glb"](file, most, parts)
    if kind == "obj":
        text = _OBJ["plain_faces"](file.read())
        if not re.search(rb"^o\s", text, re.M) and 1 < len(re.findall(rb"^g\s", text, re.M)) <= parts:
            nodes = scene_nodes(io.BytesIO(re.sub(rb"^g(?=\s)", b"o", text, flags=re.M)), kind, most, parts)
            if all(closed(node["corners"]) for node in nodes):
                return nodes, []  # the groups are solids, and not faces of one
        file = io.BytesIO(text)
    return scene_nodes(file, kind, most, parts), []


def scene_nodes(file, kind: str, most: int, parts: int) -> list[dict]:
    """Read the nodes with triangles of what trimesh makes of a file."""
    from trimesh import Trimesh, load_scene

    options: dict[str, dict[str, Any]] = {
        "obj": {"split_objects": True, "group_material": False, "skip_materials": True},
        "ply": {"skip_materials": True},
    }
    scene = load_scene(file, file_type=kind, process=False, **options.get(kind, {}))
    nodes, total = [], 0
    order = list(scene.geometry)
    if len(scene.graph.nodes_geometry) > parts:
        raise Refused(f"it holds more than {parts} parts")
    placed = [(name, *scene.graph[name]) for name in scene.graph.nodes_geometry]
    for name, pose, geometry in sorted(placed, key=lambda node: (order.index(node[2]), len(node[0]), node[0])):
        mesh = scene.geometry[geometry]
        if isinstance(mesh, Trimesh) and len(mesh.faces):
            total += len(mesh.faces)
            if total > most:
                raise Refused(f"it holds more than {most} triangles")
            if mesh.vertices.shape[1] != 3:
                raise Refused(f"its corners have {mesh.vertices.shape[1]} coordinates")
            if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices):
                raise Refused("its triangles name corners that are not there")
            placed = metres(mesh) @ pose
            nodes.append({"name": str(name), "color": color(mesh), "corners": mesh.triangles, "pose": placed})
    return nodes


def closed(corners: np.ndarray) -> bool:
    """Tell whether each edge of triangles (n, 3, 3) is passed as often in one direction as in the other."""
    numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 3)
    edges = np.concatenate([numbers[:, [0, 1]], numbers[:, [1, 2]], numbers[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    there, back = (np.sort(each[:, 0] * (numbers.max() + 1) + each[:, 1]) for each in (edges, edges[:, ::-1]))
    return bool(np.array_equal(there, back))


def metres(mesh) -> np.ndarray:
    """Make the (4, 4) scaling to metres of a mesh of COLLADA, the only format whose unit trimesh leaves in its corners,
    as "meters" or "0.01 * meters"; the identity for others."""
    said = mesh.metadata.get("units", "")
    factor = float(said.split()[0]) if said.endswith("* meters") else 1.0
    return np.diag([factor, factor, factor, 1.0])


def color(mesh) -> list[float] | None:
    """Find the one colour of a mesh, red, green, blue in 0..1 as the file has them, if it has one."""
    material = getattr(mesh.visual, "material", None)
    value = getattr(material, "baseColorFactor", None)
    return None if value is None else [float(c) / 255 for c in value[:3]]


if __name__ == "__main__":
    most, parts, folder, *sources = sys.argv[1:]
    main(int(most), int(parts), Path(folder), [Path(source) for source in sources])
