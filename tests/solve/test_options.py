"""Options of the solver: what they do, that they travel with a motion, and what is refused."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.execution.compiler import compilations, known_options
from reference.mechanisms import planar_fourbar

TURN = np.linspace(0.0, 2 * np.pi, 20)


def test_options_are_hashable_and_equal_by_value():
    assert hash(jk.SolverOptions(tolerance=1e-9)) == hash(jk.SolverOptions(tolerance=np.float64(1e-9)))
    assert jk.SolverOptions(max_steps=9) == jk.SolverOptions(max_steps=9) != jk.SolverOptions()


NEWTON = jk.SolverOptions(formulas=False)


@pytest.mark.long
def test_a_shorthand_is_the_option():
    mechanism = planar_fourbar(1.0)
    short = mechanism.sweep({"A": TURN}, tolerance=1e-3, options=NEWTON)
    options = mechanism.sweep({"A": TURN}, options=jk.SolverOptions(tolerance=1e-3, formulas=False))
    assert short.options == options.options == jk.SolverOptions(tolerance=1e-3, formulas=False)
    np.testing.assert_array_equal(short.coordinates["D"], options.coordinates["D"])
    assert 1e-9 < np.max(short.residual) <= 1e-3  # improved no further than asked for


@pytest.mark.long
@pytest.mark.parametrize(
    "options",
    [
        jk.SolverOptions(tolerance=3e-16, interpolate_from=64),
        *[jk.SolverOptions(tolerance=3e-16, formulas=formulas) for formulas in (True, False)],
    ],
)
def test_no_closed_pose_is_above_a_tolerance_that_rounding_does_not_reach(options):
    """Of these poses rounding leaves some or all above 3e-16: they are not closed, nor out of reach."""
    motion = planar_fourbar(1.0).sweep({"A": np.linspace(0.0, 2 * np.pi, 100)}, options=options)
    above = np.asarray(motion.residual) > 3e-16
    assert np.any(above)
    np.testing.assert_array_equal(motion.status, np.where(above, jk.Status.STALLED, jk.Status.CLOSED))


def test_options_of_running_compile_nothing():
    """Tolerance and cores are no part of the compiled program."""
    mechanism = planar_fourbar(1.0)
    mechanism.sweep({"A": TURN})
    before = compilations()
    for options in (jk.SolverOptions(tolerance=1e-6), jk.SolverOptions(cores=1), jk.SolverOptions(min_shard_poses=99)):
        mechanism.sweep({"A": TURN}, options=options)
    assert compilations() == before


def test_an_option_at_its_default_compiles_nothing():
    mechanism = planar_fourbar(1.0)
    mechanism.sweep({"A": TURN})
    before = compilations()
    mechanism.sweep({"A": TURN}, options=jk.SolverOptions(newton_iterations=4))
    assert compilations() == before


@pytest.mark.long
def test_poses_do_not_depend_on_the_iterations_of_newtons_method():
    """What few iterations leave open the damped corrector closes, to the same tolerance."""
    mechanism = planar_fourbar(1.0)
    options = [jk.SolverOptions(newton_iterations=n, formulas=False) for n in (4, 1)]
    usual, few = (mechanism.sweep({"A": TURN}, options=each) for each in options)
    assert np.all(few.status == jk.Status.CLOSED)
    # residuals of 1e-12 over singular values of some 0.1
    np.testing.assert_allclose(few.coordinates["D"], usual.coordinates["D"], atol=1e-10)


@pytest.mark.long
def test_few_steps_leave_poses_stalled():
    """A step is at most 0.3 long: three of them do not pass 0.9 in either direction."""
    wide = np.linspace(-3.0, 3.0, 20)
    motion = planar_fourbar(1.0).sweep({"A": wide}, options=jk.SolverOptions(max_steps=3, formulas=False))
    beyond = np.abs(wide) > 0.9
    assert set(np.asarray(motion.status)[beyond].tolist()) == {jk.Status.STALLED}


@pytest.mark.long
def test_the_options_of_a_motion_go_where_it_goes():
    options = jk.SolverOptions(tolerance=1e-6, cores=1)
    mechanism = planar_fourbar(1.0)
    motion = mechanism.sweep({"A": TURN}, options=options)
    assert jax.tree.map(lambda leaf: leaf, motion).options == options
    assert jk.velocities(motion, {"A": 1.0}).motion.options == options
    assert [chunk.options for chunk in mechanism.stream({"A": TURN}, 10, options=options)] == [options, options]


@pytest.mark.long
def test_a_traced_tolerance_is_no_static_option():
    mechanism = planar_fourbar(1.0)

    def swept(tolerance):
        motion = mechanism.sweep({"A": TURN}, tolerance=tolerance, options=NEWTON)
        assert motion.options == NEWTON
        return motion.residual

    assert 1e-9 < np.max(jax.jit(swept)(1e-3)) <= 1e-3


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"tolerance": 0.0}, "tolerance must be a positive finite number such as 1e-9, got 0.0"),
        ({"tolerance": np.inf}, "got inf"),  # with it every pose would be closed
        ({"method": "dpf"}, "there is no method 'dpf' among continuation, .*did you mean 'dfp'"),
        (
            {"max_steps": 0},
            r"max_steps must be a whole number, 1 or more, such as .*\(max_steps=2\), got 0",
        ),
        ({"rescue_steps": True}, r"rescue_steps must be a whole number.*\(rescue_steps=200\), got True"),
    ],
)
def test_wrong_values_are_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        jk.SolverOptions(**wrong)


def test_saying_a_thing_twice_or_otherwise_is_refused():
    mechanism, options = planar_fourbar(1.0), jk.SolverOptions(tolerance=1e-6, method="dfp")
    with pytest.raises(ValueError, match=r"tolerance is given twice, as tolerance=1e-09 and as options=.*1e-06"):
        mechanism.sweep({"A": TURN}, options=options, tolerance=1e-9)
    with pytest.raises(ValueError, match=r"method is given twice, as method='bfgs' and as options=.*'dfp'"):
        mechanism.stream({"A": TURN}, options=options, method="bfgs")
    with pytest.raises(ValueError, match=r"options say method='dfp', which is varied here"):
        jk.work_precision(mechanism, {"A": TURN}, options=jk.SolverOptions(method="dfp"))


@pytest.mark.long
def test_effects_are_those_of_the_poses_of_the_motion():
    """At a coarse tolerance the poses of Newton's method, and so the rates, are off by about as much."""
    mechanism, turn = planar_fourbar(1.0), jnp.asarray(TURN)
    fine, coarse = (jk.SolverOptions(tolerance=tolerance, formulas=False) for tolerance in (None, 1e-3))
    fine, coarse = (mechanism.sweep({"A": turn}, options=options) for options in (fine, coarse))
    exact, rates = (jk.velocities(motion, {"A": 1.0}).coordinates["D"] for motion in (fine, coarse))
    assert 1e-9 < np.max(np.abs(rates - exact)) < 1e-1


def test_compiler_options_that_jax_does_not_know_are_left_out():
    known = {"xla_cpu_multi_thread_eigen": False}
    assert known_options(known | {"xla_of_another_version": True}) == known
    assert known_options({"xla_of_another_version": True}) == {}
