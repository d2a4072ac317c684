"""Joints by hand: their movements by the paper's conventions, and what is refused."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk


def moved(joint, values, point):
    """Where a point of part 2 goes for single displacements of the joint's coordinates."""
    mechanism = jk.Mechanism.build(fixed=["base"], joints=[joint])
    drive = {f"{joint.name}.{name}": [value] for name, value in zip(joint.coordinates, values, strict=True)}
    return np.asarray(mechanism.sweep(drive).points("part", point))[0]


@pytest.mark.parametrize(
    "joint, values, point, expected",
    [
        # right-hand rule about the axis through the point, positive along it
        (jk.revolute("j", "base", "part", point=(1, 0, 5), axis=(0, 0, 2)), [np.pi / 2], (2, 0, 0), (1, 1, 0)),
        (jk.prismatic("j", "base", "part", axis=(0, 3, 0)), [2.0], (1, 1, 1), (1, 3, 1)),
        (jk.cylindrical("j", "base", "part", point=(0, 0, 0), axis=(0, 0, 1)), [3.0, np.pi], (1, 0, 0), (-1, 0, 3)),
        (jk.screw("j", "base", "part", point=(0, 0, 0), axis=(0, 0, 1), pitch=4), [np.pi], (1, 0, 0), (-1, 0, 2)),
        # Rz(psi) Ry(phi) Rx(theta), and Ry(phi) Rx(theta) with y along axis 1
        (jk.spherical("j", "base", "part", point=(0, 0, 0)), [np.pi / 2, 0, np.pi / 2], (0, 1, 0), (0, 0, 1)),
        (
            jk.universal("j", "base", "part", point=(0, 0, 0), axis1=(0, 1, 0), axis2=(1, 0, 0)),
            [np.pi / 2, np.pi / 2],
            (0, 1, 0),
            (1, 0, 0),
        ),
        # slides along x, which the direction says, and y = z x x; then the turn about z, moved with them
        (jk.rectangular("j", "base", "part", normal=(0, 0, 1), direction=(0, 1, 0)), [2, 3], (0, 0, 1), (-3, 2, 1)),
        (jk.rectangular("j", "base", "part", normal=(0, 0, 4), point=(7, 8, 9)), [2, 3], (0, 0, 0), (2, 3, 0)),
        (jk.cartesian("j", "base", "part"), [1, 2, 3], (1, 1, 1), (2, 3, 4)),
        (jk.cartesian("j", "base", "part", axis=(1, 0, 0), direction=(0, 1, 0)), [1, 2, 3], (0, 0, 0), (3, 1, 2)),
        (jk.schoenflies("j", "base", "part", axis=(0, 0, 1)), [4, 5, 6, np.pi / 2], (1, 0, 0), (4, 6, 6)),
        (jk.schoenflies("j", "base", "part", axis=(0, 0, 1), point=(1, 0, 0)), [4, 5, 6, np.pi], (0, 0, 0), (6, 5, 6)),
        # D = T Rz(phi1) Rx(phi2): y goes to z, and stays there
        (
            jk.constant_angle("j", "base", "part", axis1=(0, 0, 1), axis2=(1, 0, 0)),
            [1, 2, 3, np.pi / 2, np.pi / 2],
            (0, 1, 0),
            (1, 2, 4),
        ),
        (
            jk.constant_angle("j", "base", "part", axis1=(0, 0, 1), axis2=(1, 0, 0)),
            [1, 2, 3, np.pi / 2, np.pi / 2],
            (1, 0, 0),
            (1, 3, 3),
        ),
    ],
)
def test_movements(joint, values, point, expected):
    np.testing.assert_allclose(moved(joint, values, point), expected, atol=1e-15)


def test_full_names_are_the_inputs_of_a_sweep():
    joint = jk.spherical("ball", "base", "part", point=(0, 0, 0))
    assert joint.full_names == ("ball.theta", "ball.phi", "ball.psi")
    motion = jk.Mechanism.build(fixed=["base"], joints=[joint]).sweep({name: [0.0] for name in joint.full_names})
    assert tuple(motion.inputs) == joint.full_names


def test_a_planar_pair_moves_in_its_plane():
    joint = jk.planar("j", "base", "part", normal=(1, 2, 2), point=(0, 0, 4))
    end = moved(joint, [0.3, -0.7, 1.1], (5, 6, 7))
    assert (end - [5, 6, 7]) @ np.array([1, 2, 2]) == pytest.approx(0, abs=1e-14)


def test_a_joint_of_constant_angle_keeps_the_angle_of_its_axes():
    """cos = axis1 . R axis2 for all displacements; rounding of double precision."""
    axis1, axis2 = np.array([1.0, 2.0, 2.0]) / 3, np.array([0.0, 0.6, 0.8])
    joint = jk.constant_angle("j", "base", "part", axis1=axis1, axis2=axis2, point=(3, 1, 2))
    assert joint.coordinates == ("x", "y", "z", "phi1", "phi2")
    values = [0.3, -0.7, 1.1, 0.9, -2.0]
    end = moved(joint, values, axis2) - moved(joint, values, (0, 0, 0))
    assert end @ axis1 == pytest.approx(axis2 @ axis1, abs=1e-14)


def test_a_fixed_joint_carries_its_part():
    joints = [
        jk.prismatic("slide", "base", "middle", axis=(1, 0, 0)),
        jk.fixed("weld", "middle", "part"),
    ]
    motion = jk.Mechanism.build(fixed=["base"], joints=joints).sweep({"slide": [2.0]})
    np.testing.assert_allclose(motion.points("part", (0, 0, 0)), [[2, 0, 0]])


def test_traced_numbers_build_the_same_joint():
    def frame(point, axis):
        return jk.revolute("j", "base", "part", point=point, axis=axis).frames_1

    def slides(point, axis, direction):
        return jk.schoenflies("j", "base", "part", point=point, axis=axis, direction=direction).frames_1

    point, axis, across = jnp.array([1.0, 2.0, 3.0]), jnp.array([0.3, -0.5, 0.2]), jnp.array([0.5, 0.3, 0.0])
    np.testing.assert_allclose(jax.jit(frame)(point, axis), frame(point, axis), atol=1e-15)
    np.testing.assert_allclose(
        jax.jit(slides)(point, axis, across), slides(*map(np.asarray, (point, axis, across))), atol=1e-15
    )


def test_joints_between_two_parts_in_either_order():
    joints = [
        jk.planar("flat", "base", "part", normal=(0, 0, 1)),
        jk.cylindrical("pin", "part", "base", point=(0, 0, 0), axis=(0, 0, 1)),
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=joints)
    assert mechanism.joints_between("base", "part") == mechanism.joints_between("part", "base") == ("flat", "pin")
    assert mechanism.joints["pin"].coordinates == ("z", "phi")
    assert mechanism.mobility().freedoms == 1  # Eq. (1): a pin with a touching side face is a hinge


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: jk.revolute("j", "a", "b", point=(0, 0, 0), axis=(0, 0, 0)), "joint 'j': axis must be a direction"),
        (lambda: jk.revolute("j", "a", "b", point=(0, 0), axis=(0, 0, 1)), "point must be three finite numbers"),
        (lambda: jk.planar("j", "a", "b", normal=(0, 0, np.nan)), "normal must be three finite numbers"),
        (
            lambda: jk.universal("j", "a", "b", point=(0, 0, 0), axis1=(1, 0, 0), axis2=(1, 1, 0)),
            "must be perpendicular, the cosine between them is 0.707",
        ),
        (
            lambda: jk.constant_angle("j", "a", "b", axis1=(1, 0, 0), axis2=(-2, 0, 0)),
            r"axis1 and axis2 are parallel, .* use jk\.schoenflies",
        ),
        (
            lambda: jk.rectangular("j", "a", "b", normal=(1, 0, 0), direction=(1, 1, 0)),
            "direction must be perpendicular to normal, the cosine between them is 0.707",
        ),
        (lambda: jk.contact_joint("j", "a", "b", state="q", frames=[np.eye(4)]), "a letter from 'a' to 'p'"),
        (lambda: jk.contact_joint("j", "a", "b", state="b", frames=[np.eye(4)]), r"\(b\) has 2 frames"),
        (lambda: jk.contact_joint("j", "a", "b", state="a", frames=[np.eye(3)]), "frames must be a list of 4x4 poses"),
        (
            lambda: jk.contact_joint("j", "a", "b", state="b", frames=[np.eye(4), np.diag([1.0, 1.0, -1.0, 1.0])]),
            "frame 2 is no rigid pose",
        ),
    ],
)
def test_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
