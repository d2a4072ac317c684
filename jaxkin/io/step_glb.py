"""What cascadio returns for a STEP file: a binary glTF whose meshes name the analytic face of every triangle.

It is read here and not by trimesh because trimesh renames meshes and nodes that share a name. Lengths are metres.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.pose import Pose


@dataclass(frozen=True, eq=False)
class Instance:
    """One placed mesh of the tree of instances."""

    names: tuple[str, ...]
    """Candidates for its name, the best first: of the instance, of the product."""
    pose: Pose
    """From the frame of the mesh to the world; float32 made exact to a rotation again."""
    triangles: Float[np.ndarray, "triangles 3 3"]
    """In the frame of the mesh; float32 in the file."""
    face_of: Int[np.ndarray, "triangles"]
    """The index into `faces` of each triangle."""
    faces: tuple[dict[str, Any] | None, ...]
    """Analytic faces in the frame of the mesh; None where the surface is none that cascadio names."""
    color: tuple[float, float, float] | None


def instances(glb: bytes) -> Iterator[Instance]:
    """All placed meshes, in the order of the file."""
    length = int.from_bytes(glb[12:16], "little")
    tree = json.loads(glb[20 : 20 + length])
    binary = glb[28 + length :]
    todo = [(node, np.eye(4)) for node in reversed(tree["scenes"][tree.get("scene", 0)].get("nodes", []))]
    while todo:
        index, above = todo.pop()
        node = tree["nodes"][index]
        pose = above @ _rigid(node)
        todo += [(child, pose) for child in reversed(node.get("children", []))]
        if "mesh" in node:
            mesh = tree["meshes"][node["mesh"]]
            names = node.get("name", ""), mesh.get("name", "")
            yield Instance(names, pose, *_triangles(tree, binary, mesh), _color(tree, mesh))


def _rigid(node: dict[str, Any]) -> Pose:
    """The nearest rigid pose to the float32 placement of a node."""
    pose = np.array(node.get("matrix", np.eye(4).ravel()), float).reshape(4, 4).T
    left, stretch, right = np.linalg.svd(pose[:3, :3])
    if abs(stretch - 1).max() > 1e-4 or np.linalg.det(pose[:3, :3]) < 0:
        raise ValueError(
            f"the instance {node.get('name')!r} is scaled or mirrored: only rigid placements are supported"
        )
    pose[:3, :3] = left @ right
    return pose


def _triangles(tree: dict[str, Any], binary: bytes, mesh: dict[str, Any]) -> tuple[Any, Any, Any]:
    triangles, face_of, faces = [np.zeros((0, 3, 3))], [np.zeros(0, int)], []
    for primitive in mesh["primitives"]:
        described = primitive.get("extensions", {}).get("TM_brep_faces")
        if described is None:
            continue  # curves and points
        corners = _array(tree, binary, primitive["attributes"]["POSITION"]).astype(float)
        triangles.append(corners[_array(tree, binary, primitive["indices"]).reshape(-1, 3)])
        face_of.append(_array(tree, binary, described["faceIndices"]).astype(int) + len(faces))
        faces += described["faces"]
    return np.concatenate(triangles), np.concatenate(face_of), tuple(faces)


def _array(tree: dict[str, Any], binary: bytes, index: int) -> np.ndarray:
    accessor = tree["accessors"][index]
    kind = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    start = tree["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    array = np.frombuffer(binary, kind, accessor["count"] * width, start)
    return array.reshape(-1, width) if width > 1 else array


def _color(tree: dict[str, Any], mesh: dict[str, Any]) -> tuple[float, float, float] | None:
    """The colour of the first primitive, from the linear light of glTF to the usual sRGB."""
    material = mesh["primitives"][0].get("material") if mesh["primitives"] else None
    if material is None:
        return None
    linear = np.array(tree["materials"][material].get("pbrMetallicRoughness", {}).get("baseColorFactor", [1, 1, 1]))[:3]
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0) ** (1 / 2.4) - 0.055)
    red, green, blue = np.clip(srgb, 0, 1).round(4).tolist()
    return red, green, blue
