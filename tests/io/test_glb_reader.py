"""Binary glTF as exporters and packers write it: several primitives, strips, packed numbers, instances, nests."""

import json
import struct

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from jaxkin.io.load import load

BOX = trimesh.creation.box((1.0, 2.0, 3.0))
FLOAT, SHORT, BYTES, INTEGER = 5126, 5122, 5123, 5125


class File:
    """A file of one scene: arrays are put into its data, and the rest is written as it is."""

    def __init__(self):
        self.data = b""
        self.tree = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "meshes": [], "nodes": []}

    def view(self, array, **more):
        self.data += bytes(-len(self.data) % 4)
        at = {"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes}
        self.data += array.tobytes()
        self.tree["bufferViews"].append(at | more)
        return len(self.tree["bufferViews"]) - 1

    def array(self, array, component, kind, stride=None, **more):
        view = self.view(array, **({} if stride is None else {"byteStride": stride}))
        said = {"bufferView": view, "componentType": component, "count": len(array), "type": kind}
        self.tree["accessors"].append(said | more)
        return len(self.tree["accessors"]) - 1

    def triangles(self, corners, faces, **more):
        points = self.array(np.asarray(corners, "<f4"), FLOAT, "VEC3")
        order = self.array(np.asarray(faces, "<u4").reshape(-1), INTEGER, "SCALAR")
        return {"attributes": {"POSITION": points}, "indices": order} | more

    def read(self, folder, *primitives, **node):
        """Load the file; with primitives it is one node of these."""
        if primitives:
            self.tree["meshes"].append({"primitives": list(primitives)})
            self.tree["nodes"].append({"mesh": len(self.tree["meshes"]) - 1} | node)
        tree = {"scene": 0, "scenes": [{"nodes": [0]}]} | self.tree | {"buffers": [{"byteLength": len(self.data)}]}
        text = json.dumps(tree).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + bytes(-len(self.data) % 4)
        body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        (folder / "box.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
        return load(folder / "box.glb")


def is_box(assembly, count=12):
    (part,) = assembly.parts
    assert len(part.triangles) == count and len(part.faces) == 6
    np.testing.assert_allclose(part.box, BOX.bounds, atol=2e-4)  # 16 bits of an edge where numbers are packed
    assert np.linalg.det(part.triangles).sum() / 6 == pytest.approx(6.0, rel=1e-3)


def test_a_mesh_may_have_several_primitives_with_lines_beside_them(tmp_path):
    """One for each material, with none for some; lines are no triangles."""
    file = File()
    file.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]
    sides = [file.triangles(BOX.vertices, BOX.faces[:5], material=0), file.triangles(BOX.vertices, BOX.faces[5:])]
    is_box(file.read(tmp_path, *sides, file.triangles(BOX.vertices, [0, 1, 1, 2], mode=1)))


def test_strips_and_fans_are_wound_as_the_format_says(tmp_path):
    file = File()
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-1, 1) for z in (-1.5, 1.5)])
    fan = file.triangles(corners, [0, 4, 5, 1, 3, 2, 6, 4], mode=6)  # the three sides at one corner
    strip = file.triangles(corners, [5, 4, 7, 6, 3, 2], mode=5)  # two sides; the sixth is triangles
    rest = file.triangles(corners, [[5, 7, 3], [5, 3, 1]])
    is_box(file.read(tmp_path, fan, strip, rest))


def test_numbers_packed_into_sixteen_bits_are_those_that_they_stand_for(tmp_path):
    """They were taken as they are stored: a part 32767 times as large, without a word."""
    file = File()
    rows = np.zeros((8, 4), "<i2")  # each padded to a multiple of four bytes
    rows[:, :3] = np.round((BOX.vertices / BOX.bounds[1]) * 32767)
    points = file.array(rows, SHORT, "VEC3", stride=8, normalized=True)
    order = file.array(BOX.faces.reshape(-1).astype("<u2"), BYTES, "SCALAR")
    file.tree["extensionsRequired"] = ["KHR_mesh_quantization"]
    is_box(file.read(tmp_path, {"attributes": {"POSITION": points}, "indices": order}, scale=BOX.bounds[1].tolist()))


def test_corners_that_are_replaced_are_where_they_are_replaced_to(tmp_path):
    file = File()
    own = file.triangles(np.where(np.arange(8)[:, None] == 3, 0.0, BOX.vertices), BOX.faces)
    file.tree["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": file.view(np.array([3], "<u2")), "componentType": BYTES},
        "values": {"bufferView": file.view(BOX.vertices[3].astype("<f4"))},
    }
    is_box(file.read(tmp_path, own))


def test_instances_of_a_node_are_parts(tmp_path):
    file = File()
    places = np.array([[0, 0, 0], [5, 0, 0], [0, 7, 0]], "<f4")
    at = {"attributes": {"TRANSLATION": file.array(places, FLOAT, "VEC3")}}
    file.tree["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    box = file.triangles(BOX.vertices, BOX.faces)
    parts = file.read(tmp_path, box, name="bolt", extensions={"EXT_mesh_gpu_instancing": at}).parts
    assert [part.name for part in parts] == ["bolt", "bolt#2", "bolt#3"]
    np.testing.assert_allclose([part.box.mean(axis=0) for part in parts], places, atol=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_nodes_stand_where_those_around_them_put_them(tmp_path, seed):
    """Matrices, and turns, scales and mirrors apart, one in the other."""
    rng = np.random.default_rng(seed)
    file, whole = File(), np.eye(4)
    for depth in range(4):
        turn, scale, place = (
            Rotation.from_quat(rng.normal(size=4)),
            rng.uniform(0.5, 2, 3) * [1, 1, -1],
            rng.normal(size=3),
        )
        own = np.eye(4)
        own[:3, :3], own[:3, 3] = turn.as_matrix() * scale, place
        whole = whole @ own
        apart = {"rotation": turn.as_quat().tolist(), "scale": scale.tolist(), "translation": place.tolist()}
        node = apart if rng.random() < 0.5 else {"matrix": own.T.ravel().tolist()}
        file.tree["nodes"].append(node | ({"children": [depth + 1]} if depth < 3 else {"mesh": 0, "name": "box"}))
    file.tree["meshes"].append({"primitives": [file.triangles(BOX.vertices, BOX.faces)]})
    (part,) = file.read(tmp_path).parts
    expected = BOX.vertices @ whole[:3, :3].T + whole[:3, 3]
    found = np.unique(part.triangles.reshape(-1, 3).round(5), axis=0)
    np.testing.assert_allclose(found, np.unique(expected.round(5), axis=0), atol=1e-4)
    assert np.linalg.det(part.triangles).sum() / 6 == pytest.approx(6 * abs(np.linalg.det(whole[:3, :3])), rel=1e-5)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"extensionsRequired": ["KHR_draco_mesh_compression"]},
            "KHR_draco_mesh_compression, which is not read: export",
        ),
        ({"bufferViews": [{"buffer": 0, "byteLength": 12}] * 2}, "its data end before the corners that it announces"),
        ({"accessors": [{"componentType": FLOAT, "count": 8, "type": "VEC3"}] * 2}, "corners of it have no data"),
    ],
)
def test_data_that_are_not_there_are_told_as_such(tmp_path, change, said):
    file = File()
    box = file.triangles(BOX.vertices, BOX.faces)
    file.tree |= change
    with pytest.raises(ValueError, match=rf"^box\.glb cannot be read as GLB: .*{said}"):
        file.read(tmp_path, box)
