"""Clashes of parts whose faces lie in each other's: no triangle crosses another one, however deep the parts are."""

from dataclasses import replace

import jax
import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import jaxkin as jk
from reference.drawn_parts import box, loaded
from reference.mechanisms import planar_fourbar

LENGTH = 20.0
SHARES = np.array([-0.05, 0.0, 1e-3, 0.05, 0.25, 0.45, 0.5, 0.7, 0.95, 0.999, 1.0])
"""Overlap over the length of the bars; below 0 they are apart."""
ROUNDING = 2e-5
"""Of turned corners, which STL holds in float32: 6e-8 of coordinates up to 100, several times."""
BARS = {
    # the bar along x, from 0 to its length, and the radius of the largest ball in it, if it is long
    "rod": (lambda: along_x(trimesh.creation.cylinder(10, LENGTH, sections=48)), 10 * np.cos(np.pi / 48)),
    "cube": (lambda: box([0, -10, -10], [LENGTH, 10, 10]), 10),
    "plate": (lambda: box([0, -30, -1], [LENGTH, 30, 1]), 1),
    "hexagon": (lambda: along_x(trimesh.creation.cylinder(10, LENGTH, sections=6)), 10 * np.cos(np.pi / 6)),
    "tube": (lambda: along_x(trimesh.creation.annulus(6, 10, LENGTH, sections=48)), 2),
}


def along_x(mesh):
    """A mesh about the z axis, turned and moved to go from 0 on along x."""
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    mesh.apply_translation([-mesh.bounds[0, 0], 0, 0])
    return mesh


def anywhere(seed):
    """A displacement that lines up with no axis."""
    place = np.eye(4)
    random = np.random.default_rng(seed)
    place[:3, :3] = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
    place[:3, 3] = random.uniform(-50, 50, 3)
    return place


def slid(folder, still, moving, shifts, *, place=None, unit="mm"):
    """The clashes of a part that slides along x, on its own or turned anywhere, with one that is at rest."""
    place = np.eye(4) if place is None else place
    parts = {name: mesh.copy().apply_transform(place) for name, mesh in {"still": still, "moving": moving}.items()}
    for name, mesh in parts.items():
        mesh.export(folder / f"{name}.stl")
    slide = jk.prismatic("slide", "still", "moving", axis=tuple(place[:3, 0]))
    files = {name: folder / f"{name}.stl" for name in parts}
    mechanism = jk.load(files, unit=unit).mechanism(fixed=["still"], joints=[slide])
    return jk.clashes(mechanism.sweep({"slide": np.asarray(shifts)}), within=5)


@pytest.mark.parametrize(
    ("bar", "unit"),
    [
        ("rod", "mm"),
        *(pytest.param(bar, "mm", marks=pytest.mark.long) for bar in ("cube", "plate", "hexagon")),
        ("tube", "in"),
    ],
)
def test_bars_that_are_pushed_into_equal_ones_clash(tmp_path, bar, unit):
    """The end of the one is in the other by the overlap, and as far from its other end and its sides as they allow."""
    drawn, radius = BARS[bar]
    still, moving = drawn(), drawn()
    moving.apply_translation([-30, 0, 0])
    overlap = SHARES * LENGTH
    found = slid(tmp_path, still, moving, overlap + 10, place=anywhere(3), unit=unit)
    np.testing.assert_allclose(found.clearances[0, :2], [1.0, 0.0], atol=ROUNDING)
    np.testing.assert_array_equal(found.clashing[0], overlap > 0)
    deepest = np.minimum(np.minimum(overlap, LENGTH - overlap), radius)[2:-1]
    depths = found.depths[0, 2:-1]
    assert np.all(depths <= deepest + ROUNDING)
    # points of the end are half as far from its rim as its middle, or nearly
    assert np.all(depths >= np.minimum(deepest, 0.45 * radius) - ROUNDING)
    assert 0.45 * radius < found.depths[0, -1] < radius + ROUNDING


def test_faces_on_each_other_are_no_clash(tmp_path):
    """Boxes and shafts that meet face to face, flush with each other, slide along each other and off."""
    rod = along_x(trimesh.creation.cylinder(10, LENGTH, sections=48))
    turned = rod.copy().apply_transform(trimesh.transformations.rotation_matrix(0.05, [1, 0, 0]))
    turned.apply_translation([-LENGTH, 0, 0])
    for still, moving, shifts in [
        (box([0, 0, 0], [20, 20, 20]), box([0, 0, 20], [20, 20, 30]), [0, 5, 20, 25]),
        (box([0, 0, 0], [20, 20, 20]), box([-30, -10, -5], [0, 40, 20]), [-1, 0]),
        (rod, turned, [-3, 0]),
    ]:
        found = slid(tmp_path, still, moving, shifts, place=anywhere(5))
        assert not found.clashing.any() and found.clearances.min() == pytest.approx(0, abs=ROUNDING)


def test_a_bar_in_a_profile_of_its_own_section_clashes(tmp_path):
    """The bar is the foot of an inverted T, drawn twice: of its faces the upper one only is partly in the other."""
    outline = np.array([[0, 0], [100, 0], [100, 10], [60, 10], [60, 50], [40, 50], [40, 10], [0, 10]])
    front = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 6], [0, 6, 7], [3, 4, 5], [3, 5, 6]])
    corner, after = np.arange(8), np.roll(np.arange(8), -1)
    around = np.concatenate([np.stack([after, corner, corner + 8], 1), np.stack([after, corner + 8, after + 8], 1)])
    points = np.concatenate([np.insert(outline, 1, y, axis=1) for y in (0, 20)])
    profile = trimesh.Trimesh(points, np.concatenate([front, front[:, ::-1] + 8, around]))
    assert profile.is_watertight and profile.volume == pytest.approx(36000)
    moving = box([-200, 0, 0], [-100, 20, 10])
    found = slid(tmp_path, profile, moving, [90.0, 130.0, 150.0, 200.0, 300.0])
    np.testing.assert_array_equal(found.clashing[0], [False, True, True, True, False])


@pytest.mark.long
def test_a_ram_that_goes_into_a_post_of_its_own_radius_clashes(tmp_path):
    """The ram slides in a bore of the frame, which is no clash; the post under it is of the frame, too."""
    guide = trimesh.creation.annulus(10, 20, segment=[[0, 0, 40], [0, 0, 60]], sections=64)
    post = trimesh.creation.cylinder(10, segment=[[0, 0, -20], [0, 0, 0]], sections=40)
    ram = trimesh.creation.cylinder(10, segment=[[0, 0, 10], [0, 0, 100]], sections=40)
    mechanism = loaded(tmp_path, {"frame": guide + post, "ram": ram}).mechanism(fixed=["frame"])
    (joint,) = mechanism.all_joints
    shift = np.array([-15.0, -11, -10, -9, -5, 0, 5, 9, 10, 11, 15])
    motion = mechanism.sweep({f"{joint.name}.z": shift, f"{joint.name}.phi": 0 * shift})
    found = jk.clashes(motion)
    deep = -np.asarray(motion.points("ram", (0, 0, 10)))[:, 2]
    assert found.joined.all()
    np.testing.assert_array_equal(found.clashing[0], deep > 0.5)
    # a point of the end half-way to its rim is 5 from the sides, but for the chords
    np.testing.assert_allclose(found.depths[0], np.where(deep > 0.5, deep, 0), atol=0.05)
    assert (deep > 0.5).sum() == 2


def far(folder):
    """Two parts that never come near each other."""
    parts = {"still": box([0, 0, 0], [10, 10, 10]), "moving": box([100, 0, 0], [110, 10, 10])}
    slide = jk.prismatic("slide", "still", "moving", axis=(1, 0, 0))
    motion = loaded(folder, parts).mechanism(fixed=["still"], joints=[slide])
    return motion.sweep({"slide": np.arange(4.0)})


@pytest.mark.parametrize("closed", [4, 3, 0])
def test_poses_that_are_not_closed_are_told_where_no_pair_comes_near(tmp_path, closed):
    motion = far(tmp_path)
    status = motion.status + jax.numpy.array([0] * closed + [1] * (4 - closed), motion.status.dtype)
    found = jk.clashes(replace(motion, status=status))
    assert found.pairs == () and found.closed.sum() == closed
    np.testing.assert_array_equal(found.least, [np.inf] * closed + [np.nan] * (4 - closed))
    told = {
        4: "0 pairs of parts come near each other in 4 poses: 0 clash\n  all others",
        3: "in 3 closed poses of 4: 0 clash\n  whether parts clash at the 1 other poses is not known\n",
        0: "none of 4 poses is closed: whether parts clash is not known",
    }
    assert told[closed] in str(found)
    assert ("0 clash" in str(found)) == (closed > 0)
    assert found.plot(tmp_path / "clashes.png").stat().st_size > 1000


def test_equal_lengths_are_told_at_their_first_pose():
    """Of 50 poses at 7.5, but for rounding, the first is told; and of two depths of 2 the first."""
    noise = 1e-14 * np.cos(7.0 * np.arange(50))
    rows = np.stack([7.5 + noise, np.where(np.arange(50) < 20, 1.0, -2 - noise)])
    motion = planar_fourbar().sweep({"A": np.linspace(0, 1, 50)})
    found = jk.Clashes(
        motion, (("base", "box"), ("base", "arm")), np.zeros(2, bool), rows, np.ones(50, bool), within=10.0, unit="mm"
    )
    assert "base - box: nearest 7.5 mm at pose 0 (0 deg)" in str(found)
    assert "base - arm: clash at 30 poses from pose 20 (23.39 deg) on, deepest 2 mm at pose 20 (23.39 deg)" in str(
        found
    )
