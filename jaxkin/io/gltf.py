"""A motion as an animation: glTF 2.0 in one binary file, for any viewer or renderer.

trimesh writes the meshes and materials; the nodes and the animation are written here.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import Part
from jaxkin.geometry.units import METRES
from jaxkin.io.gltf_colors import to_gltf
from jaxkin.view.drawing import FIXED_COLOR, drawn_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

DURATION = 6.0
"""Seconds that the whole range takes."""

KEYFRAMES = 360
"""At most so many: 60 a second, what a screen shows."""

_CREASE = np.radians(30.0)
"""Edges sharper than this are drawn sharp; facets of a round face meet at less."""

_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From z up, as in CAD, to y up, as in glTF."""

_FLOAT, _VERTICES, _INDICES = 5126, 34962, 34963
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}


def write_animation(motion: Motion, path: Path) -> None:
    """Write a motion as an animated binary glTF 2.0.

    One node a part, named as the part, under one root node that turns z up into y up and the unit into metres. The
    poses are evenly spaced in time; at most `KEYFRAMES` of them, evenly chosen, are written. A pose that is not closed
    is left out: the last closed one before it stays (at the start, the first one). If none is closed, nothing moves.
    """
    mechanism = motion.mechanism
    parts = drawn_parts(mechanism)
    centres = np.stack([part.box.mean(axis=0) for part in parts])
    middle = centres.mean(axis=0)
    tree, data = _unpack(_meshes(parts, centres))

    mesh_of = {node["name"]: node["mesh"] for node in tree["nodes"] if "mesh" in node}
    root = {"name": f"z up, {mechanism.unit or 'm'}", "matrix": _root_matrix(mechanism.unit, middle)}
    nodes = [root | {"children": list(range(1, len(parts) + 1))}]
    for index, part in enumerate(parts):
        mesh = mesh_of[str(index)]
        nodes.append({"name": part.name, "mesh": mesh, "translation": (centres[index] - middle).tolist()})
        _finish(tree, tree["meshes"][mesh]["primitives"][0], material=index)
    tree |= {"nodes": nodes, "scenes": [{"nodes": [0]}], "materials": [_material(part) for part in parts]}
    tree["asset"] = {"version": "2.0", "generator": "jaxkin with trimesh"}

    poses = keyframes(np.asarray(motion.on_branch))
    moving = [index for index, part in enumerate(parts) if part.name not in mechanism.fixed]
    if len(poses) and moving:
        clock = _append(tree, data, np.linspace(0.0, DURATION, len(poses))[:, None])
        channels, samplers = [], []
        for index in moving:
            transforms = np.asarray(motion.transforms[parts[index].name], float)[poses]
            places = transforms[:, :3, :3] @ centres[index] + transforms[:, :3, 3] - middle
            turns = quaternions(transforms[:, :3, :3])
            for target, values in (("translation", places), ("rotation", turns)):
                channels.append({"sampler": len(samplers), "target": {"node": index + 1, "path": target}})
                samplers.append({"input": clock, "output": _append(tree, data, values), "interpolation": "LINEAR"})
        tree["animations"] = [{"name": ", ".join(motion.inputs), "channels": channels, "samplers": samplers}]
    path.write_bytes(_pack(tree, data))


def keyframes(closed: np.ndarray) -> Int[np.ndarray, " keyframes"]:
    """Choose the pose that each keyframe shows: evenly spaced, each one that is not closed replaced by the last closed
    one."""
    if not closed.any():
        return np.array([], int)
    last_closed = np.maximum.accumulate(np.where(closed, np.arange(len(closed)), int(np.argmax(closed))))
    return last_closed[np.linspace(0, len(closed) - 1, min(len(closed), KEYFRAMES)).round().astype(int)]


def quaternions(rotations: Float[np.ndarray, "poses 3 3"]) -> Float[np.ndarray, "poses 4"]:
    """Compute unit quaternions (x, y, z, w), each in the hemisphere of the one before: between them lies the shorter
    turn."""
    from scipy.spatial.transform import Rotation

    turns = Rotation.from_matrix(rotations).as_quat()
    flips = np.sign((turns[1:] * turns[:-1]).sum(axis=-1))
    turns[1:] *= np.cumprod(np.where(flips == 0, 1, flips))[:, None]
    return turns


def _meshes(parts: Sequence[Part], centres: Float[np.ndarray, "parts 3"]) -> bytes:
    """Write a binary glTF of the parts, each about its own centre: float32 is finer there than far from the origin."""
    from trimesh import Scene, Trimesh
    from trimesh.exchange.gltf import export_glb
    from trimesh.graph import smooth_shade
    from trimesh.triangles import to_kwargs

    scene = Scene()
    for index, (part, centre) in enumerate(zip(parts, centres, strict=True)):
        size = np.ptp(part.box, axis=0).max()  # trimesh takes corners for the same that are 1e-8 apart, in any unit
        mesh = Trimesh(**to_kwargs((part.triangles - centre) / size))
        mesh.update_faces(mesh.nondegenerate_faces())
        mesh = smooth_shade(mesh, angle=_CREASE, facet_minarea=None).apply_scale(size)
        scene.add_geometry(mesh, node_name=str(index), geom_name=part.name)
    return export_glb(scene, include_normals=True)


def _finish(tree: dict[str, Any], primitive: dict[str, Any], material: int) -> None:
    """Give the mesh its material, and say what its arrays are for, which trimesh leaves open."""
    primitive["material"] = material
    uses = [(accessor, _VERTICES) for accessor in primitive["attributes"].values()]
    for accessor, target in [*uses, (primitive["indices"], _INDICES)]:
        tree["bufferViews"][tree["accessors"][accessor]["bufferView"]]["target"] = target


def _material(part: Part) -> dict[str, Any]:
    """Make a material: slightly shiny; seen from both sides, since a mesh may be wound the wrong way."""
    surface = {"baseColorFactor": to_gltf(part.color or FIXED_COLOR), "metallicFactor": 0.1, "roughnessFactor": 0.6}
    return {"name": part.name, "pbrMetallicRoughness": surface, "doubleSided": True}


def _root_matrix(unit: str, middle: Float[np.ndarray, "3"]) -> list[float]:
    """Move the middle of the mechanism, which the nodes count from, to its place; turn z up; go to metres."""
    root = np.eye(4)
    root[:3, :3] = _UP * METRES[unit]
    root[:3, 3] = root[:3, :3] @ middle
    return root.T.ravel().tolist()  # glTF goes down the columns


def _append(tree: dict[str, Any], data: bytearray, values: Float[np.ndarray, "keyframes k"]) -> int:
    """Add an array of scalars, 3-vectors or 4-vectors to the file; the index of its accessor."""
    values = values.astype("<f4")
    tree["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes})
    accessor = {"bufferView": len(tree["bufferViews"]) - 1, "componentType": _FLOAT, "count": len(values)}
    bounds = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
    tree["accessors"].append(accessor | {"type": _TYPES[values.shape[1]]} | bounds)
    data += values.tobytes()
    return len(tree["accessors"]) - 1


def _unpack(glb: bytes) -> tuple[dict[str, Any], bytearray]:
    """Read the JSON and the binary chunk of a binary glTF that holds one of each."""
    (length,) = struct.unpack_from("<I", glb, 12)
    return json.loads(glb[20 : 20 + length]), bytearray(glb[28 + length :])


def _pack(tree: dict[str, Any], data: bytearray) -> bytes:
    tree["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
