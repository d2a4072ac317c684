"""Springs and dampers whose ends meet: an arm of a metre, and a fixed point on the circle of its end.

At the angle q the end is 2 sin(q / 2) away, and the lever of its force cos(q / 2).
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import whole_turn
from reference.mechanisms import Z, planar_fourbar

ANGLES = np.array([-0.5, -1e-4, 0.0, 1e-4, 0.5, 2 * np.pi])


def _arm() -> jk.Mechanism:
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)
    return jk.Mechanism.build(fixed=["base"], joints=[hinge], unit="m")


@pytest.mark.long
def test_a_spring_pushes_to_both_sides_and_where_its_ends_meet_to_none():
    load = jk.spring("base", (1, 0, 0), "arm", (1, 0, 0), 10.0, 0.2)
    found = jk.drive_forces(_arm().sweep({"A": ANGLES}), applied=load).forces["A.phi"]
    away = 2 * np.sin(ANGLES / 2)
    expected = 10.0 * np.where(np.isin(ANGLES, (0.0, 2 * np.pi)), 0.0, away - 0.2 * np.sign(away)) * np.cos(ANGLES / 2)
    np.testing.assert_allclose(found, expected, atol=1e-9)  # rounding of the place of the end over 1e-4


@pytest.mark.long
def test_rounding_gives_no_direction():
    """The same pose after a turn of a loop, whose places are off by rounding."""
    pin = planar_fourbar().joints["B"].frames_1[0][:3, 3]
    motion = planar_fourbar().sweep({"A": np.append(whole_turn(24), 2 * np.pi)})
    found = jk.drive_forces(motion, applied=jk.spring("ground", pin, "coupler", pin, 10.0, 0.2)).forces["A.phi"]
    np.testing.assert_allclose(np.asarray(found)[[0, -1]], 0.0, atol=1e-9)


@pytest.mark.long
def test_a_damper_acts_against_the_velocity_also_where_its_ends_meet():
    """c v cos(q / 2) at the lever cos(q / 2), the ends apart by 2 sin(q / 2) with the rate v cos(q / 2)."""
    load = jk.spring("base", (1, 0, 0), "arm", (1, 0, 0), 0.0, 0.0, 5.0)

    def force(angles):
        return jk.drive_forces(_arm().sweep({"A": angles}), applied=load, rates={"A": 2.0}).forces["A.phi"]

    np.testing.assert_allclose(force(ANGLES), 5.0 * 2.0 * np.cos(ANGLES / 2) ** 2, rtol=1e-9)
    slope = jax.jvp(force, (jnp.asarray(ANGLES),), (jnp.ones(len(ANGLES)),))[1]
    assert np.isfinite(slope).all()


def test_a_spring_from_a_part_to_itself_is_refused():
    with pytest.raises(ValueError, match="acts between two parts, got 'crank' twice"):
        jk.spring("crank", (0, 0, 0), "crank", (1, 0, 0), 10.0)
