"""Transforms of the parts for any displacements of the joints, closed or not: the products along the tree."""

import re

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.linkage import joint_motion
from jaxkin.linkage.joint_motion import part_transforms
from jaxkin.linkage.point_path import point_path

POINTS = {"A": (0.0, 0.0, 0.0), "B": (31.0, 7.0, -2.0), "C": (52.0, 43.0, 5.0)}  # mm
AXES = {"A": (1.0, 2.0, 3.0), "B": (-1.0, 0.3, 2.0), "C": (0.2, 1.0, -0.4)}
CHAIN = ("base", "arm", "elbow", "hand")
ROUNDING = 2e-13
"""Some ten roundings of lengths of 100 mm."""


@pytest.fixture(scope="module")
def arm():
    """A chain of three hinges about skew axes, and a lamp that its elbow holds rigidly."""
    joints = [
        jk.revolute(name, *CHAIN[i : i + 2], point=POINTS[name], axis=AXES[name]) for i, name in enumerate(POINTS)
    ]
    return jk.Mechanism.build(fixed=["base"], joints=[*joints[:2], jk.fixed("grip", "elbow", "lamp"), *joints[2:]])


@pytest.fixture
def angles():
    return jnp.asarray(np.random.default_rng(0).uniform(-3, 3, (3, 5)))


def displacements(mechanism, angles):
    """Of all joints; the rows of angles are those of the hinges, in order."""
    columns = {
        **{name: row[:, None] for name, row in zip(POINTS, angles, strict=True)},
        "grip": angles[0][:, None][:, :0],
    }
    return tuple(columns[name] for name in mechanism.joints)


def transforms(mechanism, angles):
    """By part."""
    return dict(zip(mechanism.parts, part_transforms(mechanism.linkage, displacements(mechanism, angles)), strict=True))


def turned(name, angle):
    """Rotation about the axis of a hinge (Rodrigues)."""
    axis, point = np.array(AXES[name]) / np.linalg.norm(AXES[name]), np.array(POINTS[name])
    cross = np.cross(np.eye(3), axis)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return np.block([[turn, (point - turn @ point)[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])


def test_a_part_goes_through_all_joints_up_to_it(arm, angles):
    found = transforms(arm, angles)
    for pose in range(angles.shape[1]):
        product = np.eye(4)
        for name, part, angle in zip(POINTS, CHAIN[1:], np.asarray(angles[:, pose]), strict=True):
            product = product @ turned(name, angle)
            np.testing.assert_allclose(found[part][pose], product, rtol=0, atol=ROUNDING)


def test_poses_known_outside_are_placed_inside_jit(arm, angles):
    """A loss compares designs, which JAX traces, with a motion, which it does not."""
    columns = dict(zip(POINTS, angles, strict=True))
    motion = arm.sweep(columns)
    inside = jax.jit(lambda: motion.points("hand", (60.0, 40.0, 0.0)))()
    np.testing.assert_allclose(inside, arm.sweep(columns).points("hand", (60.0, 40.0, 0.0)), rtol=0, atol=ROUNDING)


@pytest.mark.long  # the default run compiles without the optimisation that once rounded them differently
@pytest.mark.parametrize("how", ["plain", "jit", "vmap", "jvp"])
def test_what_is_held_rigidly_moves_exactly_with_its_holder(arm, angles, how):
    """Bit by bit, whatever becomes of the program around it: a part is found once, not anew for each that it holds."""

    def both(angles):
        found = transforms(arm, angles)
        return found["elbow"], found["lamp"]

    elbow, lamp = {
        "plain": lambda: both(angles),
        "jit": lambda: jax.jit(both)(angles),
        "vmap": lambda: jax.vmap(both)(jnp.stack([angles, angles + 1])),
        "jvp": lambda: jax.jvp(both, (angles,), (jnp.cos(angles),))[1],
    }[how]()
    assert np.ptp(elbow) > 1
    np.testing.assert_array_equal(elbow, lamp)


@pytest.mark.long
def test_slopes_of_a_chain_forward_and_backward(arm, angles):
    def hand(angles):
        return transforms(arm, angles)["hand"]

    along = jnp.cos(angles)
    found, forward = jax.jvp(hand, (angles,), (along,))
    step = 1e-5  # of the central difference: it errs by 100 mm (1e-10 / 6 + 1e-16 / 1e-5), times a few joints
    difference = (hand(angles + step * along) - hand(angles - step * along)) / (2 * step)
    np.testing.assert_allclose(forward, difference, rtol=0, atol=2e-8)
    (backward,) = jax.vjp(hand, angles)[1](found)
    # 100 mm squared, some hundred terms
    np.testing.assert_allclose(jnp.vdot(backward, along), jnp.vdot(found, forward), rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(("fixed", "part"), ["ah", "ha"])
def test_a_point_is_carried_as_its_part_is_displaced(fixed, part):
    """Through joints of all movements in space, from either end of the chain, with the same derivatives."""
    at = {"point": (3.0, 1.0, -2.0)}
    joints = [
        jk.cylindrical("ab", "a", "b", axis=AXES["A"], **at),
        jk.spherical("bc", "b", "c", point=POINTS["B"]),
        jk.screw("cd", "c", "d", axis=AXES["B"], pitch=4.0, point=POINTS["C"]),
        jk.universal("de", "d", "e", axis1=(1.0, 0.0, 0.0), axis2=(0.0, 1.0, 0.0), **at),
        jk.planar("ef", "e", "f", normal=AXES["C"], **at),
        jk.fixed("fg", "f", "g"),
        jk.prismatic("gh", "g", "h", axis=AXES["A"]),
    ]
    mechanism = jk.Mechanism.build(fixed=[fixed], joints=joints)
    random = np.random.default_rng(2)
    q = tuple(jnp.asarray(random.uniform(-3, 3, (4, joint.freedoms))) for joint in joints)
    point = np.array([20.0, -7.0, 11.0])

    def carried(linkage, q):
        return point_path(linkage, q, part, jnp.asarray(point))

    def displaced(linkage, q):
        found = part_transforms(linkage, q)[mechanism.parts.index(part)]
        return found[:, :3, :3] @ point + found[:, :3, 3]

    def rate(leaf):
        """Of a number any, of frames that of a rigid displacement: a skew matrix and a shift, times the frames."""
        skew = np.zeros((4, 4))
        skew[:3, :3], skew[:3, 3] = np.cross(np.eye(3), random.uniform(-1, 1, 3)), random.uniform(-9, 9, 3)
        return skew @ leaf if leaf.ndim == 3 else jnp.cos(leaf)

    along = jax.tree.map(rate, (mechanism.linkage, q))
    one, other = (jax.jit(lambda *at, f=f: jax.jvp(f, at, along))(mechanism.linkage, q) for f in (carried, displaced))
    for found, expected in zip(one, other, strict=True):
        # some hundred roundings of what was multiplied: lengths of 100 mm, slopes of frames as large as their places
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(np.asarray(expected)).max())


def test_a_name_that_is_not_there_is_answered_with_those_that_are(arm):
    motion = arm.sweep({"A": np.zeros(2)})
    for named, unknown, answer in (
        (motion.coordinates, "elbow", "there is no joint 'elbow'; there is 'A', 'B', 'grip', 'C'"),
        (arm.joints, "gripp", "there is no joint 'gripp'; did you mean 'grip'?"),
        (motion.transforms, "lam", "there is no part 'lam'; did you mean 'lamp'?"),
    ):
        with pytest.raises(KeyError, match=re.escape(answer)):
            named[unknown]
        assert unknown not in named and named.get(unknown) is None
        leaves, tree = jax.tree.flatten(named)
        again = jax.tree.unflatten(tree, leaves)
        assert (type(again), again.what, list(again)) == (type(named), named.what, list(named))


@pytest.mark.long
def test_ranges_of_similar_length_share_a_program(arm):
    """And give what the same poses give in one range: rounding apart, since XLA may fuse products otherwise."""
    angles = np.random.default_rng(1).uniform(-3, 3, (3, 100))
    whole = transforms(arm, angles)
    before = joint_motion.transforms._cache_size()
    for count in (65, 80, 99):
        for part, found in transforms(arm, angles[:, :count]).items():
            assert found.shape == (count, 4, 4)
            np.testing.assert_allclose(found, whole[part][:count], rtol=0, atol=ROUNDING)
    assert joint_motion.transforms._cache_size() == before


def test_what_is_computed_on_the_host_is_what_a_program_computes(arm, angles):
    """With a pose that is not known, which leaves only the parts before it."""
    columns = displacements(arm, angles.at[1, 2].set(jnp.nan))
    on_host = part_transforms(arm.linkage, columns)
    compiled = joint_motion.transforms(arm.linkage.structure, arm.linkage.joints, columns)
    known = {part: bool(np.isfinite(place[2]).all()) for part, place in zip(arm.parts, on_host, strict=True)}
    assert known == {"base": True, "arm": True, "elbow": False, "lamp": False, "hand": False}
    for one, other in zip(on_host, compiled, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=ROUNDING)


def test_few_poses_of_known_numbers_compile_nothing(arm, angles):
    part_transforms(arm.linkage, displacements(arm, angles))
    before = joint_motion.transforms._cache_size()
    for poses in (1, 3, 4, 100, joint_motion.MAX_HOST_POSES):
        part_transforms(arm.linkage, displacements(arm, jnp.zeros((3, poses))))
    assert joint_motion.transforms._cache_size() == before
