"""One program for problems of one structure, and another one for whatever else computes something else."""

import re

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from jaxkin.design.own_functions import own_function
from jaxkin.design.problem import design_problem, taken_apart
from jaxkin.design.variables import variables
from jaxkin.solve.execution import two_tiers
from jaxkin.solve.options import SolverOptions
from reference.mechanisms import planar_fourbar

TURN = np.linspace(0.0, 2.0, 5)
POINT = (30.0, 60.0, 0.0)
CRANK, COUPLER = ("crank", "A", "B"), ("coupler", "B", "C")
TARGETS = np.ones((5, 2))
NUMBERS = jax.ShapeDtypeStruct((3,), float)
shared = 2.0


def structure(loss=None, ground=100.0, drive=TURN, lengths=None, extras=None, constraints=(), **options):
    """The structure of a problem of a four-bar; everything else as asked for."""
    mechanism = planar_fourbar(1.0, ground=ground)
    chosen = variables(mechanism, {"A": drive}, lengths or {CRANK: (20.0, 60.0)}, {}, extras or {}, {})
    loss = loss or design.path("coupler", POINT, TARGETS)
    problem = design_problem(loss, True, mechanism, chosen, constraints, SolverOptions(**options))
    return taken_apart(problem)[0]


def started(factor):
    """A drive that begins at an extra, and grows by a factor of its own."""
    return lambda extras: extras["first"] + factor * TURN


FIRST = {"first": design.Free(0.5, 0.0, 1.0)}


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ({}, {"ground": 101.0, "drive": TURN + 0.1, "lengths": {CRANK: (30.0, 70.0)}}, True),
        ({}, {"loss": 3.0 * design.path("coupler", (1.0, 2.0), 2 * TARGETS)}, True),
        ({"constraints": [design.above("D", 0.1)]}, {"constraints": [design.above("D", 0.2, 3.0)]}, True),
        ({"drive": started(1.0), "extras": FIRST}, {"drive": started(1.0), "extras": FIRST}, True),
        ({}, {"lengths": {COUPLER: (90.0, 150.0)}}, False),
        ({}, {"loss": design.path("crank", POINT, TARGETS)}, False),
        ({}, {"loss": design.path("coupler", POINT, TARGETS, timing=False)}, False),
        ({"constraints": [design.above("D", 0.1)]}, {"constraints": [design.above("C", 0.1)]}, False),
        ({}, {"newton_iterations": 5}, False),
        ({"drive": started(1.0), "extras": FIRST}, {"drive": started(1.1), "extras": FIRST}, False),
    ],
)
def test_numbers_are_no_part_of_the_structure(one, other, same):
    assert (structure(**one) == structure(**other)) == same


def doubled(x):
    return shared * jnp.sin(x)


@jax.custom_jvp
def steep(x):
    return 2.0 * jnp.sin(x)


steep.defjvp(lambda primals, tangents: (steep(*primals), 7.0 * tangents[0]))


def test_functions_of_users_are_what_they_compute(monkeypatch):
    def operations(function, forward=True):
        return own_function(function, "", (NUMBERS,), forward)

    def scaled(by):
        return lambda x: jnp.sum(by * jnp.sin(x))

    arrays = [np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.0 + 1e-15])]
    for forward in (True, False):
        assert operations(scaled(arrays[0]), forward) == operations(scaled(arrays[0].copy()), forward)
        assert operations(scaled(arrays[0]), forward) != operations(scaled(arrays[1]), forward)
    before = operations(doubled)
    assert before == operations(lambda x: 2.0 * jnp.sin(x)) != operations(steep)
    monkeypatch.setitem(globals(), "shared", 3.0)
    assert operations(doubled) != before

    # of a function of Python that is called back, only its place is known
    def called(function):
        return lambda x: jnp.sum(jax.pure_callback(function, x, jax.lax.stop_gradient(x)))

    assert operations(called(np.sin)) != operations(called(np.cos))


@pytest.mark.long
def test_a_like_problem_is_solved_by_the_program_that_is_there(monkeypatch):
    """The crank that drew the path is found, without a compilation, from other numbers than those compiled for."""
    count, compile_it = [], two_tiers._compiled
    monkeypatch.setattr(two_tiers, "_compiled", lambda *given, **also: count.append(1) or compile_it(*given, **also))

    def found(ground, crank):
        start = planar_fourbar(1.0, ground=ground)
        path = start.with_lengths({CRANK: crank}).sweep({"A": TURN}).points("coupler", POINT)[:, :2]
        best = jk.optimize(
            design.path("coupler", POINT, path), start, drive={"A": TURN}, lengths={CRANK: (0.5 * crank, 50.0)}
        )
        return best.values["(crank, A, B)"]

    for ground, crank in ((100.0, 38.0), (103.0, 42.0), (100.0, 38.0)):
        # squares of residuals fall to rounding, and the crank with them to its root
        assert found(ground, crank) == pytest.approx(crank, rel=1e-9)
        assert len(count) == 1


@pytest.mark.long
def test_a_search_compiles_whole_programs_only(caplog):
    """Operations of the device that are called one by one are compiled one by one: some 20 ms each."""
    jax.clear_caches()
    with jax.log_compiles():
        jk.optimize(
            design.path("coupler", POINT, TARGETS),
            planar_fourbar(1.0),
            drive={"A": TURN},
            lengths={CRANK: (20.0, 60.0)},
            starts=2,
            solver=design.LevenbergMarquardt(iterations=10),
        )
    compiled = re.findall(r"Finished XLA compilation of jit\((.*?)\)", caplog.text)
    # "<lambda>" tells whether numbers are traced, or which options the compiler knows
    assert "program" in compiled and set(compiled) <= {"program", "_find", "_collect_chunks", "<lambda>"}
