"""Cams with profiles against closed forms: eccentric discs, and profiles computed from the law that they give back."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference import higher_pairs

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 4 * np.pi, 49)
RADIUS, OFF = 25.0, 8.0
POINTS = 360
SPLINE = 1e-8
"""A spline through 360 points of a disc is off by its radius times h^4 / 384, with h = 2 pi / 360: 6e-9; a part of the
follower's displacement that grows with the pressure angle."""


def cam_of(profile, follower, guide, point2, names=("ground", "cam", "follower"), **more):
    """A cam on a shaft in the origin, its follower guided by a joint to the ground."""
    ground, wheel, other = names
    return jk.Mechanism.build(
        fixed=[ground],
        joints=[
            jk.revolute("shaft", ground, wheel, point=(0, 0, 0), axis=Z),
            jk.cam("contact", wheel, other, profile=profile, follower=follower, point2=point2, **more),
            guide,
        ],
        unit="mm",
    )


def sliding(follower, offset=3.0, profile=None):
    """An eccentric disc as in `higher_pairs.cam_roller_follower`, whose follower slides along y."""
    profile = higher_pairs.disc_profile(POINTS) if profile is None else profile
    guide = jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0))
    if follower == "flat":
        return cam_of(profile, "flat", guide, (0, RADIUS, 0), direction2=(1, 0, 0))
    roller = 6.0 if follower == "roller" else 0.0
    height = float(higher_pairs.cam_roller_follower(np.zeros(()), roller=roller, offset=offset))
    return cam_of(profile, follower, guide, (offset, height, 0), **({"radius": roller} if roller else {}))


def swinging(follower):
    """An eccentric disc whose follower swings about a pivot, as in `higher_pairs.cam_roller_arm`."""
    pivot, arm = np.array([40.0, 0.0, 0.0]), 35.0
    guide = jk.revolute("guide", "ground", "follower", point=pivot, axis=Z)
    profile = higher_pairs.disc_profile(POINTS)
    if follower == "flat":
        angle = higher_pairs.cam_flat_arm(np.zeros(()))
        along = (np.cos(angle), np.sin(angle), 0)
        return cam_of(profile, "flat", guide, pivot, direction2=along)
    roller = 6.0 if follower == "roller" else 0.0
    angle = higher_pairs.cam_roller_arm(np.zeros(()), roller=roller)
    tip = pivot + arm * np.array([np.cos(angle), np.sin(angle), 0])
    return cam_of(profile, follower, guide, tip, **({"radius": roller} if roller else {}))


def slide_law(follower, offset=3.0):
    roller = 6.0 if follower == "roller" else 0.0
    if follower == "flat":
        return lambda theta: RADIUS + OFF * jnp.sin(theta)
    return lambda theta: OFF * jnp.sin(theta) + jnp.sqrt((RADIUS + roller) ** 2 - (OFF * jnp.cos(theta) - offset) ** 2)


def swing_law(follower):
    if follower == "flat":
        return lambda theta: higher_pairs.cam_flat_arm(theta, jnp)
    return lambda theta: higher_pairs.cam_roller_arm(theta, jnp, roller=6.0 if follower == "roller" else 0.0)


CASES = [(sliding, slide_law), (swinging, swing_law)]


@pytest.mark.long
@pytest.mark.parametrize("make, law_of", CASES, ids=["sliding", "swinging"])
@pytest.mark.parametrize("follower", ["knife", "roller", "flat"])
def test_eccentric_discs(make, law_of, follower):
    mechanism, law = make(follower), law_of(follower)
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], law(TURN) - law(0.0), atol=SPLINE)
    # two turns of the shaft are two lengths of the profile, and everything else as before
    turned = np.asarray(motion.coordinates["contact"])
    np.testing.assert_allclose(turned[-1], [-2 * length_of(mechanism), 0.0], atol=1e-10)
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms) == (1, 0)
    assert jk.curve_contacts(motion).holds
    assert "lost" not in str(motion) and "curve contact" not in str(motion)


def length_of(mechanism, joint="contact"):
    return float(mechanism.joints[joint].splines[0].knots[-1])


@pytest.mark.long
@pytest.mark.parametrize("make, law_of", CASES, ids=["sliding", "swinging"])
@pytest.mark.parametrize("follower", ["roller", "flat"])
def test_velocities_and_accelerations(make, law_of, follower):
    motion = make(follower).sweep({"shaft": TURN[::6]}, throw=True)
    rate, speed = law_of(follower), 3.0
    first, second = jax.vmap(jax.grad(rate)), jax.vmap(jax.grad(jax.grad(rate)))
    theta = jnp.asarray(TURN[::6])
    found = jk.velocities(motion, {"shaft": speed}).coordinates["guide"][:, 0]
    # the tangent of the spline is right to the third order in the distance of the points: 1e-6 of the radius
    np.testing.assert_allclose(found, speed * first(theta), atol=1e-5)
    found = jk.accelerations(motion, {"shaft": speed}).coordinates["guide"][:, 0]
    # its curvature to the second order: h^2 / 12 = 2.5e-5 of accelerations of 72 radii
    np.testing.assert_allclose(found, speed**2 * second(theta), atol=2.5e-5 * 9 * 31)


@pytest.mark.long
def test_many_turns_are_one_turn_again():
    mechanism, law = sliding("roller"), slide_law("roller")
    far = np.linspace(0.0, 80 * np.pi, len(TURN))  # most of a turn a step
    motion = mechanism.sweep({"shaft": far}, throw=True)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], law(far) - law(0.0), atol=SPLINE)
    # rounding of forty turns of 157 mm
    assert float(motion.coordinates["contact"][-1, 0]) == pytest.approx(-40 * length_of(mechanism), rel=1e-12)


@pytest.mark.long
def test_a_roller_that_is_a_part_spins_by_itself():
    height = float(higher_pairs.cam_roller_follower(np.zeros(())))
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.cam(
                "contact",
                "cam",
                "roller",
                profile=higher_pairs.disc_profile(POINTS),
                follower="roller",
                radius=6.0,
                point2=(3, height, 0),
            ),
            jk.revolute("pin", "follower", "roller", point=(3, height, 0), axis=Z),
            jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        ],
    )
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms) == (2, 1)
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    law = slide_law("roller")
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], law(TURN) - law(0.0), atol=SPLINE)


@pytest.mark.long
def test_a_flat_follower_is_the_contact_state_of_a_cylinder_on_a_plane():
    """State (b) of the paper, with frames as Table 1 has them: the round face on the cam, the plane on the follower."""
    height = RADIUS + OFF * np.sin(0.7)
    centre = OFF * np.array([np.cos(0.7), np.sin(0.7), 0])
    plane = np.eye(4)
    plane[:3, :3] = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    mechanism = cam_of(
        higher_pairs.disc_profile(POINTS, angle=0.7),
        "flat",
        jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        (-4.0, height, 0),
        direction2=(1, 0, 0),
    )
    other = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.revolute("disc", "cam", "washer", point=centre, axis=Z),
            jk.prismatic("face", "washer", "follower", axis=(1, 0, 0)),
            jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        ],
    )
    one, two = (each.sweep({"shaft": TURN}, throw=True) for each in (mechanism, other))
    np.testing.assert_allclose(one.coordinates["guide"], two.coordinates["guide"], atol=SPLINE)


def law_and_rate(count):
    """A cycloidal rise of 12 over a quarter turn, a dwell, a fall, a dwell: smooth but for its jerk."""
    lift = jk.motion_law([("cycloidal", 0.5 * np.pi, 12.0), ("dwell", 0.5 * np.pi), ("cycloidal", 0.5 * np.pi, -12.0)])
    angles = 2 * np.pi * np.arange(count) / count

    def of(order):
        return lambda angle: np.asarray(lift(np.mod(angle, 2 * np.pi), order))

    return of(0), of(1), angles


@pytest.mark.long
@pytest.mark.parametrize("follower", ["flat", "roller"])
def test_a_profile_gives_back_the_law_that_it_was_computed_from(follower):
    """To the error of the spline, of the fourth order in the distance of its points."""
    base, roller, errors = 40.0, 8.0, []
    turn = np.linspace(0.1, 2 * np.pi, 100)
    for count in (48, 96, 192):
        lift, rate, angles = law_and_rate(count)
        guide = jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0))
        if follower == "flat":
            profile = higher_pairs.flat_cam_of(lift, rate, angles, base)
            mechanism = cam_of(profile, "flat", guide, (0, base, 0), direction2=(1, 0, 0))
        else:
            profile = higher_pairs.roller_cam_of(lift, rate, angles, base, roller)
            mechanism = cam_of(profile, "roller", guide, (0, base + roller, 0), radius=roller)
        motion = mechanism.sweep({"shaft": turn}, throw=True)
        errors.append(np.abs(np.asarray(motion.coordinates["guide"])[:, 0] - lift(turn)).max())
        assert jk.curve_contacts(motion).holds
    # measured: 4e-6 with 192 points, orders 3.8 to 4.6
    assert errors[-1] < 1e-5
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 3.5)
