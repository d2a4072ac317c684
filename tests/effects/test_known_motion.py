"""Rates follow from poses that are known: the same as derivatives of a sweep, which finds them anew.

Tolerance: 1e-9 of the largest rate, rounding through the derivative of a pose or its second one, over `sigma_min`.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism.known_motion import follow, known_motion
from jaxkin.solve.options import options_with
from reference import catalogue, mechanisms
from reference.mechanisms import Z


def swept(motion, first, second):
    """Velocities and accelerations of joints and parts: the sweep is differentiated, and its poses are found anew."""

    def place(inputs):
        found = motion.mechanism.sweep(inputs, options=options_with(motion.options))
        return found.displacements, tuple(found.transforms.values())

    def velocity(inputs, tangents):
        return jax.jvp(place, (inputs,), (tangents,))[1]

    return jax.jvp(velocity, (motion.inputs, first), (first, second))


def geared():
    """A crank that a gear pair drives, and behind it a slider-crank: a coupling within the loop group."""
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("in", "ground", "pinion", point=(-60, 0, 0), axis=Z),
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "crank", "rod", point=(40, 10, 0), axis=Z),
            jk.revolute("C", "rod", "slider", point=(150, 0, 0), axis=Z),
            jk.prismatic("S", "ground", "slider", point=(150, 0, 0), axis=(1, 0, 0)),
        ],
        couplings=[jk.gear("in", "A", -1.5)],
    )


def on_ball():
    """A platform on three legs whose ball is driven by its three angles."""
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.spherical("ball", "ground", "arm", point=(0, 0, 0)),
            jk.spherical("end", "arm", "rod", point=(30, 5, 40)),
            jk.spherical("foot", "rod", "slider", point=(90, 0, 10)),
            jk.prismatic("rail", "ground", "slider", point=(90, 0, 10), axis=(1, 0, 0)),
        ],
    )


WAY = np.linspace(0.1, 0.9, 7)
SHORT = {"ground": 40.0, "crank": 20.0, "coupler": 25.0, "rocker": 30.0}
CASES = {
    "four-bar": (mechanisms.planar_fourbar, {"A": WAY}),
    "four-bar that does not turn": (lambda: mechanisms.planar_fourbar(1.0, **SHORT), {"A": 6 * WAY}),
    "RSSR": (mechanisms.rssr_linkage, {"A": WAY}),
    "Bennett": (mechanisms.bennett_linkage, {"A": WAY}),
    "Cardan": (mechanisms.cardan_shafts, {"in": WAY}),
    "ball in a bore": (mechanisms.ball_in_bore, {"A": WAY}),
    "Jansen": (catalogue.jansen, {"O": WAY}),
    "gears": (geared, {"in": WAY}),
    "driven ball": (on_ball, {"ball.theta": 0.2 * WAY, "ball.phi": -0.1 * WAY, "ball.psi": 0.3 * WAY}),
    "target": (catalogue.jansen, None),
}
SLOW = ("Jansen", "Bennett", "Cardan", "ball in a bore", "driven ball")


@pytest.mark.long
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.study] * (name in SLOW)) for name in CASES])
def test_rates_are_derivatives_of_the_sweep(name):
    make, drive = CASES[name]
    mechanism = make()
    if drive is None:
        angles = {"O": WAY}
        part = mechanism.joints["O"].parts[1]
        drive = {jk.orientation(part): np.asarray(mechanism.sweep(angles).transforms[part])[:, :3, :3]}
    motion = mechanism.sweep(drive)
    assert np.sum(motion.closed) > 2
    numbers = np.random.default_rng(3)
    first, second = ({each: jnp.asarray(numbers.normal(size=len(motion))) for each in motion.inputs} for _ in range(2))
    velocities, accelerations = jk.velocities(motion, first), jk.accelerations(motion, first, second)
    for found, (rows, matrices) in zip((velocities, accelerations), swept(motion, first, second), strict=True):
        for some, others in ((found.displacements, rows), (tuple(found.transforms.values()), matrices)):
            for one, other in zip(some, others, strict=True):
                np.testing.assert_allclose(one, other, atol=1e-9 * max(1.0, float(np.abs(other).max())))
    np.testing.assert_array_equal(accelerations.orders[0][0], velocities.displacements[0])


@pytest.mark.long
def test_rates_are_differentiated_with_respect_to_lengths():
    """As those of the sweep: through the poses, which follow the lengths, and through the equations at them."""
    mechanism = mechanisms.planar_fourbar(1.0)

    def rate(length, direct):
        motion = mechanism.with_lengths({("coupler", "B", "C"): length}).sweep({"A": WAY})
        ones = {"A.phi": jnp.ones(len(WAY))}
        if direct:
            return jnp.sum(jk.accelerations(motion, ones).coordinates["D"] ** 2)
        return jnp.sum(swept(motion, ones, jax.tree.map(jnp.zeros_like, ones))[1][0][3] ** 2)

    length = float(mechanism.lengths[("coupler", "B", "C")])
    one, other = (jax.grad(rate)(length, direct) for direct in (True, False))
    np.testing.assert_allclose(one, other, rtol=1e-9)
    step = 1e-4 * length
    np.testing.assert_allclose(one, (rate(length + step, True) - rate(length - step, True)) / (2 * step), rtol=1e-6)
    np.testing.assert_allclose(jax.jit(rate, static_argnums=1)(length, True), rate(length, True), rtol=1e-12)


@pytest.mark.long
def test_no_pose_is_found_anew():
    """Rates of displacements that no sweep would find: those at the far ends of a motion that was put together."""
    from jaxkin.solve.execution.compiler import compilations

    motion = mechanisms.rssr_linkage().sweep({"A": WAY})
    before = compilations()
    velocities = jk.velocities(motion, {"A": 1.0})
    assert compilations() == before
    rest = replace(motion, status=jnp.where(np.arange(7) == 3, jk.Status.UNREACHABLE.value, motion.status))
    rates = np.asarray(jk.velocities(rest, {"A": 1.0}).coordinates["D"])
    assert np.all(rates[3] == 0) and np.array_equal(
        np.delete(rates, 3, 0), np.delete(velocities.coordinates["D"], 3, 0)
    )


@pytest.mark.long
def test_balls_roll_on_planes_whose_frame_is_not_below_them():
    """Poses are read back as they are: the plane's origin may be anywhere on it, and the loop is cut at the ball."""
    plane, ball = (np.eye(4) for _ in range(2))
    plane[:3, 3], ball[:3, 3] = (40.0, -30.0, 0.0), (100.0, 20.0, 8.0)
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("hinge", "ground", "lever", point=(0, 0, 10), axis=(0.2, 1, 0.1)),
            jk.contact_joint("rolls", "lever", "slider", state="d", frames=[plane, ball]),
            jk.prismatic("rail", "ground", "slider", point=(100, 20, 8), axis=(0.1, 0.3, 1)),
        ],
        unit="mm",
    )
    motion = mechanism.sweep({"hinge": WAY}, throw=True)
    drive, known = known_motion(motion)
    for one, other in zip(follow(drive, known)({**motion.inputs}), motion.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11)  # rounding of some hundreds of millimetres
    centre = np.array([50.0, 10.0, 5.0])
    masses = jk.masses(mechanism, given={"lever": jk.Mass(0.4, centre=centre), "slider": 0.0})
    found = jk.reactions(motion, masses, gravity=(0, 0, 0), rates={"hinge": 3.0})
    sent = np.asarray(found.forces["hinge"]) - np.asarray(found.forces["rolls"])
    # on a circle about the hinge
    axis = np.array([0.2, 1, 0.1]) / np.linalg.norm([0.2, 1, 0.1])
    arm = 1e-3 * (np.asarray(motion.points("lever", centre)) - np.array([0, 0, 10.0]))
    np.testing.assert_allclose(sent, 0.4 * 9.0 * np.cross(axis, np.cross(axis, arm)), atol=1e-9)
