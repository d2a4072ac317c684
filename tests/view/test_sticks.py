import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.view.drawing import drawn_parts
from jaxkin.view.sticks import stick_parts

Z = (0.0, 0.0, 1.0)

PAIRS = {
    "revolute": lambda p1, p2, point: jk.revolute("J", p1, p2, point=point, axis=(1, 2, 2)),
    "prismatic": lambda p1, p2, point: jk.prismatic("J", p1, p2, point=point, axis=(1, 2, 2)),
    "cylindrical": lambda p1, p2, point: jk.cylindrical("J", p1, p2, point=point, axis=(1, 2, 2)),
    "planar": lambda p1, p2, point: jk.planar("J", p1, p2, point=point, normal=(1, 2, 2)),
    "spherical": lambda p1, p2, point: jk.spherical("J", p1, p2, point=point),
    "universal": lambda p1, p2, point: jk.universal("J", p1, p2, point=point, axis1=(1, 2, 2), axis2=(2, -2, 1)),
    "screw": lambda p1, p2, point: jk.screw("J", p1, p2, point=point, axis=(1, 2, 2), pitch=0.1),
}


def _volume(triangles):
    """Volume enclosed by closed surfaces wound outwards (overlaps count twice)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    return np.einsum("ti,ti->", a, np.cross(b, c)) / 6


def _chain(points, axis=Z):
    """Revolute joints one after another, from the ground through p0, p1, ... and back to the ground."""
    names = ["ground", *(f"p{index}" for index in range(len(points) - 1)), "ground"]
    joints = [
        jk.revolute(f"J{index}", names[index], names[index + 1], point=point, axis=axis)
        for index, point in enumerate(points)
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, unit="mm")


@pytest.mark.parametrize("pair", PAIRS)
def test_every_pair_shows_on_both_parts_around_its_point(pair):
    point = np.array([3.0, -1.0, 2.0])
    anchor = jk.spherical("A", "ground", "one", point=(0, 0, 0))  # its axes are not parallel: no layers
    parts = stick_parts(jk.Mechanism.build(fixed=["ground"], joints=[anchor, PAIRS[pair]("one", "two", point)]))
    assert [part.name for part in parts] == ["ground", "one", "two"]
    thickness = 0.02 * np.linalg.norm(point)
    for part in parts[1:]:
        nearest = np.linalg.norm(part.triangles.reshape(-1, 3) - point, axis=-1).min()
        assert nearest < 3 * thickness
        assert _volume(part.triangles) > thickness**3 and np.isfinite(part.triangles).all()
        assert not part.faces and part.color is None
    lowest, highest = parts[2].box
    assert np.allclose((lowest + highest) / 2, point, atol=1e-12)  # symmetric about its only joint


def test_a_bar_runs_from_joint_to_joint():
    start, end = np.array([0.0, 0.0, 0.0]), np.array([4.0, 0.0, 3.0])
    joints = [jk.spherical("A", "ground", "rod", point=start), jk.spherical("B", "rod", "ground", point=end)]
    (_, rod) = stick_parts(jk.Mechanism.build(fixed=["ground"], joints=joints))
    along = rod.triangles.reshape(-1, 3) @ (end - start) / 5
    across = np.linalg.norm(rod.triangles.reshape(-1, 3) - np.outer(along, (end - start) / 5), axis=-1)
    assert along.min() == pytest.approx(0.0, abs=0.25) and along.max() == pytest.approx(5.0, abs=0.25)
    assert across.max() < 0.25  # slim: 5 % of its length at the most


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_sticks_grow_with_the_mechanism(scale):
    points = np.array([[0, 0, 0], [1, 0, 0], [3, 2, 0], [4, 0, 0.0]])
    for small, large in zip(stick_parts(_chain(points)), stick_parts(_chain(scale * points)), strict=True):
        # a sum of a few products of numbers up to 4: some roundings
        assert np.allclose(large.triangles, scale * small.triangles, rtol=0, atol=1e-13 * scale)


def test_sticks_move_with_the_mechanism():
    """Round shapes only, whose look does not depend on where x of a frame points: the boxes of turned sticks agree with
    those of sticks of a turned mechanism to within the facets of a pin."""
    points = np.array([[0, 0, 0], [1, 0, 0], [3, 2, 0], [4, 0, 0.0]])
    turn = Rotation.from_rotvec([0.3, 0.5, -0.8]).as_matrix()
    shift = np.array([5.0, -7.0, 2.0])
    turned = stick_parts(_chain(points @ turn.T + shift, axis=turn[:, 2]))
    for part, moved in zip(stick_parts(_chain(points)), turned, strict=True):
        expected = part.triangles.reshape(-1, 3) @ turn.T + shift
        assert np.allclose(expected.min(axis=0), moved.box[0], atol=0.01)
        assert np.allclose(expected.max(axis=0), moved.box[1], atol=0.01)


@pytest.mark.long
def test_parts_of_a_planar_linkage_lie_in_layers():
    """Crank and rod both start out along x over the ground: in one plane they would hide in each other."""
    parts = stick_parts(_chain(np.array([[0, 0, 0], [1, 0, 0], [4, 0, 0], [6, 0, 0.0]])))
    heights = [part.box[1, 2] for part in parts]
    assert heights == sorted(heights) and np.diff(heights).min() > 0.05


@pytest.mark.long
def test_fixed_joints_join_parts_where_they_are():
    """A fixed joint has no place of its own: far from the origin the sticks stay near their other joints."""
    far = np.array([1000.0, 1000.0, 0.0])
    joints = [
        jk.revolute("A", "ground", "crank", point=far, axis=Z),
        jk.fixed("W", "crank", "arm"),
        jk.revolute("B", "arm", "rod", point=far + np.array([1, 0, 0]), axis=Z),
        jk.revolute("C", "rod", "ground", point=far + np.array([2, 0, 0]), axis=Z),
    ]
    parts = stick_parts(jk.Mechanism.build(fixed=["ground"], joints=joints))
    for part in parts:
        assert np.all(np.abs(part.box - far) < 2.2)
    middle = {part.name: part.box[:, 0] - far[0] for part in parts}
    assert middle["crank"][1] == pytest.approx(0.5, abs=0.1) and middle["arm"][0] == pytest.approx(0.5, abs=0.1)


def test_many_joints_of_a_part_meet_in_the_middle():
    angles = np.radians([0, 72, 144, 216, 288])
    joints = [
        jk.spherical(f"S{index}", "ground", "star", point=(np.cos(a), np.sin(a), 0)) for index, a in enumerate(angles)
    ]
    star = stick_parts(jk.Mechanism.build(fixed=["ground"], joints=joints))[1]
    corners = star.triangles.reshape(-1, 3)
    assert np.linalg.norm(corners, axis=-1).min() < 0.1
    assert _volume(star.triangles) > 0


def robot(folder, **solids):
    """A crank, a rod and a tip that is fixed to it, of a file that has a box for those of them that are named."""
    origins = {"crank": ("base", "0 0 0"), "rod": ("crank", "3 0 0"), "tip": ("rod", "0 2 0")}
    text = f'<robot name="r"><link name="base">{solids.get("base", "")}</link>'
    for name, (parent, origin) in origins.items():
        kind = "fixed" if name == "tip" else "continuous"
        text += f'<link name="{name}">{solids.get(name, "")}</link><joint name="{name} joint" type="{kind}">'
        text += f'<origin xyz="{origin}"/><parent link="{parent}"/><child link="{name}"/><axis xyz="0 0 1"/></joint>'
    (folder / "robot.urdf").write_text(f"{text}</robot>")
    return jk.load(folder / "robot.urdf").mechanism()


BOX = '<visual><geometry><box size="1 1 1"/></geometry></visual>'


def test_links_without_a_solid_are_bars_between_joints_and_to_the_tip(tmp_path):
    parts = {part.name: part for part in drawn_parts(robot(tmp_path))}
    assert [*parts] == ["base", "crank", "rod", "tip"]
    for name, start, end in (("crank", (0, 0), (3, 0)), ("rod", (3, 0), (3, 0)), ("tip", (3, 0), (3, 2))):
        low, high = parts[name].box[:, :2]
        np.testing.assert_allclose([low, high], np.sort([start, end], axis=0), atol=0.2)  # the radius of a joint
        assert _volume(parts[name].triangles) > 0
    assert len({round(float(part.box.mean(axis=0)[2]), 6) for part in parts.values()}) > 2  # in layers


def test_links_with_a_solid_stay_as_they_are_among_bars(tmp_path):
    mechanism = robot(tmp_path, crank=BOX)
    parts = {part.name: part for part in drawn_parts(mechanism)}
    np.testing.assert_array_equal(parts["crank"].box, [[-0.5] * 3, [0.5] * 3])
    np.testing.assert_allclose(parts["tip"].box[:, :2], [[3, 0], [3, 2]], atol=0.2)
    assert abs(parts["tip"].box.mean(axis=0)[2]) < 1e-12  # beside solids, bars lie where their joints are
    assert "no file" not in str(parts["crank"].notes) and not parts["tip"].is_solid


def test_a_robot_without_joints_is_drawn(tmp_path):
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    (part,) = drawn_parts(jk.load(tmp_path / "robot.urdf").mechanism())
    assert len(part.triangles) == 12
