"""Sweeps by formula: poses, statuses, derivatives are the general program's, which is compiled only where needed."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.sweep import closure_tolerance
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
    solve = programs.solve_numbers
    monkeypatch.setattr(programs, "solve_numbers", lambda *args, **more: calls.append(args) or solve(*args, **more))
    return calls


def both_ways(mechanism, drive, values):
    """Displacements and status by formula and by the general program."""
    (element,) = plan_drive(mechanism.linkage, (drive,)).loop_groups
    given = element.system, SolverOptions(), element.joints, np.asarray(values)[None], closure_tolerance(None)
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


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
def test_the_tolerance_and_the_method_that_are_asked_for_decide(general):
    inputs = np.linspace(0.0, 1.0, 20)
    mechanism = planar_fourbar()
    mechanism.sweep({"A": inputs}, options=jk.SolverOptions(method="gauss-newton"))
    assert len(general) == 1


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "ways"),
    [
        pytest.param("four-bar", "001110", marks=pytest.mark.study),
        ("slider-crank", "000110"),
        ("RSSR", "111111"),
        pytest.param("Watt", "001110", marks=pytest.mark.study),
        pytest.param("spherical four-bar", "111000", marks=pytest.mark.study),
    ],
)
def test_derivatives_are_the_implicit_ones(name, ways, general):
    """By the inputs, and by where the joints are: all frames are displaced, in ways that keep the loops closed."""
    make, drive = CASES[name]
    mechanism, inputs = make(), jnp.linspace(-0.4, 0.9, 20)
    motions = jnp.asarray(np.random.default_rng(0).normal(size=(len(mechanism.joints), 6)))
    scale = jnp.asarray([1.0, 1.0, 1.0, 50.0, 50.0, 50.0]) * jnp.asarray([float(way) for way in ways])

    def last(inputs, by, options=None):
        placed = {
            joint: moved(by * scale * motion, jnp.asarray(mechanism.joints[joint].frames_1[0]))
            for joint, motion in zip(mechanism.joints, motions, strict=True)
        }
        motion = mechanism.with_frames(placed).sweep({drive: inputs}, options=options)
        return sum(
            jnp.sum(jnp.sin(0.02 * rows) @ jnp.arange(1.0, 1.0 + rows.shape[1])) for rows in motion.displacements
        )

    gradient = jax.grad(last, argnums=(0, 1))
    implicit = jax.jit(partial(gradient, options=jk.SolverOptions(formulas=False)))(inputs, 0.0)
    for by_formula in (gradient(inputs, 0.0), jax.jit(gradient)(inputs, 0.0)):
        for found, expected in zip(by_formula, implicit, strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-10, rtol=1e-10)
    assert not general


def moved(twist, frame):
    """A frame moved by a small displacement: rotation about the origin and translation, to the first order."""
    (x, y, z), shift = twist[:3], twist[3:]
    turn = jnp.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return frame.at[:3].add(turn @ frame[:3]).at[:3, 3].add(shift)


@pytest.mark.long
def test_derivatives_at_a_limit_are_finite():
    """The rocker drives, up to where coupler and crank are in line: there the angle of the crank has no derivative."""
    mechanism = planar_fourbar()
    low, high = limits_of_rocker(mechanism)
    inputs = jnp.asarray([0.5 * low, low, high, 2 * high])

    def crank(inputs, length):
        changed = mechanism.with_lengths({("coupler", "B", "C"): length})
        return jnp.sum(jnp.nan_to_num(changed.sweep({"D": inputs}).coordinates["A"], nan=1e300))

    for derivative in jax.jit(jax.grad(crank, argnums=(0, 1)))(inputs, 120.0):
        assert np.all(np.isfinite(derivative))


def limits_of_rocker(mechanism):
    """Largest and least angle of the rocker of a crank-rocker: its dead points, to rounding."""
    angles = mechanism.sweep({"A": np.linspace(0.0, TURN, 721)}).coordinates["D"][:, 0]
    return float(angles.min()), float(angles.max())


@pytest.mark.long
def test_designs_by_formula_are_those_of_the_general_solver():
    """Some of them have limits within the range, behind which poses are not reached by either."""
    mechanism, inputs = planar_fourbar(), np.linspace(-2.0, 2.0, 40)

    def swept(length, formulas):
        changed = mechanism.with_lengths({("rocker", "C", "D"): length})
        motion = changed.sweep({"A": inputs}, options=jk.SolverOptions(formulas=formulas))
        return motion.coordinates["D"], motion.status

    lengths = jnp.linspace(55.0, 100.0, 12)
    (found, status), (expected, wanted) = (
        jax.jit(jax.vmap(partial(swept, formulas=formulas)))(lengths) for formulas in (True, False)
    )
    np.testing.assert_array_equal(status, wanted)
    assert {0, 1} <= set(np.unique(status))
    closed = np.asarray(status) == Status.CLOSED
    np.testing.assert_allclose(found[closed], expected[closed], atol=1e-9)  # near limits


@pytest.mark.long
@pytest.mark.parametrize("traced", [False, True])
def test_a_change_point_inside_of_jit(traced):
    """Where the geometry is known the general program follows it; else poses behind it are in doubt, not wrong."""
    mechanism, inputs = catalogue.parallelogram(2), jnp.linspace(0.3, 3.7, 9)
    expected = mechanism.sweep({"A": inputs})

    def swept(inputs, mechanism=mechanism):
        motion = mechanism.sweep({"A": inputs})
        return motion.displacements, motion.status

    displacements, status = jax.jit(swept)(*((inputs, mechanism) if traced else (inputs,)))
    beyond = np.asarray(inputs) > np.pi
    assert np.all(np.asarray(status)[beyond] == (Status.STALLED if traced else Status.CLOSED))
    for found, wanted in zip(displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(np.asarray(found)[status == 0], np.asarray(wanted)[status == 0], atol=1e-9)


@pytest.mark.long
def test_a_slide_that_drives(general):
    """Both ways from the assembled pose, and to the end of the stroke on one side."""
    mechanism = slider_crank()
    turn = mechanism.sweep({"A": np.linspace(0.0, TURN, 400)})
    stroke = np.asarray(turn.coordinates["S"][:, 0])
    low, high = 0.9 * stroke.min(), 0.9 * stroke.max()
    motion = mechanism.sweep({"S": np.linspace(low, high, 21)})
    assert not general and np.all(motion.closed)
    back = mechanism.sweep({"A": motion.coordinates["A"][:, 0]})
    np.testing.assert_allclose(back.coordinates["S"], motion.coordinates["S"], atol=1e-9)


@pytest.mark.long
@pytest.mark.parametrize(
    ("make", "key", "factor"),
    [
        (rssr_linkage, ("rod", "B", "C"), 1.2),
        (spherical_linkage, ("coupler", "B", "C", "angle"), 1.7),
    ],
)
def test_a_design_in_doubt_has_derivatives_in_space(make, key, factor):
    """The loops do not close at the input from which displacements count, but do elsewhere: a search is to get on from
    there. Slopes of lengths and of the input are those of differences."""
    mechanism = make()
    before = float(mechanism.lengths[key])

    def swept(change):
        motion = mechanism.with_lengths({key: before * (factor + change)}).sweep({"A": 2.0 + change + jnp.arange(2)})
        return motion.coordinates["D"][:, 0], motion.status

    both = jax.jit(lambda change: jax.jvp(swept, (change,), (jnp.ones(()),)))
    (_, status), (slopes, _) = both(0.0)
    np.testing.assert_array_equal(status, Status.STALLED)
    (one, _), (other, _) = (both(step)[0] for step in (-1e-5, 1e-5))
    # central differences: the third derivative times 1e-10, and rounding over the step
    np.testing.assert_allclose(slopes, (other - one) / 2e-5, rtol=1e-6)
    assert np.all(np.abs(np.asarray(slopes)) > 1e-3)
