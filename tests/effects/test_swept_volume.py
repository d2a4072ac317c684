"""Swept volumes against the formulas of tori and prisms.

Tolerances: the surface is within `error` of the true one, which is 2.2 steps of the grid; volumes of smooth solids are
off by the square of the step over their radius, a tenth of a percent where a radius is 16 steps, and sharp edges are
cut by at most half a step squared.
"""

import re
from dataclasses import replace

import jax
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.geometry.isosurface import zero_surface
from jaxkin.geometry.screw_motion import displacement_along, screw_between
from jaxkin.geometry.signed_distance import signed_distance
from reference.mechanisms import Z, slider_crank

LARGE, SMALL = 30.0, 8.0


def ball_on_an_arm() -> jk.Mechanism:
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(fixed=["base"], unit="mm", joints=[hinge])
    corners = np.asarray(trimesh.creation.icosphere(4, radius=SMALL).triangles) + [LARGE, 0, 0]
    return replace(mechanism, solids=(jk.Part("arm", (), corners),))


def box_on_a_slide(size=(10.0, 6.0, 4.0), along=(1.0, 0.0, 0.0)) -> jk.Mechanism:
    mechanism = jk.Mechanism.build(fixed=["base"], unit="mm", joints=[jk.prismatic("P", "base", "box", axis=along)])
    return replace(mechanism, solids=(jk.Part("box", (), np.asarray(trimesh.creation.box(size).triangles)),))


@pytest.fixture(scope="module")
def arm() -> jk.Mechanism:
    return ball_on_an_arm()


@pytest.mark.long
@pytest.mark.parametrize("turn", [2 * np.pi, 2.0])
def test_a_ball_on_a_circle_sweeps_a_torus(arm, turn):
    """pi r^2 R turn, and the halves of the ball at the ends; a whole turn closes the torus."""
    found = jk.swept_volume(arm.sweep({"A": np.linspace(0, turn, 25)}), "arm", resolution=0.5)
    volume = np.pi * SMALL**2 * LARGE * turn + (4 / 3 * np.pi * SMALL**3 if turn < 6 else 0.0)
    assert found.mesh.is_watertight and found.mesh.is_winding_consistent
    assert found.mesh.euler_number == (2 if turn < 6 else 0)  # a sausage, a ring
    # the triangles of the ball are 0.4 % smaller in section than it is, and the grid takes the rest
    np.testing.assert_allclose(found.volume, volume, rtol=6e-3)
    assert abs(found.volume - volume) < found.volume_error
    # every corner of the mesh is near the torus
    x, y, _ = found.mesh.vertices.T
    angle = np.clip(np.mod(np.arctan2(y, x) + 0.5, 2 * np.pi) - 0.5, 0 if turn < 6 else -1, turn)
    centre = LARGE * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    off = np.linalg.norm(found.mesh.vertices - centre, axis=1) - SMALL
    assert np.abs(off).max() < min(found.error, 0.2)


@pytest.mark.long
def test_errors_fall_with_the_square_of_the_step(arm):
    motion = arm.sweep({"A": np.linspace(0, 2.0, 9)})
    solid = np.asarray(arm.solids[0].triangles)
    radius = (trimesh.Trimesh(**trimesh.triangles.to_kwargs(solid)).volume / (4 / 3 * np.pi)) ** (1 / 3)
    volume = np.pi * radius**2 * LARGE * 2.0 + 4 / 3 * np.pi * radius**3
    off = [jk.swept_volume(motion, "arm", resolution=step).volume / volume - 1 for step in (2.0, 1.0)]
    assert 3.0 < off[0] / off[1] < 5.5


@pytest.mark.parametrize(
    ("along", "within"),
    [
        # edges that stand, cut by at most half a step squared: 128 mm of them, 11 of 528 mm^3
        ((1.0, 0.0, 0.0), 0.02),
        # and two faces of 48 mm^2, swept by edges, which lie a quarter of a step too far inside
        ((2.0, 1.0, 0.0), 0.03),
    ],
)
def test_a_box_that_slides_sweeps_a_prism(along, within):
    along = np.array(along) / np.linalg.norm(along)
    motion = box_on_a_slide(along=along).sweep({"P": np.array([0.0, 12.0])})
    found = jk.swept_volume(motion, "box", resolution=0.41)
    # the box, and its sides across the way times the way
    volume = 240.0 + 12.0 * (6.0 * 4.0 * along[0] + 10.0 * 4.0 * along[1])
    np.testing.assert_allclose(found.volume, volume, rtol=within)
    low, high = [-5, -3, -2.0], np.array([5, 3, 2.0]) + 12.0 * along
    np.testing.assert_allclose(found.box, [low, high], atol=0.2)  # half a step
    assert found.mesh.is_watertight and abs(found.volume - volume) < found.volume_error
    assert found.placements == 60 and found.poses == 2  # 12 mm in steps of at most 0.205 mm, and the first place
    text = str(found)
    assert "Swept volume of box over 2 poses" in text and "60 placements" in text and "too small on this grid" in text


def with_open_poses(motion: jk.Motion, *numbers: int) -> jk.Motion:
    status = np.array(motion.status)
    status[list(numbers)] = jk.Status.UNREACHABLE
    return replace(motion, status=jax.numpy.asarray(status))


def test_nothing_is_swept_past_poses_that_are_not_closed():
    """Two prisms, 12 mm long, with 28 mm between them; a pose alone is the box."""
    motion = box_on_a_slide().sweep({"P": np.array([0.0, 2.0, 20.0, 40.0, 42.0, 50.0, 80.0])})
    found = jk.swept_volume(with_open_poses(motion, 2, 5), "box", resolution=0.5)
    # edges cut by at most half a step squared, 0.125 of 208 mm: 26 of 816 mm^3
    np.testing.assert_allclose(found.volume, (12 + 12 + 10) * 6 * 4, rtol=0.04)
    assert len(found.mesh.split()) == 3
    assert (found.poses, found.left_out) == (5, 2)
    assert "over 5 poses; 2 poses left out as not closed, and the way past them" in str(found)
    np.testing.assert_allclose(found.box, [[-5, -3, -2], [85, 3, 2]], atol=0.25)  # half a step


@pytest.mark.long
def test_a_turn_past_poses_that_are_not_closed_is_no_step_of_the_motion(arm):
    """Two poses a third of a turn apart are no neighbours; those that are have the numbers of the motion."""
    motion = with_open_poses(arm.sweep({"A": np.array([0.0, 1.0, 2.0, 4.0])}), 1)
    with pytest.raises(ValueError, match="turns by 2 rad between the poses 2 and 3,"):
        jk.swept_volume(motion, "arm", resolution=4.0)
    two_balls = jk.swept_volume(with_open_poses(motion, 1, 2), "arm", resolution=2.0)
    assert len(two_balls.mesh.split()) == 2 and two_balls.placements == 2


@pytest.mark.long
def test_the_bound_of_two_poses_holds_what_lies_between():
    """A ball on the crank pin of the rod, two poses 1.4 rad apart: its circle is farther out than their chord."""
    pin = 40.0 * np.array([np.cos(1.0), np.sin(1.0), 0.0])
    ball = np.asarray(trimesh.creation.icosphere(3, radius=SMALL).triangles) + pin
    mechanism = replace(slider_crank(), solids=(jk.Part("rod", (), ball),))
    found = jk.swept_volume(mechanism.sweep({"A": np.array([0.0, 1.4])}), "rod")
    middle = np.array([np.cos(1.7), np.sin(1.7), 0.0])
    missing = 40.0 + SMALL - (found.mesh.vertices @ middle).max()
    assert 2.0 < missing < found.error


@pytest.mark.long
def test_a_bound_that_tells_little_says_which_step_to_write():
    """A rod of 2 x 2 mm: with the step that is said, the bound is less than half of its volume."""
    motion = box_on_a_slide((20.0, 2.0, 2.0)).sweep({"P": np.array([0.0, 1.0])})
    coarse = jk.swept_volume(motion, "box", resolution=0.7)
    assert coarse.volume_error > coarse.volume / 2
    said = re.search(r"half of the volume or more: write resolution=([0-9.]+) or less", str(coarse))
    assert said
    fine = jk.swept_volume(motion, "box", resolution=float(said[1]))
    assert fine.volume_error < fine.volume / 2 and "a smaller resolution= makes both better" in str(fine)


@pytest.mark.long
def test_a_part_that_turns_and_slides_by_a_slider_crank():
    """A ball on the crank pin of the rod sweeps what the path of its centre says, as for the arm: a torus."""
    mechanism = replace(slider_crank(), unit="mm")
    pin = 40.0 * np.array([np.cos(1.0), np.sin(1.0), 0.0])
    ball = np.asarray(trimesh.creation.icosphere(4, radius=SMALL).triangles) + pin
    mechanism = replace(mechanism, solids=(jk.Part("rod", (), ball),))
    found = jk.swept_volume(mechanism.sweep({"A": np.linspace(0, 2 * np.pi, 61)}), "rod", resolution=0.8)
    assert found.mesh.euler_number == 0  # a ring
    np.testing.assert_allclose(found.volume, 2 * np.pi**2 * 40.0 * SMALL**2, rtol=0.01)


def test_pictures_and_meshes_are_written(tmp_path):
    motion = box_on_a_slide().sweep({"P": np.array([0.0, 5.0])})
    found = jk.swept_volume(motion, "box", resolution=0.8)
    assert found.plot(tmp_path / "swept.png").stat().st_size > 5000
    again = trimesh.load_mesh(found.save(tmp_path / "swept.stl"))
    np.testing.assert_allclose(again.volume, found.volume, rtol=1e-5)  # STL is in float32
    with pytest.raises(ValueError, match=r"written as .stl, .ply, .obj, .glb, got 'swept.txt'"):
        found.save(tmp_path / "swept.txt")


def test_what_cannot_be_swept_says_why(arm):
    motion = arm.sweep({"A": np.array([0.0, 2.0])})  # few poses, coarse grids: it is refused before it costs
    with pytest.raises(ValueError, match=r"there is no part 'arms'.*'arm'"):
        jk.swept_volume(motion, "arms")
    with pytest.raises(ValueError, match="'base' has no solid to sweep"):
        jk.swept_volume(motion, "base")
    with pytest.raises(ValueError, match="turns by 2 rad between the poses 0 and 1"):
        jk.swept_volume(motion, "arm", resolution=8.0)
    with pytest.raises(ValueError, match=r"points 0.01 apart, and 6e\+07 are the most: write resolution="):
        jk.swept_volume(motion, "arm", resolution=0.01)
    with pytest.raises(ValueError, match=r"the resolution must be a length above zero, .*got -1"):
        jk.swept_volume(motion, "arm", resolution=-1)
    open_one = replace(arm, solids=(replace(arm.solids[0], triangles=arm.solids[0].triangles[1:]),))
    with pytest.raises(ValueError, match="the surface of 'arm' is not closed"):
        jk.swept_volume(open_one.sweep({"A": np.array([0.0, 0.1])}), "arm", resolution=4.0)


def test_distances_from_a_box_and_two_overlapping_ones():
    """Against the formula of a box, inside and out, and a union whose overlap counts once."""
    size = np.array([3.0, 2.0, 1.0])
    corners = np.asarray(trimesh.creation.box(size).triangles)
    found, first = signed_distance(corners, 0.25)
    place = first + 0.25 * np.moveaxis(np.indices(found.shape), 0, -1)
    q = np.abs(place) - size / 2
    exact = np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)
    np.testing.assert_allclose(found, np.clip(exact, -0.5, 0.5), atol=1e-12)  # rounding
    both, first = signed_distance(np.concatenate([corners, corners + [1.0, 0.0, 0.0]]), 0.1)
    points, triangles = zero_surface(both)
    np.testing.assert_allclose(trimesh.Trimesh(0.1 * points, triangles).volume, 8.0, rtol=0.02)


def test_screw_motions_end_where_they_should():
    rng = np.random.default_rng(3)
    from scipy.spatial.transform import Rotation

    for angle in (0.0, 1e-7, 1e-3, 1.0, 3.0):
        poses = [np.eye(4), np.eye(4)]
        poses[0][:3, :3], poses[0][:3, 3] = Rotation.from_rotvec(rng.normal(size=3)).as_matrix(), rng.normal(size=3)
        axis = rng.normal(size=3)
        poses[1][:3, :3] = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix() @ poses[0][:3, :3]
        poses[1][:3, 3] = rng.normal(size=3)
        velocity = screw_between(*poses)
        np.testing.assert_allclose(displacement_along(velocity, 1.0) @ poses[0], poses[1], atol=1e-12)
        half = displacement_along(velocity, 0.5)
        np.testing.assert_allclose(half @ half @ poses[0], poses[1], atol=1e-12)
