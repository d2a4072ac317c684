import json
import struct
from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.io.gltf import DURATION, KEYFRAMES, keyframes, quaternions
from jaxkin.view.drawing import FIXED_COLOR, PALETTE, drawn_parts

EPS32 = float(np.finfo(np.float32).eps)
COMPONENTS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
IDENTITY = np.eye(4)
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def _robot(unit="mm", scale=1.0, pose=IDENTITY):
    """Two links, 100 and 60 long, on axes at right angles, placed anywhere: no loops, so nothing to solve."""

    def place(x, y, z):
        return pose[:3, :3] @ (scale * np.array([x, y, z])) + pose[:3, 3]

    return jk.Mechanism.build(
        fixed=["ground"],
        unit=unit,
        joints=[
            jk.revolute("base", "ground", "upper", point=place(0, 0, 0), axis=pose[:3, 2]),
            jk.revolute("elbow", "upper", "lower", point=place(100, 0, 0), axis=pose[:3, 1]),
            jk.prismatic("wrist", "lower", "tool", point=place(100, 0, 60), axis=pose[:3, 0]),
        ],
    )


def _sweep(mechanism, turns=1.0, poses=73, scale=1.0):
    part = jnp.linspace(0.0, 1.0, poses)
    return mechanism.sweep({"base": 2 * np.pi * turns * part, "elbow": 9.0 * part**2, "wrist": scale * 30.0 * part})


class Animation:
    """A binary glTF, read by its specification."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON" and size % 4 == 0
        self.tree = json.loads(data[20 : 20 + size])
        binary, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0" and binary % 4 == 0
        self.binary = data[28 + size :]
        assert len(self.binary) == binary
        self.nodes = self.tree["nodes"]
        self.channels = self.tree["animations"][0]["channels"] if "animations" in self.tree else []
        self.samplers = self.tree["animations"][0]["samplers"] if "animations" in self.tree else []

    def array(self, accessor):
        accessor = self.tree["accessors"][accessor]
        view = self.tree["bufferViews"][accessor["bufferView"]]
        start, dtype = (
            view["byteOffset"] + accessor.get("byteOffset", 0),
            np.dtype(COMPONENTS[accessor["componentType"]]),
        )
        count = accessor["count"] * WIDTHS[accessor["type"]]
        assert start % 4 == 0 and count * dtype.itemsize <= view["byteLength"]
        assert view["byteOffset"] + view["byteLength"] <= len(self.binary) == self.tree["buffers"][0]["byteLength"]
        return np.frombuffer(self.binary, dtype, count, start).reshape(accessor["count"], -1)

    @property
    def times(self):
        return self.array(self.samplers[0]["input"])[:, 0]

    @property
    def root(self):
        return np.array(self.nodes[0]["matrix"]).reshape(4, 4).T

    def node(self, name):
        (index,) = (index for index, node in enumerate(self.nodes) if node["name"] == name)
        return index

    def corners(self, name):
        """Vertices of a part about its own node."""
        primitive = self.tree["meshes"][self.nodes[self.node(name)]["mesh"]]["primitives"][0]
        return self.array(primitive["attributes"]["POSITION"]).astype(float)

    def track(self, name, path):
        (channel,) = (c for c in self.channels if c["target"] == {"node": self.node(name), "path": path})
        return self.array(self.samplers[channel["sampler"]]["output"]).astype(float)

    def played(self, name):
        """World coordinates of the vertices of a part at every keyframe, in metres, y up."""
        turned = np.einsum(
            "kij,vj->kvi", Rotation.from_quat(self.track(name, "rotation")).as_matrix(), self.corners(name)
        )
        return self.world(turned + self.track(name, "translation")[:, None])

    def rest(self, name):
        return self.world(self.corners(name) + np.array(self.nodes[self.node(name)]["translation"]))

    def world(self, points):
        return points @ self.root[:3, :3].T + self.root[:3, 3]


def _upright(points, metres):
    """From z up in a unit of so many metres to y up in metres."""
    x, y, z = np.moveaxis(np.asarray(points), -1, 0)
    return metres * np.stack([x, z, -y], axis=-1)


@pytest.fixture(scope="module")
def motion():
    return _sweep(_robot())


@pytest.fixture(scope="module")
def animation(motion, tmp_path_factory):
    (path,) = motion.save(tmp_path_factory.mktemp("gltf"), only="motion.glb")
    return Animation(path)


def test_one_node_a_part_under_one_root(animation):
    assert animation.tree["scenes"][animation.tree["scene"]]["nodes"] == [0]
    assert animation.nodes[0]["children"] == [1, 2, 3, 4] and "mesh" not in animation.nodes[0]
    assert [node["name"] for node in animation.nodes[1:]] == ["ground", "upper", "lower", "tool"]
    assert sorted(node["mesh"] for node in animation.nodes[1:]) == [0, 1, 2, 3]
    assert "mm" in animation.nodes[0]["name"]


def test_z_up_in_millimetres_becomes_y_up_in_metres(animation):
    unit_vectors = animation.world(np.eye(3)) - animation.world(np.zeros(3))
    assert np.allclose(unit_vectors, [[1e-3, 0, 0], [0, 0, -1e-3], [0, 1e-3, 0]], rtol=1e-12, atol=1e-18)


def test_accessors_and_views_are_as_the_specification_asks(animation):
    for index, accessor in enumerate(animation.tree["accessors"]):
        values = animation.array(index)
        if "min" in accessor:
            assert values.min(axis=0).tolist() == accessor["min"] and values.max(axis=0).tolist() == accessor["max"]
    for mesh in animation.tree["meshes"]:
        (primitive,) = mesh["primitives"]
        position, normal = (animation.array(primitive["attributes"][key]) for key in ("POSITION", "NORMAL"))
        indices = animation.array(primitive["indices"])
        assert position.shape == normal.shape and indices.max() == len(position) - 1 and len(indices) % 3 == 0
        assert np.allclose(np.linalg.norm(normal, axis=-1), 1.0, atol=4 * EPS32)
        assert "min" in animation.tree["accessors"][primitive["attributes"]["POSITION"]]
        uses = [(primitive["indices"], 34963), *((accessor, 34962) for accessor in primitive["attributes"].values())]
        for accessor, target in uses:
            assert (
                animation.tree["bufferViews"][animation.tree["accessors"][accessor]["bufferView"]]["target"] == target
            )


def test_channels_move_every_part_but_the_fixed_one(animation):
    targets = {(channel["target"]["node"], channel["target"]["path"]) for channel in animation.channels}
    assert targets == {(node, path) for node in (2, 3, 4) for path in ("translation", "rotation")}
    assert len(targets) == len(animation.channels) == len(animation.samplers)
    for sampler in animation.samplers:
        clock, output = animation.tree["accessors"][sampler["input"]], animation.tree["accessors"][sampler["output"]]
        assert clock["count"] == output["count"] == 73 and sampler["interpolation"] == "LINEAR"
        assert "min" in clock and "max" in clock
    assert animation.times[0] == 0.0 and animation.times[-1] == DURATION and np.all(np.diff(animation.times) > 0)


def test_played_back_the_keyframes_are_the_motion(animation, motion):
    """Float32 in vertices, translations and quaternions: some roundings at the size of the mechanism, 0.2 m."""
    for name in ("upper", "lower", "tool"):
        assembled = animation.rest(name) @ [[1e3, 0, 0], [0, 0, 1e3], [0, -1e3, 0]]
        transforms = np.asarray(motion.transforms[name])
        expected = np.einsum("kij,vj->kvi", transforms[:, :3, :3], assembled) + transforms[:, None, :3, 3]
        assert np.abs(animation.played(name) - _upright(expected, 1e-3)).max() < 4 * EPS32 * 0.2
        assert np.ptp(animation.played(name), axis=0).max() > 0.03


def test_quaternions_are_of_unit_length_and_take_the_shorter_way(animation):
    for name in ("upper", "lower", "tool"):
        turns = animation.track(name, "rotation")
        assert np.allclose(np.linalg.norm(turns, axis=-1), 1.0, atol=2 * EPS32)
        assert np.all((turns[1:] * turns[:-1]).sum(axis=-1) > 0.9)


def test_rest_pose_is_the_assembled_one_of_the_drawn_parts(animation, motion):
    for part in drawn_parts(motion.mechanism):
        rest = animation.rest(part.name)
        corners = _upright(part.triangles.reshape(-1, 3), 1e-3)
        assert np.allclose(rest.min(axis=0), corners.min(axis=0), rtol=0, atol=4 * EPS32 * 0.2)
        assert np.allclose(rest.max(axis=0), corners.max(axis=0), rtol=0, atol=4 * EPS32 * 0.2)


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("m", 1.0), ("in", 0.0254), ("", 1.0)])
@pytest.mark.parametrize("scale", [1e-6, 1e4])
def test_any_unit_and_place_keep_their_accuracy(unit, metres, scale, tmp_path):
    """A thousand sizes from the origin in a slanted plane: coordinates as such would lose three digits in float32."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    pose[:3, 3] = scale * np.array([1e5, -8e4, 6e4])
    motion = _sweep(_robot(unit, scale, pose), poses=7, scale=scale)
    (path,) = motion.save(tmp_path, only="motion.glb")
    animation = Animation(path)
    for part in drawn_parts(motion.mechanism)[1:]:
        transforms = np.asarray(motion.transforms[part.name])
        corners = part.triangles.reshape(-1, 3)
        moved = np.einsum("kij,vj->kvi", transforms[:, :3, :3], corners) + transforms[:, None, :3, 3]
        expected, played = _upright(moved, metres), animation.played(part.name)
        for bound in (np.min, np.max):  # vertices were merged and reordered: compare the boxes
            assert np.abs(bound(expected, axis=1) - bound(played, axis=1)).max() < 4 * EPS32 * 200 * scale * metres


def test_poses_that_do_not_close_are_left_out(motion, tmp_path):
    codes = np.full(73, jk.Status.CLOSED.value)
    codes[:4], codes[20:30], codes[70:] = jk.Status.STALLED.value, jk.Status.UNREACHABLE.value, jk.Status.JUMPED.value
    (path,) = replace(motion, status=jnp.array(codes)).save(tmp_path, only="motion.glb")
    turns = Animation(path).track("upper", "rotation")
    shown = np.concatenate([np.full(4, 4), np.arange(4, 20), np.full(10, 19), np.arange(30, 70), np.full(3, 69)])
    assert np.allclose(np.unwrap(2 * np.arctan2(turns[:, 2], turns[:, 3])), 2 * np.pi * shown / 72, atol=1e-6)


def test_where_nothing_closes_nothing_moves(motion, tmp_path):
    lost = replace(motion, status=jnp.full(len(motion), jk.Status.UNREACHABLE.value))
    (path,) = lost.save(tmp_path, only="motion.glb")
    animation = Animation(path)
    assert "animations" not in animation.tree and len(animation.nodes) == 5


def test_long_ranges_are_thinned_out_evenly(tmp_path):
    motion = _sweep(_robot(), turns=3.0, poses=5001)
    (path,) = motion.save(tmp_path, only="motion.glb")
    animation = Animation(path)
    turns = animation.track("upper", "rotation")
    angles = np.unwrap(2 * np.arctan2(turns[:, 2], turns[:, 3]))
    assert len(turns) == KEYFRAMES and animation.times[-1] == DURATION
    # rounding to a pose moves a keyframe by half a step at most; float32 adds 1e-6
    assert np.abs(angles - np.linspace(0.0, 6 * np.pi, KEYFRAMES)).max() < 3 * np.pi / 5000 + 1e-6


@given(st.lists(st.booleans(), min_size=1, max_size=1000))
def test_keyframes_show_closed_poses_only(closed):
    closed = np.array(closed)
    chosen = keyframes(closed)
    if not closed.any():
        assert len(chosen) == 0
        return
    assert len(chosen) == min(len(closed), KEYFRAMES)
    assert closed[chosen].all() and np.all(np.diff(chosen) >= 0)
    assert chosen[0] == np.argmax(closed) and chosen[-1] == np.flatnonzero(closed)[-1]
    if len(closed) <= KEYFRAMES:
        assert np.array_equal(chosen[closed], np.flatnonzero(closed))


@given(st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=50), st.integers(0, 2**32 - 1))
def test_quaternions_do_not_jump(steps, seed):
    """Turns by less than half a turn from one pose to the next: the rotation is kept, the way is the shorter."""
    axes = np.random.default_rng(seed).normal(size=(len(steps), 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    rotations = [Rotation.identity()]
    for axis, step in zip(axes, steps, strict=True):
        rotations.append(Rotation.from_rotvec(axis * step) * rotations[-1])
    matrices = np.stack([rotation.as_matrix() for rotation in rotations])
    turns = quaternions(matrices)
    assert np.allclose(Rotation.from_quat(turns).as_matrix(), matrices, atol=1e-14)
    # cos(1.5) = 0.07 is the smallest that a step of 3 rad can give
    assert np.all((turns[1:] * turns[:-1]).sum(axis=-1) > 0.07)


def test_colours_are_those_of_the_screen(motion, animation):
    grey, blue = (animation.tree["materials"][index] for index in (0, 1))
    assert (grey["name"], blue["name"]) == ("ground", "upper")
    for material, color in ((grey, FIXED_COLOR), (blue, PALETTE[0])):
        linear = np.array(material["pbrMetallicRoughness"]["baseColorFactor"][:3])
        # the other way round than the writer: linear light to sRGB (IEC 61966-2-1)
        screen = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        assert np.allclose(screen, color, atol=1e-4)  # the two branches of the standard meet to 1e-5 only
    painted = replace(
        motion.mechanism, solids=tuple(replace(p, color=(1.0, 0.5, 0.0)) for p in drawn_parts(motion.mechanism))
    )
    assert {part.color for part in drawn_parts(painted)} == {(1.0, 0.5, 0.0)}
