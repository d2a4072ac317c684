"""One program for ranges of any length, whose poses are those of the whole range; NumPy and JAX compute alike."""

import gc
import weakref

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.mechanism import formula_sweep
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.sweep import _known_tolerance, closure_tolerance
from jaxkin.solve.closed_form.input_line import NODES, full_turn, passed_range
from jaxkin.solve.closed_form.solve_groups import residual_norm, solve_groups
from jaxkin.solve.execution.compiler import compilations
from jaxkin.solve.execution.design_batches import DESIGN_GROUP
from jaxkin.solve.status import Status
from reference import catalogue, planar
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank, spherical_linkage

TURN = 2 * np.pi
COUNTS = (2, 3, 5, 11, 31, 61, 100, 101, 200, 255, 360, 361, 384, 385, 500, 767, 768, 769, 1000, 1153)
"""Twenty numbers of poses, those beside whole chunks among them."""


@pytest.mark.long
def test_two_programs_serve_any_number_of_poses():
    """One for a single pose, and one for all other numbers; and every pose is the same in all of them."""
    mechanism, inputs = planar_fourbar(1.3), np.linspace(0.0, 2 * TURN, max(COUNTS))
    before = compilations()
    whole = mechanism.sweep({"A": inputs})
    assert compilations() - before <= 1
    alone = mechanism.sweep({"A": inputs[-1:]})
    for count in COUNTS:
        motion = mechanism.sweep({"A": inputs[:count]})
        assert len(motion) == count and motion.inputs["A.phi"].shape == (count,)
        for found, expected in zip(motion.displacements, whole.displacements, strict=True):
            np.testing.assert_array_equal(found, expected[:count])
        np.testing.assert_array_equal(motion.residual, whole.residual[:count])
        np.testing.assert_array_equal(motion.status, Status.CLOSED)
    assert compilations() - before <= 2
    for found, expected in zip(alone.displacements, whole.displacements, strict=True):
        np.testing.assert_allclose(found, expected[-1:], atol=1e-13)  # another program: some roundings of two turns


def test_tolerances_of_earlier_sweeps_are_let_go():
    sweep, values = plan_drive(planar_fourbar(1.3).linkage, ("A",)).formula_sweep, (np.linspace(0.0, 1.0, 2),)
    assert sweep is not None
    asked = [closure_tolerance(10.0**-power) for power in (5, 6)]
    earlier = weakref.ref(asked[0].max_residual)
    for tolerance in asked:
        assert sweep.solve(values, None, tolerance, 1) is not None
    _known_tolerance.cache_clear()
    del asked[0], tolerance
    gc.collect()
    assert earlier() is None


@pytest.mark.long
def test_where_the_motion_passes_without_doubt_no_pose_needs_a_certificate():
    """The rocker swings between the poses in which crank and coupler are in line; poses from there to there but for
    the last nodes are those of the general solver, on either side of the assembled pose."""
    mechanism = planar_fourbar()
    (element,) = plan_drive(mechanism.linkage, ("D",)).loop_groups
    lowest, highest = passed_range(element.system, element.line)
    in_line = np.array([120.0 - 40.0, 120.0 + 40.0])
    ends = np.pi - np.arccos((100.0**2 + 80.0**2 - in_line**2) / (2 * 100.0 * 80.0))  # of the rocker, from x
    at = planar.fourbar(np.array([1.0])).rocker_pin[0] - [100.0, 0.0]
    least, most = sorted(ends - np.arctan2(at[1], at[0]))
    node = TURN / (NODES - 1)
    assert least < lowest < least + 2 * node and most - 2 * node < highest < most
    inputs = np.linspace(lowest, highest, 50)
    motion = mechanism.sweep({"D": inputs})
    expected = mechanism.sweep({"D": inputs}, options=jk.SolverOptions(formulas=False))
    assert np.all(motion.closed) and np.all(expected.closed)
    for found, wanted in zip(motion.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(found, wanted, atol=1e-12)  # some thousand roundings of radians


@pytest.mark.long
@pytest.mark.parametrize("often", [1, 10**9])
def test_results_are_joined_alike_by_a_program_and_on_the_host(often, monkeypatch):
    """Angles of balls, of which each chunk counts its own turns, go on from chunk to chunk."""
    monkeypatch.setattr(formula_sweep, "OFTEN", often)
    inputs = np.linspace(0.0, 1.5 * TURN, 500)
    motion = rssr_linkage().sweep({"A": inputs})
    assert np.all(motion.closed)
    for rows in motion.displacements:
        assert rows.shape[0] == 500 and isinstance(rows, jax.Array)
        # neighbouring poses are 0.019 rad apart at the crank; no angle of this linkage runs fifty times as fast
        assert np.max(np.abs(np.diff(rows, axis=0))) < 1.0
    np.testing.assert_allclose(motion.coordinates["A"][:, 0], inputs, atol=1e-15)


@pytest.mark.long
def test_long_ranges_are_shared_by_the_cores():
    """In chunks of their own, the first of which compiles their program; poses are those of short ranges, also where
    one of them has no number and angles of balls go on from chunk to chunk."""
    mechanism, inputs = rssr_linkage(), np.linspace(0.0, 2 * TURN, 5 * formula_sweep.LONG_CHUNK + 11)
    few = mechanism.sweep({"A": inputs[::64]})
    inputs[77] = np.nan
    before = compilations()
    for cores in (1, 2, 3, 8):
        motion = mechanism.sweep({"A": inputs}, options=jk.SolverOptions(cores=cores))
        assert np.flatnonzero(motion.status != Status.CLOSED).tolist() == [77]
        for found, expected in zip(motion.displacements, few.displacements, strict=True):
            np.testing.assert_allclose(found[::64], expected, atol=1e-12)  # some roundings of two turns
    assert compilations() - before == 1


def test_a_long_range_beyond_a_limit_is_left_to_the_general_solver():
    """A rocker that is driven farther than it goes: without a call of the program, as not all poses can be proven."""
    sweep = plan_drive(planar_fourbar().linkage, ("D",)).formula_sweep
    assert sweep is not None
    inputs, before = np.linspace(-1.5, 0.6, formula_sweep.LONG_RANGE), compilations()
    assert sweep.solve((inputs,), None, closure_tolerance(None), 2) is None
    assert compilations() == before


def test_nan_among_known_inputs_spoils_no_other_pose():
    inputs = np.linspace(0.0, 1.0, 5)
    expected = planar_fourbar().sweep({"A": inputs})
    inputs[2] = np.nan
    motion = planar_fourbar().sweep({"A": inputs})
    assert list(motion.status) == [Status.CLOSED] * 2 + [Status.NONFINITE] + [Status.CLOSED] * 2
    np.testing.assert_array_equal(motion.inputs["A.phi"], inputs)
    keep = np.array([0, 1, 3, 4])
    for found, wanted in zip(motion.displacements, expected.displacements, strict=True):
        assert np.all(np.isnan(found[2]))
        np.testing.assert_allclose(found[keep], wanted[keep], atol=1e-14)


@pytest.mark.long
@pytest.mark.parametrize(
    ("make", "drive"),
    [
        (slider_crank, "A"),
        (catalogue.scotch_yoke, "A"),
        (spherical_linkage, "A"),
        (rssr_linkage, "A"),
    ],
)
def test_numpy_and_jax_compute_the_same_poses_and_the_same_line(make, drive):
    """The line of a known mechanism comes from NumPy, that of traced geometry from the program: one formula, two
    routes through other cosines and arc tangents."""
    (element,) = plan_drive(make().linkage, (drive,)).loop_groups
    system, axes, line = element.system, element.axes, element.line
    values = np.linspace(-1.0, 2.0, 9)[None]

    def poses(axes, values):
        solved = solve_groups(system, axes, list(line.signs), values)
        return (
            solved.x,
            np.stack(solved.discriminants) if isinstance(axes.centre, np.ndarray) else jnp.stack(solved.discriminants),
            residual_norm(system, axes, solved.coordinates),
        )

    for found, expected in zip(jax.jit(poses)(axes, values), poses(axes, values), strict=True):
        assert isinstance(expected, np.ndarray)
        np.testing.assert_allclose(found, expected, atol=1e-13)  # some hundred roundings: angles of up to pi
    by_jax = jax.jit(lambda axes: full_turn(system, axes))(jax.tree.map(jnp.asarray, axes))
    for found, expected in zip((*by_jax[:-1], *by_jax.windings), (*line[:-1], *line.windings), strict=True):
        np.testing.assert_allclose(np.asarray(found, float), np.asarray(expected, float), atol=1e-13)


@pytest.mark.long
def test_designs_in_groups_are_those_of_each_alone_with_their_gradients():
    """Three groups, the last one padded; a tenth of these rockers is too short for a full turn of the crank."""
    mechanism, inputs = planar_fourbar(), np.linspace(0.0, TURN, 6)
    lengths = jnp.linspace(57.0, 110.0, 2 * DESIGN_GROUP + 7)

    def swing(length):
        motion = mechanism.with_lengths({("rocker", "C", "D"): length}).sweep({"A": inputs})
        return jnp.sum(jnp.where(motion.closed, motion.coordinates["D"][:, 0], 0.0)), motion.status

    (found, status), slopes = jax.jit(jax.vmap(jax.value_and_grad(swing, has_aux=True)))(lengths)
    assert set(np.unique(status)) >= {Status.CLOSED, Status.UNREACHABLE}
    for number in (0, DESIGN_GROUP, len(lengths) - 1):
        expected, alone = swing(float(lengths[number]))
        np.testing.assert_allclose(found[number], expected, atol=1e-12)
        np.testing.assert_array_equal(status[number], alone)
        one, other = (swing(float(lengths[number]) + step)[0] for step in (-1e-4, 1e-4))
        # central differences: rounding of 1e-15 over the step, and the third derivative times its square
        np.testing.assert_allclose(slopes[number], (other - one) / 2e-4, atol=1e-8)
