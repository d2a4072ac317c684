"""Derivatives of known poses by the screws of their formulas: those of the least-norm solution of the closure.

Tolerance: 1e-12 of the largest, some thousand roundings; both routes divide by the sine of the elbow, once in the first
derivative, three times in the second.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.known_motion import known_motion
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.known_poses_by_formula import known_displacements_by_formula
from jaxkin.solve.range.known_poses import known_displacements
from reference import catalogue
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank


@pytest.mark.long
@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, catalogue.scotch_yoke])
def test_they_are_those_of_the_least_norm_solution(make):
    """Once and once more, also of lengths; none of poses that are not closed."""
    mechanism = make()
    motion = mechanism.sweep({"A": np.linspace(-0.4, 0.9, 7)})
    (group,) = plan_drive(mechanism.linkage, ("A",)).loop_groups
    known = jnp.stack([motion.displacements[joint][:, k] for joint, k in group.columns])
    status = jnp.asarray(motion.status).at[3].set(jk.Status.UNREACHABLE.value)
    inputs = jnp.asarray(motion.inputs["A.phi"])[None]
    rates = jnp.asarray(np.random.default_rng(0).normal(size=inputs.shape))

    def twice(place):
        def once(inputs):
            return jax.jvp(place, (inputs,), (rates,))[1]

        return jax.jit(lambda inputs: jax.jvp(once, (inputs,), (rates,)))(inputs)

    found = twice(lambda u: known_displacements_by_formula(group.system, group.axes, u, known, status))
    expected = twice(lambda u: known_displacements(group.system, group.joints, u, known, status))
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * np.abs(np.asarray(other)).max())
        assert np.all(one[:, 3] == 0) and np.any(one[:, 2] != 0)


@pytest.mark.long
def test_ranges_that_may_hold_a_singular_pose_have_those_of_the_least_norm_solution():
    """The crank of a crank-rocker passes its turn without doubt; its rocker has limits, a parallelogram change points,
    in which its four hinges are in line."""

    def formulas(motion):
        return [isinstance(numbers, AssembledAxes) for numbers in known_motion(motion)[1].numbers]

    turn, fourbar = np.linspace(0.0, 6.0, 7), planar_fourbar()
    assert formulas(fourbar.sweep({"A": turn})) == [True]
    assert formulas(fourbar.sweep({"D": 0.3 * turn})) == [False]
    assert formulas(rssr_linkage().sweep({"A": 0.1 * turn})) == [False]  # not planar
    flat = planar_fourbar(1.0, ground=100.0, crank=40.0, coupler=100.0, rocker=40.0)
    motion = flat.sweep({"A": np.linspace(-1.0, 2.0 * np.pi - 1.0, 361)})
    assert formulas(motion) == [False]
    rates = np.asarray(jk.velocities(motion, {"A": 1.0}).coordinates["D"])[np.asarray(motion.closed)]
    assert len(rates) == 361 and np.all(np.isfinite(rates))
    # opposite sides stay parallel; in the three flat poses the equations allow other rates, too
    assert np.sum(np.abs(rates - 1.0) > 1e-9) <= 3
