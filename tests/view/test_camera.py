import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import rotation
from jaxkin.view.camera import choose_view, move
from jaxkin.view.drawing import drawn_parts
from view.bars import box

X, Y, Z = np.eye(3)
ANGLES = np.linspace(0, 2 * np.pi, 13)


def turning(axis, point=(0, 0, 0)):
    """Displacements about an axis through a point."""
    poses = np.tile(np.eye(4), (len(ANGLES), 1, 1))
    poses[:, :3, :3] = [rotation(np.asarray(axis, float), angle) for angle in ANGLES]
    poses[:, :3, 3] = point - poses[:, :3, :3] @ np.asarray(point, float)
    return poses


def sliding(direction):
    poses = np.tile(np.eye(4), (len(ANGLES), 1, 1))
    poses[:, :3, 3] = np.outer(np.sin(ANGLES), direction)
    return poses


STILL = np.tile(np.eye(4), (len(ANGLES), 1, 1))


def placed(parts, displacements, turn, shift, scale=1.0):
    """All of it turned, shifted and scaled."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, shift
    parts = [Part(part.name, (), scale * (part.triangles @ turn.T + shift)) for part in parts]
    moved = {}
    for name, poses in displacements.items():
        moved[name] = pose @ poses @ np.linalg.inv(pose)
        moved[name][:, :3, 3] *= scale
    return parts, moved


@pytest.mark.parametrize(("axis", "right", "up"), [(Z, X, Y), (Y, X, Z), (X, Y, Z)])
def test_a_plane_of_motion_along_two_world_axes_is_drawn_as_in_textbooks(axis, right, up):
    corner = 10 * right + 2 * up + axis
    parts = [box("base", [-3, -3, -3], [-2, -2, -2]), box("arm", np.minimum(corner, 0), np.maximum(corner, 0))]
    view = choose_view(parts, ["base"], {"base": STILL, "arm": turning(axis)})
    assert view.planar
    assert np.allclose(view.axes[:2], [right, up], atol=1e-9)
    assert np.allclose(np.cross(*view.axes[:2]), view.axes[2])  # right-handed


@pytest.mark.parametrize("seed", range(4))
def test_any_other_plane_of_motion_lies_in_the_picture_with_the_base_level_and_below(seed):
    turn, shift = Rotation.random(rng=seed).as_matrix(), np.array([40.0, -70.0, 25.0])
    parts = [box("base", [-20, -4, -3], [20, 0, 0]), box("arm", [-1, 0, 0.5], [1, 12, 2])]
    swing = turning(Z)[:3]  # 0, 30, 60 degrees: it stays above
    view = choose_view(*_with(["base"], placed(parts, {"base": STILL[:3], "arm": swing}, turn, shift)))
    assert view.planar
    assert abs(view.axes[2] @ turn[:, 2]) == pytest.approx(1, abs=1e-9)
    assert abs(view.axes[0] @ turn[:, 0]) == pytest.approx(1, abs=1e-9)
    assert view.axes[1] @ turn[:, 1] == pytest.approx(1, abs=1e-9)


def _with(fixed, scene):
    parts, displacements = scene
    return parts, fixed, displacements


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_view_depends_neither_on_the_unit_nor_on_the_origin(scale, crane, sticks):
    for motion, fixed in ((crane, ["base"]), (sticks, ["ground"])):
        parts = drawn_parts(motion.mechanism)
        displacements = {name: np.asarray(poses) for name, poses in motion.transforms.items()}
        expected = choose_view(parts, fixed, displacements)
        other = placed(parts, displacements, np.eye(3), np.array([300.0, -200.0, 500.0]), scale)
        view = choose_view(*_with(fixed, other))
        assert view.planar == expected.planar
        assert np.allclose(view.axes, expected.axes, atol=1e-9)


def test_a_motion_in_space_is_seen_from_above_and_upright(crane):
    displacements = {name: np.asarray(poses) for name, poses in crane.transforms.items()}
    view = choose_view(drawn_parts(crane.mechanism), ["base"], displacements)
    assert not view.planar
    assert view.axes[0] @ Z == pytest.approx(0, abs=1e-12) and view.axes[1] @ Z > 0 and view.axes[2] @ Z > 0
    assert np.allclose(view.axes @ view.axes.T, np.eye(3)) and np.linalg.det(view.axes) > 0


@pytest.mark.parametrize("side", [-1, 1])
def test_a_mechanism_is_not_looked_at_through_its_base_plate(side):
    plate = box("base", np.array([-20, -20, 3.0 * side - 1]), np.array([20, 20, 3.0 * side + 1]))
    view = choose_view([plate, box("arm", [0, -1, -1], [15, 1, 1])], ["base"], {"base": STILL, "arm": turning(Z)})
    assert np.allclose(view.axes[2], -side * Z, atol=1e-9)


def test_a_motion_along_a_line_is_seen_across_it_on_the_flat_side():
    parts = [box("rail", [0, 0, 0], [30, 10, 1]), box("slide", [0, 0, 1], [5, 10, 2])]
    view = choose_view(parts, ["rail"], {"rail": STILL, "slide": sliding(X)})
    assert view.planar and np.allclose(np.abs(view.axes[2]), Z, atol=1e-9)


def test_a_mechanism_at_rest_is_seen_on_the_flat_side():
    parts = [box("rail", [0, 0, 0], [30, 1, 10]), box("slide", [0, 1, 0], [5, 2, 10])]
    view = choose_view(parts, ["rail"], {"rail": STILL[:1], "slide": STILL[:1]})
    assert np.allclose(np.abs(view.axes[2]), Y, atol=1e-9)


def test_move_takes_points_to_where_a_pose_has_them():
    points = np.random.default_rng(0).normal(size=(4, 3, 3))
    poses = turning(Y, (1.0, 2.0, 3.0))
    moved = move({"arm": poses}, "arm", points)
    homogeneous = np.concatenate([points, np.ones((4, 3, 1))], axis=-1)
    assert moved.shape == (len(ANGLES), 4, 3, 3)
    assert np.allclose(moved[5, 2, 1], (poses[5] @ homogeneous[2, 1])[:3], atol=1e-12)
