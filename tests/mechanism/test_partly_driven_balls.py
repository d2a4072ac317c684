"""Balls driven by one or two of their angles, against models of hinges and of a hinge with a universal joint."""

import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
ORIGIN = (0.0, 0.0, 0.0)
STEPS = np.linspace(0.0, 1.0, 9)
SWINGS = {"psi": -0.35 * np.sin(3 * STEPS), "phi": 0.1 * STEPS, "theta": -0.2 * STEPS}
"""Away from the limits of the rods: the other way one of them is stretched after 0.01 rad."""


def plate(mount, rods):
    """A plate that is mounted in the origin, held by one rod or two; the rods spin by themselves."""
    ends = [((2.0, 0.3, 0.2), (2.2, 0.5, -2.0)), ((0.4, 1.8, 0.1), (0.2, 2.0, -1.8))][:rods]
    joints = list(mount)
    for number, (tip, foot) in enumerate(ends):
        joints.append(jk.spherical(f"tip{number}", "plate", f"rod{number}", point=tip))
        joints.append(jk.spherical(f"foot{number}", "ground", f"rod{number}", point=foot))
    return jk.Mechanism.build(fixed=["ground"], joints=joints, unit="m")


BALL = (jk.spherical("mount", "ground", "plate", point=ORIGIN),)
HINGES = (
    jk.revolute("psi", "ground", "yoke", point=ORIGIN, axis=Z),
    jk.revolute("phi", "yoke", "cross", point=ORIGIN, axis=(0, 1, 0)),
    jk.revolute("theta", "cross", "plate", point=ORIGIN, axis=(1, 0, 0)),
)
CARDAN = (
    HINGES[0],
    jk.universal("cross", "yoke", "plate", point=ORIGIN, axis1=(0, 1, 0), axis2=(1, 0, 0)),
)


@pytest.mark.long
@pytest.mark.parametrize(
    "angles", [("psi",), ("phi",), ("theta",), ("psi", "phi"), ("phi", "theta"), ("psi", "theta")], ids="-".join
)
def test_a_ball_driven_by_some_angles_is_a_chain_of_hinges(angles):
    """One angle beside two rods, two angles beside one: what is driven is Rz(psi) Ry(phi) Rx(theta)."""
    rods = 3 - len(angles)
    ball = plate(BALL, rods).sweep({f"mount.{name}": SWINGS[name] for name in angles}, throw=True)
    hinged = plate(HINGES, rods).sweep({name: SWINGS[name] for name in angles}, throw=True)
    wanted = np.stack([hinged.coordinates[name][:, 0] for name in ("theta", "phi", "psi")], axis=1)
    np.testing.assert_allclose(ball.coordinates["mount"], wanted, atol=1e-12)  # rounding
    np.testing.assert_allclose(ball.transforms["plate"], hinged.transforms["plate"], atol=1e-12)


@pytest.mark.long
def test_a_ball_driven_by_two_angles_is_a_hinge_with_a_universal_joint():
    cardan = plate(CARDAN, 1).sweep({"psi": SWINGS["psi"], "cross.phi": SWINGS["phi"]}, throw=True)
    ball = plate(BALL, 1).sweep({"mount.psi": SWINGS["psi"], "mount.phi": SWINGS["phi"]}, throw=True)
    np.testing.assert_allclose(ball.transforms["plate"], cardan.transforms["plate"], atol=1e-12)


@pytest.mark.long
def test_rates_and_forces_are_those_of_the_hinges():
    given = {"psi": 1.3, "phi": -0.4}
    ball, hinged = (
        plate(mount, 1).sweep({key.format(name): SWINGS[name] for name in given})
        for mount, key in ((BALL, "mount.{}"), (HINGES, "{}"))
    )
    rates = [
        jk.velocities(motion, {key.format(name): rate for name, rate in given.items()})
        for motion, key in ((ball, "mount.{}"), (hinged, "{}"))
    ]
    np.testing.assert_allclose(rates[0].transforms["plate"], rates[1].transforms["plate"], atol=1e-11)
    push = jk.force("plate", (1.0, 1.0, 0.5), (0.3, -2.0, 1.0))
    one, other = (jk.drive_forces(motion, applied=push, gravity=(0, 0, 0)) for motion in (ball, hinged))
    for name in given:
        np.testing.assert_allclose(one.forces[f"mount.{name}"], other.forces[f"{name}.phi"], atol=1e-9)


@pytest.mark.long
def test_a_rod_whose_ball_is_driven_by_an_angle_does_not_spin_by_itself():
    """The numbers of the other balls stay: the second rod spins, the first one turns as it is told."""
    motion = plate(BALL, 2).sweep({"mount.psi": SWINGS["psi"], "foot0.psi": 0.5 * STEPS}, throw=True)
    np.testing.assert_allclose(motion.coordinates["foot0"][:, 2], 0.5 * STEPS, atol=1e-13)
    alone = plate(BALL, 2).sweep({"mount.psi": SWINGS["psi"]}, throw=True)
    np.testing.assert_allclose(motion.transforms["plate"], alone.transforms["plate"], atol=1e-12)


@pytest.mark.long
def test_what_is_left_is_told():
    motion = plate(BALL, 1).sweep({"mount.psi": SWINGS["psi"]}, throw=True)
    assert "it could be mount." in str(motion)
    with pytest.raises(ValueError, match=r"write 'mount\.theta' or 'mount\.phi' or 'mount\.psi'"):
        plate(BALL, 1).sweep({"mount": STEPS})
