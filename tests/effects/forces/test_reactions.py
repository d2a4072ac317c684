"""Reactions against the balance of each part, closed forms, and the drive forces of virtual work.

Tolerance: 1e-8 of the largest force; the balance squares the condition of the constraints, about 1e3, and rounding.
"""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import FOURBAR_MASSES, FOURBAR_SPRINGS, GRAVITY, by_time, fourbar, whole_turn
from reference.mechanisms import Z, bennett_linkage, cardan_shafts, slider_crank
from reference.planar import slider_crank as slider_crank_angles

RATE = 7.0
TURN = whole_turn()
APPLIED = [
    *FOURBAR_SPRINGS,
    jk.force("coupler", (30.0, 60.0, 0.0), (5.0, -3.0, 2.0)),
]


@pytest.fixture(scope="module")
def found(motion, masses) -> jk.Reactions:
    return jk.reactions(motion, masses, gravity=GRAVITY, applied=APPLIED, rates={"A": RATE})


@pytest.mark.long
def test_every_part_is_in_balance(motion, found):
    """Newton and Euler for each part, with accelerations of its centre and angle from a Fourier sum over the turn."""
    ends = [np.array([0, 150, 10.0]), np.asarray(motion.points("coupler", (70, 60, 20)))]
    apart = 1e-3 * (ends[0] - ends[1])
    distance = np.linalg.norm(apart, axis=1, keepdims=True)
    pull = (400.0 * (distance - 0.06) + 15.0 * by_time(distance, RATE)) * apart / distance
    outer = {
        "crank": [],
        "rocker": [],
        "coupler": [
            (ends[1], pull),
            (np.asarray(motion.points("coupler", (30.0, 60.0, 0.0))), np.array([5.0, -3.0, 2.0])),
        ],
    }
    largest = max(float(jnp.abs(rows).max()) for rows in found.forces.values())
    for part, mass in FOURBAR_MASSES.items():
        inertia = np.asarray(mass.inertia) * np.eye(3)  # along the axes, all of them
        centre = np.asarray(motion.points(part, mass.centre))
        push = mass.mass * (by_time(1e-3 * centre, RATE, 2) - np.array(GRAVITY))
        turned = np.asarray(motion.transforms[part][:, :3, :3])
        omega = by_time(turned, RATE) @ turned.transpose(0, 2, 1)
        omega = np.stack([omega[:, 2, 1], omega[:, 0, 2], omega[:, 1, 0]], axis=1)
        spin = np.einsum("pij,jk,plk,pl->pi", turned, inertia, turned, omega)
        forces, torques = -push, -by_time(spin, RATE)
        for name, joint in motion.mechanism.joints.items():
            if part in joint.parts:
                sign = 1.0 if joint.parts[1] == part else -1.0
                force = sign * np.asarray(found.forces[name])
                arm = 1e-3 * (np.asarray(found.points[name]) - centre)
                forces = forces + force
                torques = torques + sign * np.asarray(found.torques[name]) + np.cross(arm, force)
        for point, force in outer[part]:
            forces, torques = forces + force, torques + np.cross(1e-3 * (point - centre), force)
        np.testing.assert_allclose(forces, 0.0, atol=1e-8 * largest)
        np.testing.assert_allclose(torques, 0.0, atol=1e-8 * largest)


@pytest.mark.long
def test_hinges_transmit_no_torque_but_that_of_drive_and_spring(motion, masses, found):
    drive = jk.drive_forces(motion, masses, gravity=GRAVITY, applied=APPLIED, rates={"A": RATE}).forces["A.phi"]
    rocker, speed = motion.coordinates["D"][:, 0], by_time(np.asarray(motion.coordinates["D"][:, 0]), RATE)
    scale = float(jnp.abs(drive).max())
    np.testing.assert_allclose(found.drives["A.phi"], drive, atol=1e-8 * scale)
    np.testing.assert_allclose(found.torques["A"][:, 2], drive, atol=1e-8 * scale)
    np.testing.assert_allclose(found.torques["D"][:, 2], -3.0 * (rocker - 0.2) - 0.4 * speed, atol=1e-8 * scale)
    for name in "BC":
        np.testing.assert_allclose(found.torques[name][:, 2], 0.0, atol=1e-8 * scale)
    assert all(float(jnp.abs(rows).max()) < 1e-8 * scale for rows in found.held.values())


@pytest.mark.long
def test_what_a_planar_linkage_leaves_open_is_named(found):
    """Three of six times four unknowns, as mobility counts its redundant equations: along the axes and about them."""
    assert [each.joint for each in found.undetermined] == list("ABCD")
    assert {each.components for each in found.undetermined} == {("torque x", "torque y", "force z")}
    assert "not determined in B (crank - coupler): torque x, torque y, force z" in str(found)


@pytest.mark.long
def test_a_slider_crank_under_its_piston_force():
    """The rod is a two-force member: F / cos(rod) along it, and F tan(rod) on the rail; crank torque F dx/dtheta."""
    mechanism = replace(slider_crank(), unit="mm")
    pin = np.asarray(mechanism.joints["C"].frames_1[0][:3, 3])
    motion = mechanism.sweep({"A": TURN})
    found = jk.reactions(motion, applied=jk.force("slider", pin, (-800.0, 0.0, 0.0)))
    rod = slider_crank_angles(1.0 + TURN).rod
    np.testing.assert_allclose(
        found.forces["C"], 800.0 * np.stack([1 + 0 * rod, np.tan(rod), 0 * rod], axis=1), atol=1e-7
    )
    np.testing.assert_allclose(found.forces["S"][:, 1], -800.0 * np.tan(rod), atol=1e-7)
    arm = 1e-3 * np.asarray(motion.points("slider", pin) - found.points["S"])  # from the rail's point to the pin
    np.testing.assert_allclose(found.torques["S"][:, 2], np.cross(arm, found.forces["S"])[:, 2], atol=1e-7)


@pytest.mark.long
def test_a_door_on_two_hinges_shares_its_weight():
    """Two equal hinges on one axis, as a door has: the weight along the axis is not determined, and is shared."""
    joints = [
        jk.revolute("upper", "wall", "door", point=(0, 0, 0.5), axis=Z),
        jk.revolute("lower", "wall", "door", point=(0, 0, -0.5), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["wall"], joints=joints, unit="m")
    own = jk.masses(mechanism, given={"door": jk.Mass(20.0, (0.4, 0.0, 0.0))})
    found = jk.reactions(mechanism.sweep({"upper": np.array([0.0, 0.3])}), own, gravity=(0, 0, -10.0))
    for name in ("upper", "lower"):
        np.testing.assert_allclose(found.forces[name][:, 2], 100.0, rtol=1e-9)
    # the couple of the weight, 200 N x 0.4 m about the axis across the door, is held by forces a metre apart, and
    # torques
    across = np.stack([-np.sin([0.0, 0.3]), np.cos([0.0, 0.3]), np.zeros(2)], axis=1)
    held = found.torques["upper"] + found.torques["lower"]
    held = held + np.cross([0, 0, 0.5], found.forces["upper"] - found.forces["lower"])
    np.testing.assert_allclose(held, -80.0 * across, atol=1e-7)
    assert {each.joint for each in found.undetermined} == {"upper", "lower"}
    assert "force z" in found.undetermined[0].components


@pytest.mark.long
def test_gradients_by_masses_and_forces(motion):
    def peak(x):
        own = jk.masses(motion.mechanism, given=FOURBAR_MASSES | {"coupler": jk.Mass(x[0], (x[1], 50.0, 0.0), x[2])})
        found = jk.reactions(motion, own, applied=jk.force("coupler", (x[1], 0, 0), (x[3], 1.0, 0)), rates={"A": RATE})
        return jnp.sum(found.forces["B"] ** 2) + jnp.sum(found.drives["A.phi"] ** 2)

    x = jnp.array([1.5, 60.0, 4e-3, 5.0])
    steps = np.diag(1e-4 * np.asarray(x))
    expected = [(peak(x + step) - peak(x - step)) / (2 * step.sum()) for step in steps]
    np.testing.assert_allclose(jax.grad(peak)(x), expected, rtol=1e-6)


@pytest.mark.long
def test_it_prints_draws_and_saves_and_open_poses_are_nan(tmp_path):
    motion = fourbar(ground=40.0, crank=20.0, coupler=25.0, rocker=30.0).sweep({"A": TURN})
    found = jk.reactions(motion, applied=jk.torque("rocker", (0, 0, 1.0)))
    closed = np.asarray(motion.closed)
    for rows in (*found.forces.values(), *found.torques.values()):
        assert np.array_equal(np.isfinite(rows).all(axis=1), closed)
    assert f"Reactions of 4 joints in {closed.sum()} closed poses of 64" in str(found)
    assert found.plot(tmp_path / "all.png").stat().st_size > 10_000
    found.plot(tmp_path / "some.png", ["A", "D"])
    with pytest.raises(ValueError, match="no joint 'E'"):
        found.plot(tmp_path / "none.png", ["E"])
    table = np.genfromtxt(found.save(tmp_path / "joints.csv"), delimiter=",", names=True)
    np.testing.assert_allclose(table["A_force_y_N"], found.forces["A"][:, 1], rtol=1e-8)


@pytest.mark.long
def test_loads_that_are_no_numbers_are_told(motion, masses):
    unknown = np.full((len(motion.status), 3), np.nan)
    found = jk.reactions(motion, masses, applied=[jk.force("coupler", (30.0, 60.0, 0.0), unknown)])
    assert "unknown" in str(found)


def test_a_motion_without_poses_has_no_forces():
    arm = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)
    motion = jk.Mechanism.build(fixed=["base"], joints=[arm]).sweep({"A": np.zeros(0)})
    load = jk.force("arm", (1, 0, 0), (0.0, 3.0, 0.0))
    assert jk.reactions(motion, applied=load).forces["A"].shape == (0, 3)
    assert jk.drive_forces(motion, applied=load, rates={"A": 1.0}).forces["A.phi"].shape == (0,)


def test_a_load_that_is_no_number_leaves_the_other_joints_known():
    joints = [jk.revolute(name, "base", f"arm {name}", point=(0, 0, 0), axis=Z) for name in ("A", "B")]
    motion = jk.Mechanism.build(fixed=["base"], joints=joints).sweep({"A": [0.0, 0.1], "B": [0.0, 0.1]})
    rows = np.full((2, 3), np.nan)
    loads = [jk.force("arm A", (1, 0, 0), rows), jk.force("arm B", (1, 0, 0), (0.0, 3.0, 0.0))]
    said = str(jk.reactions(motion, applied=loads)).splitlines()
    assert said[1].startswith("  B  force up to 3 N at pose 0") and said[2].startswith("  unknown in A: ")


@pytest.mark.long
def test_a_freedom_without_a_drive_is_told():
    """Two hinges in a row, the second without a drive: what gravity asks of it nothing holds."""
    joints = [
        jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "arm", "hand", point=(0.5, 0, 0), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=joints, unit="m")
    motion = mechanism.sweep({"A": np.array([0.0, 0.1])})
    balanced = jk.masses(mechanism, given={"arm": 0, "hand": jk.Mass(1.0, (0.5, 0.0, 0.0))})
    found = jk.reactions(motion, balanced, gravity=(0, -9.81, 0))
    np.testing.assert_allclose(found.drives["A.phi"], 9.81 * 0.5 * np.cos([0.0, 0.1]), rtol=1e-9)
    assert "no drive" not in str(found)
    loose = jk.masses(mechanism, given={"arm": 0, "hand": jk.Mass(1.0, (0.8, 0.0, 0.0))})
    found = jk.reactions(motion, loose, gravity=(0, -9.81, 0))
    np.testing.assert_allclose(found.held["B"][:, 0], 9.81 * 0.3 * np.cos([0.0, 0.1]), rtol=1e-8)
    np.testing.assert_allclose(found.drives["A.phi"], 9.81 * 0.8 * np.cos([0.0, 0.1]), rtol=1e-8)
    assert "B.phi has no drive: up to 2.94 N m would hold it" in str(found)


@pytest.mark.long
def test_spatial_linkages_agree_with_virtual_work():
    for mechanism, drive, opened in ((bennett_linkage(), "A", 3), (cardan_shafts(), "in", None)):
        motion = mechanism.sweep({drive: np.linspace(0.1, 1.5, 9)})
        given = {part: jk.Mass(1.0, (10.0, 20.0, 30.0), 50.0) for part in mechanism.parts if part != "ground"}
        own = jk.masses(mechanism, given=given)
        balanced = jk.reactions(motion, own, rates={drive: 2.0})
        forces = jk.drive_forces(motion, own, rates={drive: 2.0}).forces[f"{drive}.phi"]
        np.testing.assert_allclose(balanced.drives[f"{drive}.phi"], forces, rtol=1e-8)
        assert len(balanced.undetermined) in (len(mechanism.joints), opened)


@pytest.mark.long
def test_a_linkage_that_is_not_overconstrained_is_determined():
    """With a ball and a pin that slides in place of two hinges the forces along the axes are those of the loads."""
    planar = fourbar()
    at = {name: joint.frames_1[0][:3, 3] for name, joint in planar.joints.items()}
    joints = [
        jk.revolute("A", "ground", "crank", point=at["A"], axis=Z),
        jk.spherical("B", "crank", "coupler", point=at["B"]),
        jk.cylindrical("C", "coupler", "rocker", point=at["C"], axis=Z),
        jk.revolute("D", "ground", "rocker", point=at["D"], axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints, unit="mm")
    found = jk.reactions(mechanism.sweep({"A": TURN[:20]}), applied=jk.force("coupler", (30, 60, 0), (5, -3, 2)))
    assert found.undetermined == ()
    np.testing.assert_allclose(found.forces["B"][:, 2], -2.0, rtol=1e-8)  # the pin of C slides: B carries it all
    np.testing.assert_allclose(found.forces["C"][:, 2], 0.0, atol=1e-8)
    plain = jk.reactions(planar.sweep({"A": TURN[:20]}), applied=jk.force("coupler", (30, 60, 0), (5, -3, 2)))
    for name in "ABCD":
        np.testing.assert_allclose(found.forces[name][:, :2], plain.forces[name][:, :2], atol=1e-8)


@pytest.mark.long
def test_many_poses_are_those_of_few():
    """More poses than a group has, which they do not fill, with loads of each pose: every 70th is as it is alone."""
    mechanism, few = fourbar(), slice(None, None, 70)
    inputs = np.linspace(0.0, 2 * np.pi, 701)
    push = np.stack([np.sin(3 * inputs), np.cos(inputs), 0.1 * inputs], axis=1)
    masses = jk.masses(mechanism, given=FOURBAR_MASSES)

    def given(some: slice) -> dict[str, Any]:
        loads = [jk.force("coupler", (30.0, 60.0, 0.0), push[some], turns=True), jk.joint_load("D", push[some, 1])]
        return dict(gravity=GRAVITY, applied=[*loads, *FOURBAR_SPRINGS], rates={"A": RATE})

    motion, some = mechanism.sweep({"A": inputs}), mechanism.sweep({"A": inputs[few]})
    every, alone = jk.reactions(motion, masses, **given(slice(None))), jk.reactions(some, masses, **given(few))
    for name, forces in alone.forces.items():
        assert every.forces[name].shape == (701, 3)
        np.testing.assert_allclose(every.forces[name][few], forces, atol=1e-8 * np.abs(forces).max())
        torques = alone.torques[name]
        np.testing.assert_allclose(every.torques[name][few], torques, atol=1e-8 * np.abs(torques).max())
    drive = jk.drive_forces(motion, masses, **given(slice(None))).forces["A.phi"]
    np.testing.assert_allclose(every.drives["A.phi"], drive, atol=1e-8 * np.abs(drive).max())


def test_what_has_no_drive_is_told():
    """An arm of two links of which one is driven: the other counts as held, with the torque of its weight."""
    hinges = [
        jk.revolute("A", "base", "one", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "one", "two", point=(100, 0, 0), axis=(0, 0, 1)),
    ]
    arm = jk.Mechanism.build(fixed=["base"], unit="mm", joints=hinges)
    own = jk.masses(arm, given={"one": 0, "two": jk.Mass(1.0, (150, 0, 0))})
    motion = arm.sweep({"A": np.zeros(2)})
    found = jk.drive_forces(motion, own, gravity=(0, -10, 0))
    assert "without a drive, and counted as held: B.phi" in str(found)
    held = jk.reactions(motion, own, gravity=(0, -10, 0)).held["B"]
    np.testing.assert_allclose(np.abs(held), 0.5, rtol=1e-9)
    both = jk.drive_forces(arm.sweep({"A": np.zeros(2), "B": np.zeros(2)}), own)
    assert "without a drive" not in str(both)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_what_is_determined_does_not_depend_on_the_precision():
    """The torque of a drive is determined, however a screw jack stands in space."""
    axis, away = np.array([0.3, -0.5, 0.8]), np.array([3000.0, -2000.0, 5000.0])
    across = np.array([0.8, 0.0, -0.3])
    jack = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("turn", "ground", "spindle", point=away, axis=axis),
            jk.screw("thread", "spindle", "nut", point=away + 200 * axis, axis=axis, pitch=250.0),
            jk.prismatic("guide", "ground", "nut", point=away + 300 * across, axis=axis),
        ],
        unit="mm",
    )
    force = jk.force("nut", away, (1.0, 2.0, 3.0))
    told = []
    for exact in (True, False):
        with jax.enable_x64(exact):
            motion = jack.sweep({"turn": np.linspace(0.1, 3.0, 5)})
            told.append({each.joint: each.components for each in jk.reactions(motion, applied=force).undetermined})
    assert told[0] == told[1]
    assert "torque z" not in told[0]["turn"]
