"""What cascadio returns for a STEP file: a binary glTF whose meshes name the analytic face of every triangle.

It is read here and not by trimesh because trimesh renames meshes and nodes that share a name. Lengths are metres.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, reduce
from hashlib import sha256
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import box_corners
from jaxkin.geometry.pose import Transform
from jaxkin.geometry.triangles import Triangles, double_areas
from jaxkin.io.gltf_colors import Color, from_gltf
from jaxkin.io.names import cleaned, unique
from jaxkin.io.step_placements import SINGLE, FilePlacements, Placement


@dataclass(frozen=True, eq=False)
class ProductMesh:
    """The triangles and faces of a product, which all its instances share, in a frame of its own."""

    triangles: Float[np.ndarray, "triangles 3 3"]
    """float32 in the file."""
    normals: Float[np.ndarray, "triangles 3 3"]
    """Of the true surface at the corners, outwards; float32 in the file."""
    face_of: Int[np.ndarray, "triangles"]
    """The index into `faces` of each triangle."""
    faces: tuple[dict[str, Any] | None, ...]
    """Analytic faces; None where the surface is none that cascadio names."""
    tessellated: bool = False
    """Whether the file has the solid as triangles only, as AP242 may: then no face is named, and normals are those of
    the triangles."""

    @cached_property
    def key(self) -> bytes:
        """What two meshes of one solid have in common."""
        content = sha256(repr(self.faces).encode())
        for array in (self.triangles, self.normals, self.face_of):
            content.update(array.tobytes())
        return content.digest()

    @cached_property
    def outline(self) -> Float[np.ndarray, "8 3"]:
        """Corners of the bounding box."""
        corners = self.triangles.reshape(-1, 3) if len(self.triangles) else np.zeros((1, 3))
        return box_corners(np.stack([corners.min(axis=0), corners.max(axis=0)]))


@dataclass(frozen=True, eq=False)
class Instance:
    """One placed mesh of the tree of instances."""

    names: tuple[str, str]
    """Of the instance and of the product; either may be empty or made up by a translator."""
    path: tuple[str, ...]
    """Names of the assemblies that the instance is in, below that of the whole file, outermost first."""
    places: tuple[Placement, ...]
    """Of the assemblies that the instance is in, and of itself, outermost first: rigid to float64."""
    mesh: ProductMesh
    color: Color | None
    complete: bool
    """False where triangles are missing: cascadio names the faces of the first colour of a mesh only."""

    @property
    def pose(self) -> Transform:
        """From the frame of the mesh to the world."""
        return reduce(np.matmul, (place.pose for place in self.places), np.eye(4))


def instances(
    glb: bytes, products: Mapping[str, str] | None = None, placements: FilePlacements | None = None
) -> Iterator[Instance]:
    """List all placed meshes that have triangles, in the order of the file.

    `products` are the names of sub-assemblies by what the reader calls them where they have none of their own;
    `placements` are those of the text of the file, which the reader rounds.
    """
    length = int.from_bytes(glb[12:16], "little")
    tree, binary = json.loads(glb[20 : 20 + length]), glb[28 + length :]
    roots = tree["scenes"][tree.get("scene", 0)].get("nodes", [])
    read: dict[str, ProductMesh] = {}  # by the arrays, which all instances of a product name
    todo: list[tuple[int, tuple[Placement, ...], tuple[str, ...], tuple[str, ...]]]
    todo = [(node, (), (), inner) for node, inner in reversed(_inside(tree, roots, (), products or {}))]
    if len(roots) == 1:  # the assembly of the file, whose name tells no part from another
        todo = [(roots[0], (), (), ())]
    while todo:
        index, above, path, inner = todo.pop()
        node = tree["nodes"][index]
        places = (*above, _placement(node, placements)) if "matrix" in node else above
        below = _inside(tree, node.get("children", []), inner, products or {})
        todo += [(child, places, inner, deeper) for child, deeper in reversed(below)]
        mesh: dict[str, Any] = tree["meshes"][node["mesh"]] if "mesh" in node else {"primitives": []}
        primitives = [primitive for primitive in mesh["primitives"] if primitive.get("mode", 4) == 4]
        if primitives:
            names = node.get("name", "").strip(), mesh.get("name", "").strip()
            arrays = repr([_arrays(primitive) for primitive in primitives])
            if arrays not in read:
                read[arrays] = _mesh(tree, binary, primitives)
            yield Instance(names, path, places, read[arrays], *_color(tree, primitives))


def _inside(
    tree: dict[str, Any], nodes: list[int], path: tuple[str, ...], products: Mapping[str, str]
) -> list[tuple[int, tuple[str, ...]]]:
    """Yield some nodes side by side, each with the path of what is in it: names that come again are numbered."""
    given = [tree["nodes"][node].get("name", "") for node in nodes]
    names = unique(cleaned(products.get(name, name)) or "assembly" for name in given)
    return [(node, (*path, name)) for node, name in zip(nodes, names, strict=True)]


def _placement(node: dict[str, Any], placements: FilePlacements | None) -> Placement:
    """Find the placement of a node in the text of the file, or else the nearest rigid one to the float32 numbers."""
    pose = np.array(node["matrix"], float).reshape(4, 4).T
    if placements and (full := placements.rounded_to(pose)) is not None:
        return Placement(full, 0.0)
    left, stretch, right = np.linalg.svd(pose[:3, :3])
    if np.abs(stretch - 1).max() > 1e-4 or np.linalg.det(left @ right) < 0:
        raise ValueError(
            f"the instance {node.get('name')!r} is scaled or mirrored in its assembly: export it as a part"
        )
    pose[:3, :3] = left @ right
    return Placement(pose, SINGLE)


def _mesh(tree: dict[str, Any], binary: bytes, primitives: list[dict[str, Any]]) -> ProductMesh:
    triangles, normals, face_of = [np.zeros((0, 3, 3))], [np.zeros((0, 3, 3))], [np.zeros(0, int)]
    faces: list[dict[str, Any] | None] = []
    exact = False
    for primitive in primitives:
        if described := _faces(primitive):
            rows = _array(tree, binary, primitive["indices"]).reshape(-1, 3)
            corners = _array(tree, binary, primitive["attributes"]["POSITION"]).astype(float)[rows]
            triangles.append(corners)
            exact = exact or "NORMAL" in primitive["attributes"]
            if "NORMAL" in primitive["attributes"]:
                normals.append(_array(tree, binary, primitive["attributes"]["NORMAL"]).astype(float)[rows])
            else:
                normals.append(_flat_normals(corners))
            face_of.append(_array(tree, binary, described["faceIndices"]).astype(int) + len(faces))
            faces += described["faces"]
    return ProductMesh(
        np.concatenate(triangles),
        np.concatenate(normals),
        np.concatenate(face_of),
        tuple(faces),
        tessellated=bool(faces) and not exact,
    )


def _flat_normals(corners: Triangles) -> Triangles:
    """Compute the normal of each triangle, at its three corners; zero for one without area."""
    across = double_areas(corners)
    lengths = np.linalg.norm(across, axis=-1, keepdims=True)
    return np.repeat((across / np.where(lengths > 0, lengths, 1.0))[:, None], 3, axis=1)


def _faces(primitive: dict[str, Any]) -> dict[str, Any]:
    """Find what cascadio says of the faces of the triangles of a primitive; empty where that is nothing."""
    return primitive.get("extensions", {}).get("TM_brep_faces", {})


def _arrays(primitive: dict[str, Any]) -> tuple[Any, ...]:
    """Find the numbers of the arrays of a primitive: instances of one product share them."""
    return primitive.get("attributes"), primitive.get("indices"), _faces(primitive).get("faceIndices")


def _array(tree: dict[str, Any], binary: bytes, index: int) -> np.ndarray:
    accessor = tree["accessors"][index]
    kind = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    start = tree["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    array = np.frombuffer(binary, kind, accessor["count"] * width, start)
    return array.reshape(-1, width) if width > 1 else array


def _color(tree: dict[str, Any], primitives: list[dict[str, Any]]) -> tuple[Color | None, bool]:
    """Find the colour of most triangles, and whether it is the only one."""
    counts: Counter[int | None] = Counter()
    for primitive in primitives:
        counts[primitive.get("material")] += tree["accessors"][primitive["indices"]]["count"]
    material = counts.most_common(1)[0][0]
    if material is None:
        return None, len(primitives) == 1
    color = from_gltf(tree["materials"][material]["pbrMetallicRoughness"]["baseColorFactor"])
    return color, len(primitives) == 1
