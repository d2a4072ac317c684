"""Reads the triangles of binary glTF 2.0 where its scene puts them; for the program of `mesh_worker.py`.

It imports nothing of jaxkin. Extensions of looks change no triangle; of the others those are read that change numbers
(KHR_mesh_quantization) and places (EXT_mesh_gpu_instancing), and files that need another one are refused.
"""

import base64
import json
import struct
from typing import Any

import numpy as np

DEEPEST = 100
"""Nodes that hold each other: more of them go round in a circle."""

NUMBERS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""Component types of accessors."""

COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
"""Numbers of each element of an accessor; matrices are none of a mesh."""

TRIANGLES, STRIP, FAN = 4, 5, 6
"""Modes of primitives that are triangles; others are points and lines."""

INSTANCES = "EXT_mesh_gpu_instancing"

READ = ("KHR_mesh_quantization", INSTANCES, "KHR_texture", "KHR_materials", "KHR_lights", "EXT_texture", "KHR_xmp")
"""Beginnings of the names of extensions that files may need: those that are read, and those of looks."""


class Refused(Exception):
    """What is no scene of triangles, or too much of one."""


def read_glb(file, most: int, parts: int) -> tuple[list[dict], list[str]]:
    """Read the nodes with triangles; the list of what was left out is empty.

    A node has its name, its colour (linear red, green and blue), its corners (triangles, 3, 3), and their pose in the
    world (4, 4). Raises Refused for more than `most` triangles or `parts` nodes, and for data that are packed by an
    extension or in another file.
    """
    scene = Scene(file.read())
    nodes, total = [], 0
    top = scene.tree.get("scenes", [{}])[scene.tree.get("scene", 0)].get("nodes", [])
    todo = [(scene.tree["nodes"][number], np.eye(4), 0) for number in top[::-1]]
    while todo:
        node, above, depth = todo.pop()
        if depth > DEEPEST:
            raise RecursionError
        pose = above @ pose_of(node)
        todo += [(scene.tree["nodes"][number], pose, depth + 1) for number in node.get("children", [])[::-1]]
        if "mesh" in node:
            mesh = scene.tree["meshes"][node["mesh"]]
            corners, color = scene.triangles(node["mesh"], most)
            for own in scene.instances(node) if len(corners) else ():
                total += len(corners)
                name = str(node.get("name") or mesh.get("name") or "")
                nodes.append({"name": name, "color": color, "corners": corners, "pose": pose @ own})
                if total > most:
                    raise Refused(f"it holds more than {most} triangles")
        if len(nodes) + len(todo) > parts:
            raise Refused(f"it holds more than {parts} parts")
    return nodes, []


class Scene:
    """The JSON of a file, and its data."""

    def __init__(self, data: bytes) -> None:
        version, length, kind = struct.unpack_from("<I4xI4s", data, 4)
        if version != 2 or kind != b"JSON":
            raise Refused(f"it is of version {version} of the format, and not of version 2")
        self.tree: dict[str, Any] = json.loads(data[20 : 20 + length])
        self.chunk = data[28 + length :]
        self.made: dict[int, tuple[np.ndarray, list[float] | None]] = {}
        for name in self.tree.get("extensionsRequired", []):
            if not name.startswith(READ):
                raise Refused(f"it is packed by the extension {name}, which is not read: export it without compression")

    def triangles(self, number: int, most: int) -> tuple[np.ndarray, list[float] | None]:
        """Find the triangles (n, 3, 3) of all primitives of a mesh, and their colour where they have one."""
        if number not in self.made:
            found, colors = [np.empty((0, 3, 3))], []
            for one in self.tree["meshes"][number]["primitives"]:
                mode = one.get("mode", TRIANGLES)
                if mode not in (TRIANGLES, STRIP, FAN):
                    continue
                points = self.array(one["attributes"]["POSITION"])
                if points.shape[1] != 3:
                    raise Refused(f"its corners have {points.shape[1]} coordinates")
                order = self.array(one["indices"])[:, 0].astype(int) if "indices" in one else np.arange(len(points))
                rows = in_threes(order, mode)
                if len(rows) and rows.max() >= len(points):
                    raise Refused("its triangles name corners that are not there")
                found.append(points[rows])
                colors.append(self.color(one))
                if sum(map(len, found)) > most:
                    raise Refused(f"it holds more than {most} triangles")
            same = bool(colors) and all(color == colors[0] for color in colors)
            self.made[number] = np.concatenate(found), colors[0] if same else None
        return self.made[number]

    def color(self, primitive: dict[str, Any]) -> list[float] | None:
        """Find the colour of the material of a primitive."""
        if "material" not in primitive:
            return None
        looks = self.tree["materials"][primitive["material"]].get("pbrMetallicRoughness", {})
        return [float(part) for part in looks["baseColorFactor"][:3]] if "baseColorFactor" in looks else None

    def instances(self, node: dict[str, Any]) -> list[np.ndarray]:
        """Find the poses (4, 4) of the mesh of a node in the node: one, unless it is there several times."""
        said = node.get("extensions", {}).get(INSTANCES, {}).get("attributes", {})
        given = {name.lower(): self.array(number) for name, number in said.items() if name.isupper()}
        given = {name: values for name, values in given.items() if name in ("translation", "rotation", "scale")}
        count = min(map(len, given.values()), default=1)
        return [pose_of({name: values[k] for name, values in given.items()}) for k in range(count)]

    def array(self, number: int) -> np.ndarray:
        """Read an accessor as numbers (elements, components), with what replaces some of them."""
        said = self.tree["accessors"][number]
        width, count = COUNTS[said["type"]], said["count"]
        dtype = np.dtype(NUMBERS[said["componentType"]])
        if "bufferView" in said:
            found = self.view(said["bufferView"], said.get("byteOffset", 0), dtype, count, width).astype(float)
        else:
            if "sparse" not in said:
                raise Refused("corners of it have no data")
            if count > len(self.chunk):  # of zeros, which no data bound
                raise Refused("it announces more corners than it has data")
            found = np.zeros((count, width))
        if sparse := said.get("sparse"):
            where, what, few = sparse["indices"], sparse["values"], sparse["count"]
            numbers = np.dtype(NUMBERS[where["componentType"]])
            rows = self.view(where["bufferView"], where.get("byteOffset", 0), numbers, few, 1)[:, 0].astype(int)
            found[rows] = self.view(what["bufferView"], what.get("byteOffset", 0), dtype, few, width)
        if said.get("normalized"):
            found = np.maximum(found / np.iinfo(dtype).max, -1.0)
        return found

    def view(self, number: int, offset: int, dtype: np.dtype, count: int, width: int) -> np.ndarray:
        """Read numbers (count, width) of a buffer view."""
        said = self.tree["bufferViews"][number]
        data, start = self.buffer(said["buffer"]), said.get("byteOffset", 0)
        data = data[start : start + said["byteLength"]]
        size = dtype.itemsize * width
        step = said.get("byteStride", size)
        if offset < 0 or step < size or count < 1 or offset + step * (count - 1) + size > len(data):
            raise Refused("its data end before the corners that it announces")
        return np.ndarray((count, width), dtype, data, offset, (step, dtype.itemsize))

    def buffer(self, number: int) -> bytes:
        uri = self.tree["buffers"][number].get("uri")
        if uri is None:
            return self.chunk
        if not uri.startswith("data:"):
            raise Refused(f"its corners are in another file, {uri[:100]!r}: export all of it in one file")
        return base64.b64decode(uri.partition(",")[2])


def in_threes(order: np.ndarray, mode: int) -> np.ndarray:
    """Make triangles (n, 3) of the corners of a primitive."""
    if mode == TRIANGLES:
        return order[: len(order) // 3 * 3].reshape(-1, 3)
    if mode == FAN:
        return np.stack([order[1:-1], order[2:], np.full(max(len(order) - 2, 0), order[0])], axis=1)
    rows = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
    rows[1::2] = rows[1::2, [1, 0, 2]]  # every other one is wound the other way round
    return rows


def pose_of(said: dict[str, Any]) -> np.ndarray:
    """Make the pose (4, 4) of a matrix, down its columns, or of a translation, a quaternion (x, y, z, w) and scales."""
    if "matrix" in said:
        return np.array(said["matrix"], float).reshape(4, 4).T
    x, y, z, w = np.array(said.get("rotation", (0, 0, 0, 1)), float) / np.linalg.norm(said.get("rotation", 1.0))
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ] * np.array(said.get("scale", (1, 1, 1)), float)
    pose[:3, 3] = said.get("translation", (0, 0, 0))
    return pose
