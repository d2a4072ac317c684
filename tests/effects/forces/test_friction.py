"""Coulomb friction in joints against closed forms, balances of power and the two routes to the drive force.

Tolerances: closed forms to 1e-9 of the force, rounding times the condition of the balance, 1e3 to 1e5; the balance of
power to 1e-9 of the largest power, whose energies are differentiated by Fourier sums of 64 poses.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import FOURBAR_MASSES, GRAVITY, by_time, energies, fourbar, whole_turn
from reference.mechanisms import Z, rssr_linkage, slider_crank
from reference.planar import slider_crank as slider_crank_angles

PITCH, RADIUS, MU = 4.0, 6.0, 0.15
LEAD = np.arctan(PITCH / (2 * np.pi * RADIUS))
RHO = np.arctan(MU)


def jack() -> jk.Mechanism:
    """A spindle that turns in the base, and a nut on its thread that slides up and down."""
    return jk.Mechanism.build(
        fixed=["base"],
        unit="mm",
        joints=[
            jk.prismatic("P", "base", "nut", axis=Z),
            jk.revolute("R", "base", "spindle", point=(0, 0, 0), axis=Z),
            jk.screw("S", "spindle", "nut", point=(0, 0, 0), axis=Z, pitch=PITCH),
        ],
    )


def block() -> jk.Mechanism:
    """A block on a plane that rises by 30 degrees along x."""
    along = (np.cos(np.pi / 6), 0.0, np.sin(np.pi / 6))
    return jk.Mechanism.build(fixed=["base"], unit="mm", joints=[jk.prismatic("P", "base", "block", axis=along)])


@pytest.mark.long
def test_a_block_on_an_incline_and_what_it_says_at_rest():
    """F = m g (sin a +- mu cos a); without sliding there is no direction, which is said with what friction may hold."""
    motion = block().sweep({"P": np.array([0.0, 1.0, 2.0])})
    own = jk.masses(motion.mechanism, given={"block": jk.Mass(3.0, (0, 0, 0))})
    found = jk.drive_forces(motion, own, applied=jk.joint_friction("P", 0.2), rates={"P": np.array([50.0, 0.0, -50.0])})
    push = 3.0 * 9.81 * (0.5 + 0.2 * np.cos(np.pi / 6) * np.array([1.0, 0.0, -1.0]))
    np.testing.assert_allclose(found.forces["P.z"], push, rtol=1e-12)
    np.testing.assert_array_equal(found.friction.rests["P"], [False, True, False])
    np.testing.assert_allclose(found.friction.most["P"], 3.0 * 9.81 * 0.2 * np.cos(np.pi / 6), rtol=1e-12)
    np.testing.assert_allclose(found.friction.losses["P"], 0.05 * 5.097426 * np.array([1, 0, 1]), rtol=1e-6)
    assert "P does not slide in 1 pose, first 1: its friction is taken as zero there, and may be up to 5.097 N" in str(
        found
    )


@pytest.mark.long
def test_a_block_whose_friction_fades():
    """With smooth = v0 the friction is multiplied by v / sqrt(v^2 + v0^2)."""
    motion = block().sweep({"P": np.zeros(3)})
    own = jk.masses(motion.mechanism, given={"block": jk.Mass(3.0, (0, 0, 0))})
    rates = np.array([30.0, 0.0, -40.0])
    found = jk.drive_forces(motion, own, applied=jk.joint_friction("P", 0.2, smooth=40.0), rates={"P": rates})
    share = np.array([0.6, 0.0, -np.sqrt(0.5)])
    np.testing.assert_allclose(found.forces["P.z"], 3.0 * 9.81 * (0.5 + 0.2 * np.cos(np.pi / 6) * share), rtol=1e-12)


def test_friction_that_fades_has_a_derivative_where_nothing_slides():
    """Near rest friction is mu N v / v0: its derivative by the velocity is mu N / v0, also where that is zero."""
    motion = block().sweep({"P": np.zeros(3)})
    own = jk.masses(motion.mechanism, given={"block": jk.Mass(3.0, (0, 0, 0))})

    def push(rate):
        fades = jk.joint_friction("P", 0.2, smooth=40.0)
        return jk.drive_forces(motion, own, applied=fades, rates={"P": jnp.full(3, rate)}).forces["P.z"][0]

    expected = 3.0 * 9.81 * 0.2 * np.cos(np.pi / 6) / 40.0
    np.testing.assert_allclose(jax.grad(push)(0.0), expected, rtol=1e-12)


@pytest.mark.long
def test_a_lead_screw_lifts_by_the_formula_of_the_textbooks_and_locks_itself():
    """T = W r tan(lead +- rho); pushed by its nut it moves only where rho < lead: F = T / (r tan(lead - rho)).

    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 8-2, with a square thread and no collar.
    """
    thread = jk.joint_friction("S", MU, radius=RADIUS)
    motion = jack().sweep({"R": np.linspace(0, 1, 4)})
    weight = jk.force("nut", (0, 0, 0), (0, 0, -500.0))
    for way in (1.0, -1.0):  # a right-handed spindle that turns forward lowers the nut
        rates = {"R": -way}
        found = jk.drive_forces(motion, applied=[weight, thread], rates=rates)
        torque = 500.0 * 1e-3 * RADIUS * np.tan(LEAD + way * RHO)
        np.testing.assert_allclose(found.forces["R.phi"], -torque, rtol=1e-9)
        assert not found.friction.locked.any()
    found = jk.drive_forces(motion, applied=[weight, thread], rates={"R": -1.0})
    lifted = 500.0 * 1e-3 * PITCH / (2 * np.pi)
    np.testing.assert_allclose(lifted / found.power, np.tan(LEAD) / np.tan(LEAD + RHO), rtol=1e-9)
    pushed = jack().sweep({"P": np.linspace(0, 1, 4)})
    found = jk.drive_forces(pushed, applied=[jk.torque("spindle", (0, 0, 2.0)), thread], rates={"P": 1.0})
    assert found.friction.locked.all() and np.isnan(found.forces["P.z"]).all()
    assert "locks by friction in 4 poses, first 0" in str(found)
    found = jk.reactions(pushed, applied=[jk.torque("spindle", (0, 0, 2.0)), thread], rates={"P": 1.0})
    assert np.isnan(found.forces["S"]).all() and np.isnan(found.drives["P.z"]).all()
    little = jk.joint_friction("S", 0.05, radius=RADIUS)
    for way in (1.0, -1.0):  # against the torque, and let down by it
        found = jk.drive_forces(pushed, applied=[jk.torque("spindle", (0, 0, way * 2.0)), little], rates={"P": 1.0})
        force = 2.0 / (1e-3 * RADIUS * np.tan(LEAD - way * np.arctan(0.05)))
        np.testing.assert_allclose(found.forces["P.z"], way * force, rtol=1e-9)
        assert not found.friction.locked.any()


@pytest.mark.long
def test_a_slider_crank_whose_slide_has_friction():
    """The rod is a two-force member: S (cos b - mu sgn(S v) |sin b|) = -P, torque = S (r x u) for the unit vector u."""
    theta = 1.0 + whole_turn()
    at = slider_crank_angles(theta)
    mechanism = replace(slider_crank(), unit="mm")
    motion = mechanism.sweep({"A": whole_turn()})
    pin = np.asarray(mechanism.joints["C"].frames_1[0][:3, 3])
    given = [jk.force("slider", pin, (-800.0, 0.0, 0.0)), jk.joint_friction("S", 0.3)]
    found = jk.drive_forces(motion, applied=given, rates={"A": 2.0})
    r = 40.0 * np.array([np.cos(theta), np.sin(theta)])
    u = np.array([np.cos(at.rod), np.sin(at.rod)])
    v = -r[1] + r[0] * u[1] / u[0]  # dx/dtheta of the slider: the rod keeps its length
    size = 800.0 / (u[0] - 0.3 * np.sign(v) * np.abs(u[1]))
    torque = 1e-3 * size * (r[0] * u[1] - r[1] * u[0])
    np.testing.assert_allclose(found.forces["A.phi"], torque, atol=1e-9 * np.abs(torque).max())
    np.testing.assert_allclose(found.friction.normal["S"], np.abs(size * u[1]), atol=1e-8 * size.max())
    joints = jk.reactions(motion, applied=given, rates={"A": 2.0})
    np.testing.assert_allclose(joints.drives["A.phi"], torque, atol=1e-9 * np.abs(torque).max())
    np.testing.assert_allclose(joints.forces["S"][:, 0], -0.3 * np.sign(v) * np.abs(size * u[1]), atol=1e-6)


@pytest.mark.long
def test_power_goes_into_energy_and_friction():
    """Over a whole turn: energies from paths of points, losses mu r |F| |rate| from reactions and joint rates."""
    motion = fourbar().sweep({"A": whole_turn()})
    masses = jk.masses(motion.mechanism, given=FOURBAR_MASSES)
    friction = [
        jk.joint_friction(name, mu, radius=r) for name, mu, r in (("A", 0.1, 9.0), ("B", 0.2, 6.0), ("D", 0.15, 8.0))
    ]
    given = {"gravity": GRAVITY, "applied": friction, "rates": {"A": 7.0}}
    found, joints = jk.drive_forces(motion, masses, **given), jk.reactions(motion, masses, **given)
    kinetic, potential = energies(motion, FOURBAR_MASSES, 7.0)
    rates = dict(zip(motion.mechanism.joints, jk.velocities(motion, {"A": 7.0}).displacements, strict=True))
    lost = sum(
        each.coefficient
        * 1e-3
        * each.radius
        * np.linalg.norm(joints.forces[each.joint], axis=1)
        * np.abs(rates[each.joint][:, 0])
        for each in friction
    )
    expected = by_time(kinetic + potential, 7.0) + lost
    np.testing.assert_allclose(found.power, expected, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(sum(found.friction.losses.values()), lost, rtol=1e-8)
    np.testing.assert_allclose(joints.drives["A.phi"], found.forces["A.phi"], atol=1e-8 * np.abs(expected).max())
    assert lost.max() > 0.05 * np.abs(expected).max()  # friction is no small change here
    assert [(each.joint, each.components) for each in found.friction.undetermined] == [
        (name, ("force z",)) for name in "ABD"
    ]


@pytest.mark.long
def test_a_ball_with_friction_by_two_routes():
    """Virtual work along the angles of the ball, and the balance with turns about the axes of the world.

    The other ball of the RSSR is a universal joint: a rod that may spin would be held by the balance alone.
    """
    whole = rssr_linkage()
    a, b, c, d = whole.joints.values()
    rod = np.asarray(c.frames_1[0][:3, 3] - b.frames_1[0][:3, 3])
    across = np.cross(rod, (0.2, 0.9, 0.3))
    cross = jk.universal("C", "rod", "rocker", point=c.frames_1[0][:3, 3], axis1=across, axis2=np.cross(across, rod))
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=[a, b, cross, d], unit="mm")
    motion = mechanism.sweep({"A": np.linspace(0, 2, 9)})
    given = [jk.torque("rocker", (0.5, 2.0, 0.3)), jk.force("rod", (40, 20, 10), (3.0, -20.0, 10.0))]
    given += [jk.joint_friction(name, 0.2, radius=9.0) for name in "BD"]
    found = jk.drive_forces(motion, applied=given, rates={"A": 3.0})
    joints = jk.reactions(motion, applied=given, rates={"A": 3.0})
    np.testing.assert_allclose(joints.drives["A.phi"], found.forces["A.phi"], rtol=1e-7)
    without = jk.drive_forces(motion, applied=given[:2], rates={"A": 3.0})
    # all that friction takes comes from the drive, as nothing else differs
    np.testing.assert_allclose(found.power - without.power, sum(found.friction.losses.values()), rtol=1e-7)
    assert (found.friction.losses["B"] > 1e-3).all()


@pytest.mark.long
def test_derivatives_are_differences():
    motion = fourbar().sweep({"A": np.linspace(0, 1, 5)})
    masses = jk.masses(motion.mechanism, given=FOURBAR_MASSES)

    def torque(mu, radius):
        friction = [jk.joint_friction("B", mu, radius=radius), jk.joint_friction("D", 0.2, radius=5.0)]
        return jnp.sum(jk.drive_forces(motion, masses, applied=friction, rates={"A": 7.0}).forces["A.phi"] ** 2)

    got = jax.jit(jax.grad(torque, argnums=(0, 1)))(0.3, 8.0)
    for slope, step, plus, minus in (
        (got[0], 1e-5, (0.3 + 1e-5, 8.0), (0.3 - 1e-5, 8.0)),
        (got[1], 1e-4, (0.3, 8.0 + 1e-4), (0.3, 8.0 - 1e-4)),
    ):
        # central differences: their error is the square of the step
        np.testing.assert_allclose(slope, (torque(*plus) - torque(*minus)) / (2 * step), rtol=1e-6)


def test_wrong_friction_says_what_to_write():
    motion = block().sweep({"P": np.linspace(0, 1, 3)})
    load = jk.force("block", (0, 0, 0), (0, 0, -5.0))

    def forces(*friction, rates=None):
        jk.drive_forces(motion, applied=[load, *friction], rates=rates or {"P": 1.0})

    with pytest.raises(ValueError, match=r"there is no joint 'Q' to have friction.*'P'"):
        forces(jk.joint_friction("Q", 0.1))
    with pytest.raises(ValueError, match="friction of 'P' is given twice"):
        forces(jk.joint_friction("P", 0.1), jk.joint_friction("P", 0.2))
    with pytest.raises(ValueError, match="'P' is prismatic and does not turn: leave out the radius"):
        forces(jk.joint_friction("P", 0.1, radius=3))
    with pytest.raises(ValueError, match=r"friction has no direction at rest, and 'P' has friction: give rates="):
        jk.drive_forces(motion, applied=[load, jk.joint_friction("P", 0.1)])
    with pytest.raises(ValueError, match="nothing acts"):
        jk.drive_forces(motion, applied=jk.joint_friction("P", 0.1), rates={"P": 1.0})
    turning = jk.Mechanism.build(fixed=["base"], joints=[jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)])
    with pytest.raises(ValueError, match=r"needs the radius .*jk.joint_friction\('A', 0.2, radius=5\)"):
        jk.drive_forces(
            turning.sweep({"A": np.linspace(0, 1, 3)}),
            applied=[jk.torque("arm", (0, 0, 1)), jk.joint_friction("A", 0.2)],
            rates={"A": 1.0},
        )
    with pytest.raises(
        ValueError, match=r"the coefficient of the friction of 'P' must be one number from 0 on, got -1"
    ):
        jk.joint_friction("P", -1)
    with pytest.raises(ValueError, match="the radius of the friction of 'P' must be above zero"):
        jk.joint_friction("P", 0.1, radius=0)


@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
@pytest.mark.parametrize("x64", [True, False])
def test_a_small_hinge_of_a_large_mechanism_rubs(x64):
    """The weight m g of what hangs on a hinge gives mu m g r, whatever the size of the rest; forces to single precision
    of the torque of the large arm."""
    with jax.enable_x64(x64):
        hinges = [
            jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "arm", "bob", point=(3000, 0, 0), axis=Z),
        ]
        large = jk.Mechanism.build(fixed=["base"], unit="mm", joints=hinges)
        own = jk.masses(large, given={"arm": 0, "bob": jk.Mass(10.0, centre=(3000, 0, 0))})
        motion = large.sweep({"A": np.zeros(3), "B": np.zeros(3)})
        rubs, rates = jk.joint_friction("B", 0.2, radius=1.0), {"A": 1e-3, "B": 1e-4}
        found = jk.drive_forces(motion, own, gravity=(0, -9.81, 0), rates=rates, applied=rubs)
    assert not np.any(found.friction.rests["B"])
    np.testing.assert_allclose(found.forces["B.phi"], 0.2 * 10 * 9.81 * 1e-3, rtol=1e-3)
