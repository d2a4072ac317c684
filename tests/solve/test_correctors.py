"""Newton's step converges quadratically; the damped corrector closes singular systems, or gets as near as it can."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.joints.pairs import cylindrical
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.solve.closure.closure import closure, free_jacobian, loop_geometry
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt
from jaxkin.solve.correctors.newton import newton
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.blocks import solve_blocks
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.from_linkage import group_joints, group_system
from jaxkin.solve.system.state import assembled, drive, retract
from reference.mechanisms import planar_fourbar

MAX_STEPS = 60
DEFAULT = SolverOptions()


def problem(mechanism, loop_class=None, driven=("A",)):
    """The system of the only group of loops, with the first coordinate of the joints named driven, and its geometry."""
    (group,), (own,) = mechanism.structure.loop_groups, mechanism.linkage.classes
    names = [joint.name for joint in mechanism.all_joints]
    inputs = tuple((names.index(name), 0) for name in driven)
    system, _ = group_system(mechanism.linkage, group, inputs, own if loop_class is None else loop_class)
    joints = jax.tree.map(jnp.asarray, group_joints(mechanism.linkage, mechanism.all_joints, group))
    return system, loop_geometry(system, joints)[0]


def at_inputs(system, inputs):
    """The assembled pose with other inputs, so that its loops are open."""
    inputs = jnp.atleast_2d(jnp.asarray(inputs))
    return drive(system, assembled(system, inputs.shape[1], inputs.dtype), inputs)


@partial(jax.jit, static_argnums=0)
def damped(system, geometry, state):
    return levenberg_marquardt(ClosureProblem(system, geometry, DEFAULT), state, MAX_STEPS)


@partial(jax.jit, static_argnames=("system", "options", "extrapolate_residual"))
def closed_by_newton(system, geometry, state, target_residual, options=DEFAULT, extrapolate_residual=False):
    problem = ClosureProblem(system, geometry, options)
    return newton(problem, state, target_residual, extrapolate_residual=extrapolate_residual)


@pytest.mark.long
def test_newtons_step_squares_the_residual():
    """e_(k+1) / e_k^2 is bounded: not so of a linear rate, which takes a third step's ratio to infinity."""
    system, geometry = problem(planar_fourbar(1.0))
    state, norms = at_inputs(system, [0.1]), []

    @partial(jax.jit, static_argnums=0)
    def step(system, geometry, state):
        found = closure(system, geometry, state)
        blocks, floor = equation_blocks(system), damping_floor(state.x.dtype)
        delta = solve_blocks(found.jacobian, found.residual, floor, blocks, regular=True)
        return retract(system, state, -delta), found.residual_norm

    for _ in range(5):
        state, norm = step(system, geometry, state)
        norms.append(float(norm[0]))
    before, after = np.array(norms[:-1]), np.array(norms[1:])
    seen = after > 1e-13  # above rounding of 1e-15 a factor of a hundred
    assert seen.sum() >= 2 and norms[-1] < 1e-11
    # the constant is half the curvature over the singular values: of order one for links of like lengths
    assert np.all(after[seen] < 5 * before[seen] ** 2)


@pytest.mark.long
def test_newton_closes_near_poses_and_extrapolates_no_more_than_it_finds():
    system, geometry = problem(planar_fourbar(1.0))
    state = at_inputs(system, np.linspace(-0.1, 0.1, 5))
    closed, _, norm = closed_by_newton(system, geometry, state, 1e-12)
    assert np.all(norm <= 1e-12)
    ahead, _, _ = closed_by_newton(system, geometry, state, 1e-12, extrapolate_residual=True)
    # residuals of 1e-12 over singular values of some 0.1
    np.testing.assert_allclose(ahead.x, closed.x, atol=1e-10)


@pytest.mark.long
def test_newton_takes_as_many_iterations_as_the_options_say():
    """A second one begins where the first has ended: one after another reaches what two at once reach."""
    system, geometry = problem(planar_fourbar(1.0))
    state = at_inputs(system, [0.2])
    one, two = (SolverOptions(newton_iterations=count) for count in (1, 2))
    half, _, far = closed_by_newton(system, geometry, state, 0.0, one)
    both, _, near = closed_by_newton(system, geometry, state, 0.0, two)
    twice, _, same = closed_by_newton(system, geometry, half, 0.0, one)
    assert 1e-6 < near < 0.1 * far  # quadratic, from 1e-2 on
    np.testing.assert_allclose(twice.x, both.x, atol=1e-14)  # rounding
    np.testing.assert_allclose(same, near, atol=1e-14)


@pytest.mark.long
def test_the_damped_corrector_closes_a_rank_deficient_system_by_least_norm():
    """Cylindrical joints with parallel axes, one of them slid by hand: the others may share the slide anyhow."""
    system, geometry = problem(planar_fourbar(1.0, cylindrical), LoopClass())
    state = at_inputs(system, [0.2, -0.2])
    found = damped(system, geometry, state)
    assert np.all(found.residual_norm < 1e-12)
    jacobian = np.moveaxis(np.asarray(free_jacobian(system, found.closure)), -1, 0)
    values = np.linalg.svd(jacobian, compute_uv=False)
    assert np.all((values > 1e-9 * values[:, :1]).sum(axis=1) < system.equations)
    # three joints make up for the slide of the driven one: of least norm are equal shares, to rounding
    slides = np.setdiff1d(np.flatnonzero(system.is_length), system.driven)
    np.testing.assert_allclose(np.abs(np.asarray(found.state.x)[slides]), 0.2 / 3, atol=1e-12)


@pytest.mark.long
def test_the_damped_corrector_ends_at_a_stationary_residual_where_loops_cannot_close():
    """Beyond the limit of a four-bar whose input cannot turn fully: J^T r = 0 with r far from zero."""
    system, geometry = problem(planar_fourbar(1.0), driven=("D",))
    found = damped(system, geometry, at_inputs(system, np.linspace(-3.0, 3.0, 13)))
    open_ = np.asarray(found.residual_norm) > 1e-3
    assert open_.any() and not open_.all()
    assert np.all(np.asarray(found.stationary)[open_])
    jacobian, residual = free_jacobian(system, found.closure), found.closure.residual
    gradient = jnp.sqrt(jnp.sum(jnp.einsum("ecp,ep->cp", jacobian, residual) ** 2, axis=0))
    norm = jnp.sqrt(jnp.sum(residual**2, axis=0))
    # `stationary` asks for an angle of 1e-3 from the normal of the range; J is of order one
    assert np.all(np.asarray(gradient / norm)[open_] < 1e-2)
