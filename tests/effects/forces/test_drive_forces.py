"""Drive forces against work by hand, closed forms and balances of power.

Tolerances: closed forms to 1e-10 relative, rounding through one derivative of the sweep; balances of power to 1e-9 of
the largest power, as their energies are differentiated by Fourier sums of 64 poses, whose last harmonics are below it.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import FOURBAR_MASSES, FOURBAR_SPRINGS, GRAVITY, by_time, energies, fourbar, whole_turn
from reference.mechanisms import Z, planar_fourbar, rssr_linkage, slider_crank
from reference.planar import fourbar as fourbar_angles
from reference.planar import slider_crank as slider_crank_angles

RATE = 7.0
TURN = whole_turn()


def loads_of_fourbar():
    """A spring, a damper, a spring in a joint, a torque and a force that turns: all kinds at once."""
    return [
        *FOURBAR_SPRINGS,
        jk.joint_load("B", 0.3),
        jk.torque("rocker", (0.1, 0.2, -0.6)),
        jk.force("coupler", (30.0, 60.0, 0.0), (5.0, -3.0, 2.0)),
    ]


@pytest.fixture(scope="module")
def found(motion, masses) -> jk.DriveForces:
    return jk.drive_forces(motion, masses, gravity=GRAVITY, applied=loads_of_fourbar(), rates={"A": RATE})


@pytest.mark.long
def test_a_rocker_torque_through_the_velocity_ratio_of_norton(motion):
    """w4 / w2 = a sin(t2 - t3) / (c sin(t4 - t3)), Norton, Design of Machinery, section 6.7."""
    theta = 1.0 + TURN
    at = fourbar_angles(theta)
    ratio = 40.0 * np.sin(theta - at.coupler) / (80.0 * np.sin(at.rocker - at.coupler))
    for load in (
        jk.joint_load("D", 2.5),
        jk.torque("rocker", (0, 0, 2.5)),
        jk.torque("rocker", 2.5 * np.eye(3)[2], turns=True),
    ):
        forces = jk.drive_forces(motion, applied=load).forces["A.phi"]
        np.testing.assert_allclose(forces, -2.5 * ratio, rtol=1e-10, atol=1e-10)


@pytest.mark.long
def test_weight_and_piston_force_of_a_slider_crank():
    """Torque = dV/dtheta with V the potential of weights; piston force times the velocity ratio dx/dtheta."""
    mechanism = replace(slider_crank(), unit="mm")
    theta = 1.0 + TURN
    at = slider_crank_angles(theta)
    turning = -40.0 * np.cos(theta) / (120.0 * np.cos(at.rod))  # rate of the rod's angle, by 40 sin + 120 sin = offset
    motion = mechanism.sweep({"A": TURN})
    start = np.array([40 * np.cos(1.0), 40 * np.sin(1.0), 0.0])
    pin = np.asarray(mechanism.joints["C"].frames_1[0][:3, 3])
    given = {
        "crank": jk.Mass(2.0, 0.3 * start),
        "rod": jk.Mass(1.0, start + 0.4 * (pin - start)),
        "slider": jk.Mass(5.0, pin),
    }
    forces = jk.drive_forces(motion, jk.masses(mechanism, given=given), gravity=(0, -9.81, 0)).forces["A.phi"]
    lifted = 2.0 * 0.3 * 40 * np.cos(theta) + 1.0 * (40 * np.cos(theta) + 0.4 * 120 * np.cos(at.rod) * turning)
    np.testing.assert_allclose(forces, 9.81e-3 * lifted, rtol=1e-10, atol=1e-12)
    forces = jk.drive_forces(motion, applied=jk.force("slider", pin, (-800.0, 33.0, 5.0))).forces["A.phi"]
    slope = -40.0 * np.sin(theta) - 120.0 * np.sin(at.rod) * turning
    np.testing.assert_allclose(forces, 0.8 * slope, rtol=1e-10, atol=1e-10)
    given_each = jk.force("slider", pin, np.linspace(-800.0, 0.0, 64)[:, None] * np.eye(3)[0])
    np.testing.assert_allclose(
        jk.drive_forces(motion, applied=given_each).forces["A.phi"], np.linspace(0.8, 0, 64) * slope, atol=1e-12
    )


@pytest.mark.long
def test_power_goes_into_energy_and_dampers(motion, found):
    """Over a whole turn: energies from points that move as the parts do, springs and dampers by hand."""
    kinetic, potential = energies(motion, FOURBAR_MASSES, RATE)
    apart = 1e-3 * np.linalg.norm(motion.points("coupler", (70, 60, 20)) - np.array([0, 150, 10.0]), axis=1)
    rocker = np.asarray(motion.coordinates["D"][:, 0])
    potential = potential + 0.5 * 400.0 * (apart - 0.06) ** 2 + 0.5 * 3.0 * (rocker - 0.2) ** 2
    lost = 15.0 * by_time(apart, RATE) ** 2 + 0.4 * by_time(rocker, RATE) ** 2
    hinge = by_time(np.asarray(motion.coordinates["B"][:, 0]) + TURN, RATE) - RATE  # it turns back once a turn
    path = by_time(1e-3 * np.asarray(motion.points("coupler", (30.0, 60.0, 0.0))), RATE)
    given = 0.3 * hinge - 0.6 * by_time(rocker, RATE) + path @ np.array([5.0, -3.0, 2.0])
    expected = by_time(kinetic + potential, RATE) + lost - given
    np.testing.assert_allclose(found.power, expected, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(found.power, RATE * found.forces["A.phi"], rtol=1e-12)


@pytest.mark.long
def test_an_arm_speeds_up_by_its_inertia_and_a_jack_lifts_by_its_pitch():
    """Torque = I a + m g r cos(q); force x pitch / 2 pi; a slide lifts its weight: mechanisms without loops."""
    q = np.linspace(-1.0, 2.0, 7)
    arm = jk.Mechanism.build(
        fixed=["base"], unit="mm", joints=[jk.revolute("A", "base", "arm", point=(5, 6, 0), axis=Z)]
    )
    own = jk.masses(arm, given={"arm": jk.Mass(2.0, (305.0, 6.0, 0.0), 0.01)})
    found = jk.drive_forces(arm.sweep({"A": q}), own, gravity=(0, -9.81, 0), rates={"A": 2.0}, accelerations={"A": 4.0})
    np.testing.assert_allclose(found.forces["A.phi"], (0.01 + 2 * 0.09) * 4.0 + 2 * 9.81 * 0.3 * np.cos(q), rtol=1e-12)
    jack = jk.Mechanism.build(
        fixed=["base"], unit="mm", joints=[jk.screw("S", "base", "nut", point=(0, 0, 0), axis=Z, pitch=4.0)]
    )
    found = jk.drive_forces(jack.sweep({"S": q}), applied=jk.force("nut", (0, 0, 0), (0, 0, -500.0)))
    np.testing.assert_allclose(found.forces["S.phi"], 500 * 0.004 / (2 * np.pi), rtol=1e-12)
    lift = jk.Mechanism.build(fixed=["base"], unit="mm", joints=[jk.prismatic("P", "base", "load", axis=Z)])
    own = jk.masses(lift, given={"load": jk.Mass(3.0, (0, 0, 0))})
    found = jk.drive_forces(lift.sweep({"P": q}), own, rates={"P": 50.0}, accelerations={"P": 2000.0})
    np.testing.assert_allclose(found.forces["P.z"], 3.0 * (9.81 + 2.0), rtol=1e-12)
    np.testing.assert_allclose(found.power, 0.05 * 3.0 * (9.81 + 2.0), rtol=1e-12)
    assert found.units == {"P.z": "N"}


@pytest.mark.long
def test_a_gear_divides_the_torque():
    wheels = [
        jk.revolute(name, "base", part, point=(x, 0, 0), axis=Z)
        for name, part, x in (("A", "small", 0), ("B", "large", 60))
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=wheels, couplings=[jk.gear("A", "B", -0.25)])
    motion = mechanism.sweep({"A": np.linspace(0, 1, 3)})
    found = jk.drive_forces(motion, applied=jk.torque("large", (0, 0, 8.0)))
    np.testing.assert_allclose(found.forces["A.phi"], 2.0, rtol=1e-12)
    own = jk.reactions(motion, applied=jk.torque("large", (0, 0, 8.0)))
    np.testing.assert_allclose(own.drives["A.phi"], 2.0, rtol=1e-9)
    np.testing.assert_allclose(own.torques["B"], np.tile([0, 0, -8.0], (3, 1)), atol=1e-9)


@pytest.mark.long
def test_a_spring_of_no_length_whose_points_meet():
    mechanism = fourbar()
    load = jk.spring("ground", (0, 0, 0), "crank", (0, 0, 0), 10.0, 5.0, 1.0)
    forces = jk.drive_forces(mechanism.sweep({"A": TURN}), applied=[load]).forces["A.phi"]
    np.testing.assert_allclose(forces, 0.0, atol=1e-15)


@pytest.mark.long
def test_gradients_by_masses_and_loads(motion):
    def peak(x):
        given = FOURBAR_MASSES | {"coupler": jk.Mass(x[0], jnp.array([x[1], 50.0, 0.0]), x[2])}
        own = jk.masses(motion.mechanism, given=given)
        loads = [jk.force("coupler", (x[1], 0, 0), (x[3], 1.0, 0)), jk.joint_spring("D", x[4])]
        found = jk.drive_forces(motion, own, gravity=GRAVITY, applied=loads, rates={"A": RATE})
        return jnp.sum(found.forces["A.phi"] ** 2)

    x = jnp.array([1.5, 60.0, 4e-3, 5.0, 3.0])
    found = jax.grad(peak)(x)
    steps = np.diag(1e-4 * np.asarray(x))  # the function is quadratic in all but the place: differences are exact there
    expected = [(peak(x + step) - peak(x - step)) / (2 * step.sum()) for step in steps]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.long
def test_poses_that_are_not_closed_are_nan_and_it_prints_draws_and_saves(tmp_path):
    motion = fourbar(ground=40.0, crank=20.0, coupler=25.0, rocker=30.0).sweep({"A": TURN})
    closed = np.asarray(motion.closed)
    found = jk.drive_forces(motion, applied=jk.joint_load("D", 1.0))
    assert 0 < closed.sum() < len(motion)
    assert np.array_equal(np.isfinite(found.forces["A.phi"]), closed)
    assert f"Drive forces in {closed.sum()} closed poses of 64" in str(found) and "root mean square" in str(found)
    assert found.plot(tmp_path / "forces.png").stat().st_size > 10_000
    assert found.save(tmp_path / "forces.csv").read_text().splitlines()[0] == 'pose,"A.phi [N m]","power [W]"'


@pytest.mark.long
def test_what_makes_no_sense_is_refused(motion, masses):
    with pytest.raises(ValueError, match=r"nothing acts: give jk.masses"):
        jk.drive_forces(motion)
    with pytest.raises(ValueError, match="no part 'rod' to act on"):
        jk.drive_forces(motion, applied=jk.force("rod", (0, 0, 0), (1, 0, 0)))
    with pytest.raises(ValueError, match="no joint 'E'"):
        jk.drive_forces(motion, applied=jk.joint_load("E", 1.0))
    with pytest.raises(ValueError, match=r"applied loads are made by jk.force"):
        jk.drive_forces(motion, applied=[(0, 0, 1)])
    with pytest.raises(ValueError, match=r"masses are made by jk.masses"):
        jk.drive_forces(motion, 7850)
    with pytest.raises(ValueError, match="the masses are those of another mechanism"):
        jk.drive_forces(motion, replace(masses, unit="m"))
    with pytest.raises(ValueError, match="accelerations were given without rates"):
        jk.drive_forces(motion, masses, accelerations={"A": 1.0})
    with pytest.raises(ValueError, match="given once or for each of the 64 poses, got 3 rows"):
        jk.drive_forces(motion, applied=jk.torque("crank", np.ones((3, 3))))
    with pytest.raises(ValueError, match="forces are those of a motion"):
        jk.drive_forces(motion.mechanism, masses)
    with pytest.raises(ValueError, match="gravity must be three finite numbers"):
        jk.drive_forces(motion, masses, gravity=-9.81)
    for point, vector in (("centre", (1, 0, 0)), ((0, 0, 0), 5.0), ((0, 0, 0), (0, np.nan, 0))):
        with pytest.raises(ValueError, match=r"on 'crank' must be three (finite )?numbers"):
            jk.force("crank", point, vector)


@pytest.mark.long
@pytest.mark.study
def test_gradients_by_lengths():
    mechanism, inputs = fourbar(), TURN[::6]
    own = jk.masses(mechanism, given=FOURBAR_MASSES)

    def both(length):
        motion = mechanism.with_lengths({("coupler", "B", "C"): length}).sweep({"A": inputs})
        given = {"gravity": GRAVITY, "applied": loads_of_fourbar(), "rates": {"A": RATE}}
        drive = jk.drive_forces(motion, own, **given).forces["A.phi"]
        joints = jk.reactions(motion, own, **given)
        return jnp.sum(drive**2) + jnp.sum(joints.forces["C"] ** 2) + jnp.sum(joints.torques["B"][:, 0])

    compiled = jax.jit(both)
    expected = (compiled(120.0 + 1e-3) - compiled(120.0 - 1e-3)) / 2e-3
    np.testing.assert_allclose(jax.jit(jax.grad(both))(120.0), expected, rtol=1e-6)
    np.testing.assert_allclose(compiled(120.0), both(120.0), rtol=1e-9)


@pytest.mark.long
def test_power_of_a_spatial_linkage_with_balls():
    """Of the RSSR, whose rod is a point mass in its middle, so that its spin has no inertia."""
    mechanism = replace(rssr_linkage(), unit="mm")
    middle = sum(np.asarray(mechanism.joints[name].frames_1[0][:3, 3]) for name in "BC") / 2
    given = {
        "crank": jk.Mass(2.0, (10.0, 5.0, 3.0), np.diag([1e-3, 2e-3, 2.5e-3])),
        "rod": jk.Mass(1.0, middle, 0.0),
        "rocker": jk.Mass(1.5, (90.0, 60.0, 60.0), np.diag([4e-3, 2e-3, 3e-3])),
    }
    motion = mechanism.sweep({"A": whole_turn(128)})
    own = jk.masses(mechanism, given=given)
    found = jk.drive_forces(motion, own, gravity=GRAVITY, rates={"A": RATE})
    expected = by_time(sum(energies(motion, given, RATE)), RATE)
    np.testing.assert_allclose(found.power, expected, atol=1e-9 * np.abs(expected).max())
    joints = jk.reactions(motion, own, gravity=GRAVITY, rates={"A": RATE})
    np.testing.assert_allclose(
        joints.drives["A.phi"], found.forces["A.phi"], atol=1e-9 * np.abs(found.forces["A.phi"]).max()
    )
    assert all(float(jnp.abs(rows).max()) < 1e-8 for rows in joints.held.values())
    assert joints.undetermined == ()


@pytest.mark.long
def test_two_drives_share_the_work():
    """A five-bar: both torques from one balance and from virtual work; their power goes into the energy."""
    joints = [
        jk.revolute("A", "ground", "left", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "left", "first", point=(10, 50, 0), axis=Z),
        jk.revolute("C", "first", "second", point=(60, 110, 0), axis=Z),
        jk.revolute("D", "second", "right", point=(110, 50, 0), axis=Z),
        jk.revolute("E", "ground", "right", point=(100, 0, 0), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints, unit="mm")
    given = {
        "left": jk.Mass(1.0, (5, 20, 0), 1e-3),
        "first": jk.Mass(0.7, (30, 80, 0), 2e-3),
        "second": jk.Mass(0.8, (80, 90, 0), 1e-3),
        "right": jk.Mass(1.2, (100, 30, 0), 3e-3),
    }
    left, right = 0.3 * np.sin(TURN), 0.2 * np.cos(2 * TURN) - 0.2
    motion = mechanism.sweep({"A": left, "E": right})
    rates = {"A": by_time(left, RATE), "E": by_time(right, RATE)}
    changes = {"A": by_time(left, RATE, 2), "E": by_time(right, RATE, 2)}
    own = jk.masses(mechanism, given=given)
    found = jk.drive_forces(motion, own, gravity=GRAVITY, rates=rates, accelerations=changes)
    expected = by_time(sum(energies(motion, given, RATE)), RATE)
    np.testing.assert_allclose(found.power, expected, atol=1e-9 * np.abs(expected).max())
    balanced = jk.reactions(motion, own, gravity=GRAVITY, rates=rates, accelerations=changes)
    for name in ("A.phi", "E.phi"):
        np.testing.assert_allclose(balanced.drives[name], found.forces[name], atol=1e-8)


@pytest.mark.long
def test_without_a_unit_lengths_are_metres():
    mechanism = planar_fourbar()
    forces = jk.drive_forces(mechanism.sweep({"A": TURN}), applied=jk.force("rocker", (100, 80, 0), (1, 0, 0)))
    small = jk.drive_forces(fourbar().sweep({"A": TURN}), applied=jk.force("rocker", (100, 80, 0), (1, 0, 0)))
    np.testing.assert_allclose(forces.forces["A.phi"], 1000 * small.forces["A.phi"], rtol=1e-12)


@pytest.mark.long
def test_forces_at_rest_are_those_of_each_pose_alone():
    """Also of more poses than one group, with a load of its own for each and a pose that is no number among them."""
    mechanism, poses = planar_fourbar(1.0), 1300
    masses = jk.masses(
        mechanism,
        given={part: jk.Mass(1.0, centre=(10.0, 20.0, 0.0), inertia=1e-3) for part in ("crank", "coupler", "rocker")},
    )
    turn = np.linspace(0.0, 6.0, poses)
    turn[700] = np.nan
    loads = np.stack([np.linspace(1.0, 2.0, poses), np.ones(poses), np.zeros(poses)], axis=1)

    def torque(chosen):
        push = jk.force("coupler", (1.0, 2.0, 0.0), loads[chosen])
        found = jk.drive_forces(mechanism.sweep({"A": turn[chosen]}), masses, gravity=(0.0, -9.81, 0.0), applied=push)
        return np.asarray(found.forces["A.phi"])

    found = torque(slice(None))
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(found)), [700])
    # rounding of sums in another order, from 1e-16 to 1e-15 of the largest torque
    alone = np.concatenate([torque(slice(first, first + 325)) for first in range(0, poses, 325)])
    np.testing.assert_allclose(found, alone, rtol=0, atol=1e-12 * np.nanmax(np.abs(found)))
