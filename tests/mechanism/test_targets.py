"""Inverse kinematics by drives that are no joints, against closed forms, and back by the actuators."""

import re

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism.targets import with_targets
from reference import parallel
from reference.catalogue import delta, fivebar, hexapod

Z = (0.0, 0.0, 1.0)
ANGLES = np.linspace(0.0, 2 * np.pi, 41)


def arm_angle(base, elbow, tip, path, side):
    """Angle of the arm at `base` from its place at rest: the elbow lies on two circles, on the `side` of the line."""
    first, second = np.linalg.norm(np.subtract(elbow, base)), np.linalg.norm(np.subtract(tip, elbow))
    x, y = (path - base).T
    reach = np.hypot(x, y)
    bend = np.arccos((first**2 + reach**2 - second**2) / (2 * first * reach))
    rest = np.arctan2(elbow[1] - base[1], elbow[0] - base[0])
    return np.arctan2(y, x) + side * bend - rest


@pytest.mark.long
def test_a_five_bar_draws_a_path_and_its_motors_draw_it_again():
    mechanism, tip = fivebar(), (1.5, 2.0, 0.0)
    path = np.stack([1.5 + 0.4 * np.sin(ANGLES), 2.3 - 0.3 * np.cos(ANGLES), 0 * ANGLES], axis=1)
    motion = mechanism.sweep({jk.point("b", tip): path}, throw=True)
    np.testing.assert_allclose(motion.points("b", tip), path, atol=1e-13)
    left = arm_angle((0, 0), (-0.5, 1.5), tip[:2], path[:, :2], 1)
    right = arm_angle((4, 0), (4.2, 1.5), tip[:2], path[:, :2], -1)
    np.testing.assert_allclose(motion.coordinates["A"][:, 0], left, atol=1e-13)
    np.testing.assert_allclose(motion.coordinates["E"][:, 0], right, atol=1e-13)
    motors = {name: motion.coordinates[name][:, 0] for name in ("A", "E")}
    np.testing.assert_allclose(mechanism.sweep(motors, throw=True).points("c", tip), path, atol=1e-12)


def test_each_leg_is_solved_by_itself_once_the_platform_is_given():
    """Contracted, ground and platform are one body: two dyads, as a designer would solve them."""
    steps = fivebar().plan([jk.point("b", (1.5, 2, 0))]).steps
    assert [step.loop_class for step in steps] == ["planar dyad RRR", "planar dyad RRR"]
    assert len(hexapod().plan([jk.pose("platform")]).steps) == 6


@pytest.mark.long
@pytest.mark.study
def test_the_legs_of_a_hexapod_for_poses_of_its_platform():
    """Their lengths are the distances of their balls."""
    mechanism = hexapod()
    home = np.array([mechanism.joints[f"top {i}"].frames_1[0][:3, 3] for i in range(6)])
    moved, lengths = parallel.curve(parallel.hexapod().base, home, 60)
    motion = mechanism.sweep({jk.pose("platform"): moved}, throw=True)
    found = np.stack([motion.coordinates[f"leg {i}"][:, 0] for i in range(6)], axis=1)
    np.testing.assert_allclose(found, lengths, atol=1e-10)  # mm
    np.testing.assert_allclose(motion.transforms["platform"], moved, atol=1e-10)


@pytest.mark.long
def test_the_arms_of_a_delta_for_places_of_its_platform():
    start = np.array([20.0, -30.0, -420.0])
    mechanism = delta(tuple(start))
    path = start + np.stack([60 * np.sin(ANGLES), 50 - 50 * np.cos(ANGLES), 30 * np.sin(2 * ANGLES)], axis=1)
    motion = mechanism.sweep({jk.point("platform", start): path}, throw=True)
    found = np.stack([motion.coordinates[f"motor {i}"][:, 0] for i in range(3)], axis=1)
    np.testing.assert_allclose(found, parallel.delta(path) - parallel.delta(start[None]), atol=1e-12)


@pytest.mark.long
def test_targets_and_joints_are_driven_together():
    mechanism = fivebar()
    turned = np.linspace(0.0, 0.3, 7)
    spun = spins(turned, 2)
    motion = mechanism.sweep({jk.orientation("b"): spun, "A": -turned}, throw=True)
    np.testing.assert_allclose(motion.transforms["b"][:, :3, :3], spun, atol=1e-14)
    np.testing.assert_allclose(motion.coordinates["B"][:, 0], 2 * turned, atol=1e-14)  # relative to its arm


def spins(angles, axis):
    """Rotation matrices about an axis x, y or z (0, 1, 2)."""
    one, other = np.delete(np.arange(3), axis)
    found = np.tile(np.eye(3), (len(angles), 1, 1))
    found[:, one, one] = found[:, other, other] = np.cos(angles)
    found[:, other, one] = np.sin(angles)
    found[:, one, other] = -found[:, other, one]
    return found


@pytest.mark.parametrize("make", [fivebar, delta])
def test_a_pose_without_numbers_spoils_no_other(make):
    """Angles count full turns past it: of a planar pair, and of a free joint."""
    mechanism = make()
    part = mechanism.parts[-1]
    poses = spins(np.linspace(0.0, 15.0, 41), 2)
    (_, whole), gone = with_targets(mechanism, {jk.orientation(part): poses}), [0, 9, 10, 40]
    poses[gone] = np.nan
    traced = jax.jit(lambda given: with_targets(mechanism, {jk.orientation(part): given})[1])(jnp.asarray(poses))
    poses[gone] = np.eye(3)
    poses[gone, 0, 1] = np.nan, np.nan, np.inf, np.nan  # one number is enough
    _, with_gaps = with_targets(mechanism, {jk.orientation(part): poses})
    for name, values in whole.items():
        expected = np.where(np.isin(np.arange(41), gone), np.nan, values)
        np.testing.assert_allclose(with_gaps[name], expected, atol=1e-14)
        np.testing.assert_allclose(traced[name], expected, atol=1e-14)


def test_a_range_without_poses_has_coordinates_without_poses():
    for key in (jk.pose("platform"), jk.orientation("platform"), jk.point("platform", (0, 0, 0))):
        _, drive = with_targets(hexapod(), {key: np.zeros((0, *key.shape))})
        assert all(values.shape == (0,) for values in drive.values())


def test_poses_beside_one_without_numbers_are_checked():
    poses = np.tile(np.eye(3), (4, 1, 1))
    poses[1], poses[3] = np.nan, 2 * np.eye(3)
    with pytest.raises(ValueError, match=r"the poses must be rigid, .* off by 3"):
        with_targets(fivebar(), {jk.orientation("b"): poses})


@pytest.mark.long
@pytest.mark.parametrize("geometry", [False, True])
def test_traced_poses_that_are_not_rigid_or_leave_the_plane_are_no_numbers(geometry):
    """Known ones are refused, and only the plane of a traced geometry is not known."""
    poses = np.tile(np.eye(4), (6, 1, 1))
    poses[:, :3, :3] = spins(np.linspace(0.0, 1.0, 6), 2)
    poses[1, 0, 0] *= 1.001
    poses[2, 2, 3] = 1e-3
    poses[3, :3, :3] = poses[3, :3, :3] @ np.diag([1.0, 1.0, -1.0])
    poses[4, 3, 3] = 2.0
    mechanism, key = fivebar(), jk.pose("b")
    place = jnp.asarray(mechanism.joints["A"].frames_1[0])

    def drive(given, place):
        return with_targets(mechanism.with_frames({"A": place}) if geometry else mechanism, {key: given})[1]

    bad = np.isin(np.arange(6), [1, 2, 3, 4])
    for row in jax.jit(drive)(poses, place).values():
        np.testing.assert_array_equal(np.isnan(row), bad)
    slopes = jax.grad(lambda *given: sum(jnp.nansum(row) for row in drive(*given).values()), (0, 1))(poses, place)
    assert all(np.isfinite(slope).all() for slope in slopes)
    for which in (1, 3, 4) if geometry else (1, 2, 3, 4):
        with pytest.raises(ValueError, match=r"must be rigid|the target leaves it"):
            jax.jit(lambda place, which=which: drive(poses[[which]], place))(place)


def test_poses_in_single_precision_are_rigid():
    angles = np.linspace(0.0, 3.0, 101)
    turned = (spins(angles, 0) @ spins(2 * angles, 2)).astype(np.float32)
    turned = np.einsum("nij,njk,nkl->nil", turned, turned, turned)  # a chain of joints
    _, drive = with_targets(delta(), {jk.orientation("platform"): turned})
    assert all(np.isfinite(row).all() for row in drive.values())


@pytest.mark.long
def test_an_arm_in_space_reaches_a_point_with_the_least_movement():
    """Two joints and one more than the point needs: a chain without loops, closed by the target."""
    joints = [
        jk.revolute("base", "ground", "a", point=(0, 0, 0), axis=Z),
        jk.revolute("shoulder", "a", "b", point=(0, 0, 1), axis=(0, 1, 0)),
        jk.revolute("elbow", "b", "c", point=(0.5, 0, 2), axis=(0, 1, 0)),
    ]
    arm = jk.Mechanism.build(fixed=["ground"], joints=joints)
    tip = (1.5, 0.0, 1.8)
    path = np.asarray(tip) + np.stack([-0.2 * np.sin(ANGLES), 0.3 * np.sin(ANGLES), 0.1 * np.sin(ANGLES)], axis=1)
    motion = arm.sweep({jk.point("c", tip): path}, throw=True)
    np.testing.assert_allclose(motion.points("c", tip), path, atol=1e-13)
    np.testing.assert_allclose(np.tan(motion.coordinates["base"][:, 0]), path[:, 1] / path[:, 0], atol=1e-13)


@pytest.mark.long
def test_derivatives_of_inverse_kinematics():
    """d(motor)/d(path) is the inverse of d(path)/d(motor)."""
    mechanism, tip = fivebar(), (1.5, 2.0, 0.0)

    def motors(place):
        motion = mechanism.sweep({jk.point("b", tip): jnp.append(place, 0.0)[None]})
        found = jnp.stack([motion.coordinates[name][0, 0] for name in ("A", "E")])
        return found, found

    def place(angles):
        return mechanism.sweep({"A": angles[:1], "E": angles[1:]}).points("b", tip)[0, :2]

    slopes, angles = jax.jacobian(motors, has_aux=True)(jnp.array([1.6, 1.9]))
    np.testing.assert_allclose(slopes @ jax.jacobian(place)(angles), np.eye(2), atol=1e-12)


@pytest.mark.long
def test_one_pose_and_the_velocities_of_a_path():
    mechanism, tip = fivebar(), (1.5, 2.0, 0.0)
    target = jk.point("b", tip)
    pose = mechanism.solve({target: np.array([1.4, 2.1, 0.0])})
    np.testing.assert_allclose(pose.point("b", tip), [1.4, 2.1, 0.0], atol=1e-13)
    motion = mechanism.sweep({target: np.array([[1.4, 2.1, 0.0]])})
    rates = jk.velocities(motion, {f"{target.joint}.x": 1.0})
    np.testing.assert_allclose(rates.points("b", tip)[0] - rates.points("c", tip)[0], 0, atol=1e-13)
    assert float(jnp.linalg.norm(rates.points("b", tip)[0])) == pytest.approx(1.0, rel=1e-12)
    there = mechanism.at(pose)
    np.testing.assert_allclose(there.joints["C"].frames_1[0][:3, 3], [1.4, 2.1, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    ("drive", "said"),
    [
        (
            lambda: {jk.pose("b"): np.tile(np.eye(4), (3, 1, 1))},
            "driven b pose.x, .* has 2 freedoms: drive A.phi, B.phi; jk.inv",
        ),
        (
            lambda: {jk.point("b", (1.5, 2, 0)): np.zeros((3, 2))},
            r"expected an array of shape \(poses, 3\), got .*3, 2",
        ),
        (lambda: {jk.point("b", (1.5, 2, 0)): np.full((3, 3), 1.5)}, "the target leaves it by 0.3"),
        (lambda: {jk.orientation("b"): np.tile(2 * np.eye(3), (3, 1, 1))}, "the poses must be rigid, .* off by 3"),
        (lambda: {jk.pose("B"): np.tile(np.eye(4), (3, 1, 1))}, "B pose: there is no part 'B'"),
        (lambda: {jk.pose("ground"): np.tile(np.eye(4), (3, 1, 1))}, "the part 'ground' is fixed"),
        (lambda: {jk.point("b", (1.5, np.nan, 0)): np.zeros((3, 3))}, "must be three finite numbers"),
    ],
)
def test_targets_that_make_no_sense(drive, said):
    with pytest.raises(ValueError, match=said):
        fivebar().sweep(drive())


TIP = jk.point("b", (1.5, 2, 0))
HELD = {TIP: [[1.5, 2.0, 0.0]], jk.pose("b"): np.eye(4)[None], jk.orientation("b"): np.eye(3)[None], "A": [0.0]}


@pytest.mark.long
@pytest.mark.parametrize(
    "keys", [(jk.pose("b"),), (TIP, "A"), (jk.orientation("b"), TIP), ("A", "E", jk.orientation("b"))], ids=str
)
def test_what_is_proposed_in_place_of_a_target_can_be_typed(keys):
    """No coordinate of a target alone, which no drive can name; and `jk.inverse` takes the targets as they are."""
    mechanism, values = fivebar(), HELD | {"E": [0.0]}
    with pytest.raises(ValueError) as error:
        mechanism.sweep({key: values[key] for key in keys})
    said = re.search(r"freedoms: drive (?:only )?(.*); jk\.inverse meets the target", str(error.value))
    assert said is not None
    typed = {key.joint: key for key in HELD if isinstance(key, jk.Target)}
    proposed = [name for name in typed if name in said[1]]
    joints = [name for name in re.findall(r"\b([A-E])\.phi", said[1])]
    drive = {typed[name]: HELD[typed[name]] for name in proposed} | {name: [0.0] for name in joints}
    assert drive and mechanism.sweep({key: np.asarray(value) for key, value in drive.items()}).closed.all()
    # the assembled pose meets all of them: to rounding
    assert jk.inverse(mechanism, {key: values[key] for key in keys}).errors.max() < 1e-9
