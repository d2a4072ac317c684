"""The rotations of contact states (d), (j), (n), (o), (p) never lock: half a turn about any axis, and on."""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import frame, rotation, unit
from jaxkin.geometry.rigid import as_matrices
from jaxkin.linkage.joint_motion import joint_motion

X, Y, Z = np.eye(3)
ORIGIN = np.zeros(3)
CENTRE = np.array([1.2, 0.4, 0.7])
CONTACT = np.array([0.5, -0.3, 0.2])
"""Of a ball on a cone with its apex at the origin, on the ruling through it."""

FRAMES = {
    "d": [frame(X - Y, Z), frame(CENTRE, Z, X + Y)],
    "j": [frame(0.1 * Z, Z), frame(CENTRE, Z)],
    "n": [frame(ORIGIN, Z), frame(CONTACT, -CONTACT), frame(CENTRE, Z)],
    "o": [frame(CENTRE, Z)],
    "p": [frame(ORIGIN, CENTRE), frame(CENTRE, CENTRE, Y)],
}
"""By Table 1; what it leaves free is chosen at will: origins on a plane or an axis, x axes."""

AXES = {"x": X, "y": Y, "z": Z, "oblique": unit(np.array([1.0, -2.0, 0.5])), "other": unit(np.array([-0.3, 0.4, 0.8]))}
TURN = np.concatenate([np.linspace(0.0, np.pi, 25), [np.pi / 2 - 1e-9, np.pi / 2 + 1e-7, 1.5 * np.pi, 2 * np.pi]])


def ball(state, axis, about):
    """A ball in contact with the ground, which a hinge on the ground turns about an axis through a point."""
    contact = jk.contact_joint("touch", "ground", "ball", state=state, frames=FRAMES[state])
    hinge = jk.revolute("hinge", "ground", "ball", point=about, axis=axis)
    return jk.Mechanism.build(fixed=["ground"], joints=[hinge, contact])


def displacement(axis, about, angles):
    """Closed form: the turn about the axis through the point."""
    poses = np.tile(np.eye(4), (len(angles), 1, 1))
    for pose, angle in zip(poses, angles, strict=True):
        pose[:3, :3] = rotation(axis, angle)
        pose[:3, 3] = about - pose[:3, :3] @ about
    return poses


LONG = [pytest.param(state, CENTRE, marks=pytest.mark.long) for state in "jnop"]


@pytest.mark.long
@pytest.mark.parametrize(("state", "point"), [("d", CENTRE), ("p", ORIGIN), *LONG])
def test_a_ball_turned_about_any_axis_solves_as_well_as_at_the_start(state, point):
    """About its own centre, and, on a ball, about the centre of that: the line of centres turns as well."""
    for axis in AXES.values():
        mechanism = ball(state, axis, point)
        motion = mechanism.sweep({"hinge": TURN})
        assert bool(jnp.all(motion.closed))
        assert float(motion.residual.max()) < 1e-13
        # the coordinates of the contact, put into the paper's matrices, give the turn: to rounding, at the lock too
        found = as_matrices(joint_motion(mechanism.joints["touch"], motion.coordinates["touch"]))
        np.testing.assert_allclose(found, displacement(axis, point, TURN), atol=2e-14)
        # the Jacobian keeps its rank
        np.testing.assert_array_less(0.5 * motion.sigma_min[0], motion.sigma_min)
