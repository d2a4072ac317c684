"""Sweeps by formula: poses, statuses, derivatives are the general program's, which is compiled only where needed."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.sweep import _closure_tolerance
from jaxkin.solve.execution import programs
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status
from reference import catalogue
from reference.mechanisms import cardan_shafts, planar_fourbar, rssr_linkage, slider_crank, spherical_linkage

TURN = 2 * np.pi
WITHIN = 1e-12
"""Over the size of the mechanism: some thousand roundings, what both solvers are held to away from limits."""


@pytest.fixture
def general(monkeypatch):
    """Counts the calls of the general program."""
    calls = []
    solve = programs._solve_numbers
    monkeypatch.setattr(programs, "_solve_numbers", lambda *args: calls.append(args) or solve(*args))
    return calls


def both_ways(mechanism, drive, values):
    """Displacements and status by formula and by the general program."""
    (element,) = plan_drive(mechanism.linkage, (drive,)).elements
    given = element.system, SolverOptions(), element.joints, np.asarray(values)[None], _closure_tolerance(None)
    return programs.solve(*given, element.axes), programs.solve(*given)


CASES = {
    "four-bar": (planar_fourbar, "A"),
    "slider-crank": (slider_crank, "A"),
    "quick return": (catalogue.quick_return, "A"),
    "scotch yoke": (catalogue.scotch_yoke, "A"),
    "Jansen": (catalogue.jansen, "O"),
    "Watt": (catalogue.watt, "A"),
    "Cardan": (cardan_shafts, "in"),
    "spherical four-bar": (spherical_linkage, "A"),
    "RSSR": (rssr_linkage, "A"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_the_poses_are_those_of_the_general_program(name, general):
    """Over a turn, and over a short range on either side; both find the angles of balls and full turns alike."""
    make, drive = CASES[name]
    mechanism = make()
    for values in (np.linspace(0.0, TURN, 64), np.linspace(-1.2, 0.4, 64), np.linspace(-7.0, 11.0, 64)):
        (x, outcome), (expected, wanted) = both_ways(mechanism, drive, values)
        size = np.abs(expected).max()
        np.testing.assert_allclose(x, expected, atol=WITHIN * max(size, 1.0))
        np.testing.assert_array_equal(outcome.status, wanted.status)
    assert len(general) == 3  # of `both_ways`; none by the formulas


def test_no_general_program_where_all_poses_are_proven(general):
    motion = planar_fourbar().sweep({"A": np.linspace(0.0, TURN, 50)})
    assert not general and np.all(motion.closed) and np.max(motion.residual) < 1e-14


def test_a_range_with_limits_is_left_to_the_general_program(general):
    """A double rocker: the crank, longer than all others, stops short of a turn on either side."""
    mechanism = planar_fourbar(1.0, crank=90.0, coupler=60.0, rocker=80.0)
    inputs = np.linspace(-3.0, 3.0, 41)
    motion = mechanism.sweep({"A": inputs})
    assert len(general) == 1
    assert set(np.unique(motion.status)) >= {Status.CLOSED, Status.UNREACHABLE}
    near = np.abs(inputs) < 0.2
    short = mechanism.sweep({"A": inputs[near]})
    assert len(general) == 1  # this part of it has no limit
    np.testing.assert_allclose(short.coordinates["D"], motion.coordinates["D"][near], atol=WITHIN)


def test_a_change_point_is_left_to_the_general_program(general):
    motion = catalogue.parallelogram(2).sweep({"A": np.linspace(0.0, TURN, 31)})
    assert len(general) == 1 and np.all(motion.closed)


def test_one_pose_far_away_has_the_turns_that_led_to_it(general):
    """A pose alone counts the turns of the way to it, as the same pose of a whole range does."""
    mechanism = planar_fourbar()
    whole = mechanism.sweep({"A": np.linspace(0.0, 3 * TURN, 100)})
    alone = mechanism.sweep({"A": [3 * TURN]})
    assert not general
    np.testing.assert_allclose(alone.coordinates["B"][0], whole.coordinates["B"][-1], atol=WITHIN)
    np.testing.assert_allclose(alone.coordinates["B"][0], [-3 * TURN], atol=WITHIN)


def test_changed_lengths_are_closed_on_the_branch_of_the_assembled_pose(general):
    """Loops that are open at the assembled pose, by a percent of a link."""
    mechanism = planar_fourbar()
    longer = mechanism.with_lengths({("coupler", "B", "C"): 121.0})
    assert any(not np.array_equal(joint.frames_1, joint.frames_2) for joint in longer.joints.values())
    values = np.linspace(0.0, TURN, 64)
    (x, outcome), (expected, wanted) = both_ways(longer, "A", values)
    assert len(general) == 1
    np.testing.assert_allclose(x, expected, atol=WITHIN)
    np.testing.assert_array_equal(outcome.status, wanted.status)


def test_the_tolerance_and_the_method_that_are_asked_for_decide(general):
    inputs = np.linspace(0.0, 1.0, 20)
    mechanism = planar_fourbar()
    mechanism.sweep({"A": inputs}, options=jk.SolverOptions(method="gauss-newton"))
    assert len(general) == 1


@pytest.mark.long
def test_derivatives_are_the_implicit_ones(general):
    """By the inputs and by the geometry; the poses of a gradient are found by formula, too."""
    inputs = jnp.linspace(0.0, TURN, 20)
    mechanism = planar_fourbar()

    def path(mechanism, inputs):
        return jnp.sum(mechanism.sweep({"A": inputs}).coordinates["D"] ** 2)

    by_formula = jax.grad(path, argnums=(0, 1))(mechanism, inputs)
    inside = jax.jit(jax.grad(path, argnums=(0, 1)))(mechanism, inputs)  # all is traced: the general program
    assert not general
    for found, expected in zip(jax.tree.leaves(by_formula), jax.tree.leaves(inside), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-9, rtol=1e-11)
