"""Velocities and accelerations against closed forms, and the identities that tie them to the positions.

Tolerance: 1e-9 relative is asked for; rounding is amplified by the second derivative of the pose, to about 1e-12.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.rates import accelerations, velocities
from jaxkin.solve.status import Status
from reference.mechanisms import cardan_shafts, planar_fourbar, rssr_linkage, slider_crank
from reference.rounding import tilted_fourbar

INPUTS = np.linspace(0.0, 2 * np.pi, 30)


@pytest.mark.long
def test_slider_crank_against_its_formula():
    """x = r cos(theta) + sqrt(l^2 - (e - r sin(theta))^2) differentiated twice, at a rate that changes with time."""
    start, rate, growth = 1.0, 2.0, 0.7
    motion = slider_crank(start).sweep({"A": INPUTS})

    def place(theta):
        return 40.0 * jnp.cos(theta) + jnp.sqrt(120.0**2 - (-20.0 - 40.0 * jnp.sin(theta)) ** 2)

    slope, bend = jax.vmap(jax.grad(place)), jax.vmap(jax.grad(jax.grad(place)))
    theta = start + INPUTS
    first = velocities(motion, {"A": rate})
    np.testing.assert_allclose(first.coordinates["S"][:, 0], rate * slope(theta), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(first.points("slider", (1.0, 2.0, 3.0))[:, 0], rate * slope(theta), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(first.angular("crank"), np.tile([0.0, 0.0, rate], (30, 1)), atol=1e-12)
    second = accelerations(motion, {"A": rate}, {"A": growth})
    expected = rate**2 * bend(theta) + growth * slope(theta)
    np.testing.assert_allclose(second.coordinates["S"][:, 0], expected, rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(second.angular("crank"), np.tile([0.0, 0.0, growth], (30, 1)), atol=1e-12)


@pytest.mark.parametrize(
    "rates", [pytest.param(rates, marks=pytest.mark.long) for rates in (velocities, accelerations)]
)
def test_nan_is_in_the_rates_of_its_own_pose_only(rates):
    """In the inputs as in the rates given: where the sweep has no pose, and where the rate is none."""
    mechanism, inputs, given, rest = planar_fourbar(), INPUTS.copy(), np.ones(30), np.arange(30) != 7
    expected = rates(mechanism.sweep({"A": inputs}), {"A": given})
    inputs[7], without = np.nan, given.copy()
    without[7] = np.nan
    for found in (rates(mechanism.sweep({"A": inputs}), {"A": given}), rates(expected.motion, {"A": without})):
        for one, other in zip(found.displacements, expected.displacements, strict=True):
            assert np.all(np.isnan(one[7])) and np.array_equal(one[rest], other[rest])


@pytest.mark.long
def test_cardan_shaft_speeds_up_and_slows_down():
    """Output over input: cos(shafts) / (1 - sin^2(shafts) cos^2(theta)), theta from the normal of the shafts' plane."""
    motion = cardan_shafts(0.5).sweep({"in": INPUTS})
    ratio = velocities(motion, {"in": 1.0}).coordinates["out"][:, 0]
    expected = np.cos(0.5) / (1 - np.sin(0.5) ** 2 * np.sin(INPUTS) ** 2)
    np.testing.assert_allclose(ratio, expected, rtol=1e-9)


@pytest.mark.long
def test_a_rigid_rod_keeps_its_length():
    """The velocities of the ends of a rod have equal components along it, and differ by omega cross r."""
    motion = rssr_linkage().sweep({"A": np.linspace(0.0, 1.0, 7)})
    ends = [np.asarray(motion.mechanism.joints[name].frames_1[0][:3, 3]) for name in "BC"]
    rates = velocities(motion, {"A": np.linspace(1.0, 3.0, 7)})
    along = motion.points("rod", ends[1]) - motion.points("rod", ends[0])
    apart = rates.points("rod", ends[1]) - rates.points("rod", ends[0])
    np.testing.assert_allclose(jnp.sum(along * apart, axis=1), 0.0, atol=1e-8)  # mm^2 per time, of about 1e4
    turned = jnp.cross(rates.angular("rod"), along)
    np.testing.assert_allclose(apart, turned, atol=1e-9)


@pytest.mark.long
def test_poses_that_do_not_close_have_no_rates():
    motion = planar_fourbar(1.0, ground=40.0, crank=20.0, coupler=25.0, rocker=30.0).sweep({"A": INPUTS})
    rates = velocities(motion, {"A": 1.0})
    assert 0 < np.sum(rates.closed) < len(motion)
    assert np.all(np.asarray(rates.coordinates["D"])[~np.asarray(rates.closed)] == 0)
    assert np.all(np.isfinite(rates.coordinates["D"]))
    assert f"not known at {np.sum(~rates.closed)} of {len(motion)} poses" in str(rates)


@pytest.mark.long
def test_misfit_poses_have_rates(tmp_path):
    """Those of the nearest joints that agree: as right as the joints, whose axes are 1e-4 rad apart."""
    mechanism, step = tilted_fourbar(1e-4), 1e-3
    motion = mechanism.sweep({"A": INPUTS})
    rates = velocities(motion, {"A": 1.0})
    assert np.any(motion.status == Status.MISFIT) and np.all(rates.closed)
    ends = [mechanism.sweep({"A": INPUTS + at}).coordinates["D"][:, 0] for at in (-step, step)]
    np.testing.assert_allclose(rates.coordinates["D"][:, 0], (ends[1] - ends[0]) / (2 * step), atol=1e-3)
    assert "D.phi" in str(rates) and "nan" not in rates.save(tmp_path / "rates.csv").read_text()


@pytest.mark.long
def test_bad_rates():
    motion = planar_fourbar(1.0).sweep({"A": INPUTS})
    with pytest.raises(ValueError, match=r"'B.phi' is not driven in this motion; did you mean 'A.phi'"):
        velocities(motion, {"B": 1.0})
    with pytest.raises(ValueError, match="one number or one for each of the 30 poses"):
        velocities(motion, {"A": np.ones(3)})
    with pytest.raises(ValueError, match="no joint 'Q'"):
        velocities(motion, {"Q": 1.0})
    with pytest.raises(ValueError, match="no part 'rod'"):
        velocities(motion, {"A": 1.0}).points("rod", (0, 0, 0))


@pytest.mark.long
def test_rates_of_poses_in_which_a_rod_has_spun():
    """A rod of an RSSR linkage whose point is pulled to a place: the rocker still turns about its hinge."""
    joints = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.spherical("B", "crank", "rod", point=(1, 0, 0)),
        jk.spherical("C", "rod", "rocker", point=(3, 2, 0.5)),
        jk.revolute("D", "rocker", "ground", point=(4, 0, 0), axis=(0.2, 1, 0.1)),
    ]
    mechanism = jk.Mechanism.build(joints=joints, fixed=["ground"])
    motion = jk.inverse(mechanism, {jk.point("rod", (2, 1, 0.2)): np.array([[1.9, 1.1, 0.25]])}).motion
    assert np.all(np.asarray(motion.closed)) and np.abs(motion.coordinates["B"]).max() > 0.5
    rates = jk.velocities(motion, {"A.phi": 1.0})
    np.testing.assert_allclose(rates.points("rocker", (4, 0, 0)), 0.0, atol=1e-12)
    # as much as in a sweep through that pose, in which the rod does not spin
    swept = mechanism.sweep({"A": np.concatenate([[0.0], motion.inputs["A.phi"]])})
    expected = jk.velocities(swept, {"A.phi": 1.0}).coordinates["D"][1:]
    np.testing.assert_allclose(rates.coordinates["D"], expected, atol=1e-9)
