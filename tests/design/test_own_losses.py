"""Losses and constraints of users as they come: negative ones, of any size, and some that are none."""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from jaxkin._progress import ProgressBar
from jaxkin.design.augmented_lagrangian import Penalty
from jaxkin.design.bounds import Entry
from jaxkin.design.own_functions import takes_extras
from jaxkin.design.search import search
from jaxkin.design.solvers import CHUNK, Solver
from jaxkin.design.variables import Variables, variables
from reference.mechanisms import planar_fourbar

FEW = np.linspace(0.0, 0.2, 3)
LBFGS, SQUARES = design.LBFGS(), design.LevenbergMarquardt()


def falling(pace, floor) -> Solver:
    """A solver whose loss in each start is the vector itself, which falls by `pace` an iteration, to `floor`."""

    def advance(state, penalty, active):
        losses = np.array([np.where(active, np.maximum(state - pace * (k + 1), floor), np.nan) for k in range(CHUNK)])
        return np.where(active, losses[-1], state), losses

    def nothing(*given):
        raise AssertionError

    return Solver(lambda vectors, penalty: vectors, advance, lambda state: state, nothing, nothing, nothing)


@pytest.mark.parametrize("start", [50.0, 0.05, -1000.0])
def test_a_search_goes_on_below_zero(start):
    """Whatever constant is added to a loss, it is searched until it falls no more: five from its start, 0.05 each
    time."""
    penalty = Penalty.plain(1.0, 1, 0)
    found, reason, history = search(
        falling(0.05, start - 5.0), np.array([start]), penalty, np.ones(1, bool), LBFGS, ProgressBar(300, False, "")
    )
    assert found[0] == start - 5.0
    assert reason.startswith("converged after 110 iterations") and len(np.concatenate(history)) == 110


def test_a_start_that_falls_fast_below_zero_is_not_hopeless():
    """The second start is behind the first one, and passes it: by its pace after 40 iterations more."""
    penalty, starts = Penalty.plain(1.0, 2, 0), np.array([-5.0, -1.0])
    found, _, _ = search(
        falling(np.array([1e-4, 0.1]), -np.inf), starts, penalty, np.ones(2, bool), LBFGS, ProgressBar(300, False, "")
    )
    assert found[1] == pytest.approx(-1.0 - 0.1 * 300)


def rosenbrock(extras):
    return (1 - extras["x"]) ** 2 + 100 * (extras["y"] - extras["x"] ** 2) ** 2


@pytest.mark.long
@pytest.mark.parametrize(("size", "shift"), [(1e12, 0.0), (1e-12, 0.0), (1.0, -1000.0)])
def test_any_loss_may_be_in_any_unit_and_negative(size, shift):
    """Rosenbrock's valley ends at (1, 1), whatever its height and depth; its slopes are up to 1e16 here."""
    best = jk.optimize(
        lambda motion, extras: size * (rosenbrock(extras) + shift),
        planar_fourbar(1.0),
        drive={"A": FEW},
        extras={"x": design.Free(2.9, 0.0, 3.0), "y": design.Free(0.2, 0.0, 3.0)},
    )
    # rounding of the shift hides what is left of the loss, and its root of the place
    np.testing.assert_allclose([best.values["x"], best.values["y"]], 1.0, atol=1e-5 if shift else 1e-9)


@pytest.mark.long
def test_a_bad_foundis_worse_than_any_loss():
    """Least 1e16 x, which is NaN below 1.3: the boundary is found, and not crossed."""
    best = jk.optimize(
        lambda motion, extras: jnp.where(extras["x"] < 1.3, jnp.nan, 1e16 * extras["x"]),
        planar_fourbar(1.0),
        drive={"A": FEW},
        extras={"x": design.Free(2.0, 0.0, 3.0)},
    )
    # trials are 0.4 times as long each
    assert 1.3 <= best.values["x"] < 1.4


@pytest.mark.long
def test_bounds_may_be_as_wide_as_none():
    """Least (x - 1)^2 + 4 (y - 2)^2 between bounds of a million million times the way: no first step is short enough,
    and a shorter one is tried. What is found is as exact as rounding of the bounds allows."""
    best = jk.optimize(
        lambda motion, extras: (extras["x"] - 1) ** 2 + 4 * (extras["y"] - 2) ** 2,
        planar_fourbar(1.0),
        drive={"A": FEW},
        extras={"x": design.Free(2.0, -1e12, 1e12), "y": design.Free(0.0, -1e-9, 1e9)},
    )
    np.testing.assert_allclose([best.values["x"], best.values["y"]], [1.0, 2.0], atol=5e-4)


@pytest.mark.long
def test_a_constraint_that_is_infinite_is_no_number():
    """-inf tells no direction in which it would be met; the result was a loss that is infinite."""
    given = {"drive": {"A": FEW}, "constraints": [lambda m, e: jnp.where(e["x"] > 2.9, -jnp.inf, e["x"] - 1.5)]}
    with pytest.raises(ValueError, match=r"constraint 0 .* is -inf for the design given, 1 of its 1 numbers"):
        jk.optimize(lambda m, e: e["x"] ** 2, planar_fourbar(1.0), extras={"x": design.Free(2.95, 0.0, 3.0)}, **given)
    best = jk.optimize(
        lambda m, e: -(e["x"] ** 2), planar_fourbar(1.0), extras={"x": design.Free(1.0, 0.0, 3.0)}, **given
    )
    assert best.feasible and 2.5 < best.values["x"] <= 2.9


@pytest.mark.parametrize(
    ("returned", "said"),
    [
        (lambda m: jnp.min(m.coordinates["D"]) > 0.5, r"constraint 1 \(limit\) returns truth values, of which none is"),
        (lambda m: m.closed, r"constraint 1 \(limit\) returns truth values"),
        (lambda m: None, r"constraint 1 \(limit\) must return numbers that are not negative .*, got NoneType"),
        (lambda m: [m.coordinates["D"], 1.0], r"constraint 1 .* got list; return by how much it is met"),
    ],
)
def test_constraints_that_are_none(returned, said):
    """A truth value is 0 or 1, neither of which is negative: it would always count as met."""

    def limit(motion):
        return returned(motion)

    with pytest.raises(ValueError, match=said):
        jk.optimize(
            lambda motion: jnp.mean(motion.coordinates["D"] ** 2),
            planar_fourbar(1.0),
            drive={"A": FEW},
            lengths={("crank", "A", "B"): (20.0, 60.0)},
            constraints=[design.above("D", -1.0), limit],
        )


def test_a_second_argument_of_its_own_is_left_alone():
    """As in a list of constraints that is written in a loop over joints."""
    for wanted, function in (
        (True, lambda motion, extras: 0),
        (True, lambda motion, e: 0),
        (True, lambda motion, extras=(): 0),
        (True, lambda motion, found=None: 0),
        (True, lambda *given: 0),
        (True, lambda motion, *given: 0),
        (False, lambda motion: 0),
        (False, lambda motion, joint="D": 0),
        (False, lambda motion, least=FEW: 0),
        (False, lambda motion, *, least: 0),
        (False, lambda motion, extras, least: 0),
    ):
        assert takes_extras(function) == wanted


@pytest.mark.long
@pytest.mark.parametrize("solver", [SQUARES, LBFGS], ids=str)
def test_derivatives_that_are_no_numbers_are_told(solver):
    """The root of x^2 is a number at zero, where its derivative is none: nothing was searched, since it counted as
    zero. Beside it stands what is masked as the message says."""
    given = {"drive": {"A": FEW}, "solver": solver}

    def returned(residual):
        return jnp.atleast_1d(residual) if solver is SQUARES else residual**2

    def loss(motion, extras):
        return returned(jnp.sqrt(extras["x"] ** 2) - 1.0)

    def masked(motion, extras):
        known = extras["x"] != 0
        return returned(jnp.where(known, jnp.sqrt(jnp.where(known, extras["x"] ** 2, 1.0)), extras["x"]) - 1.0)

    place = {"x": design.Free(0.0, 0.0, 3.0)}
    with pytest.raises(ValueError, match="is a number, and its derivative by x is none for the design given"):
        jk.optimize(loss, planar_fourbar(1.0), extras=place, **given)
    best = jk.optimize(masked, planar_fourbar(1.0), extras=place, **given)
    assert best.values["x"] == pytest.approx(1.0, abs=1e-9) and "derivative" not in best.reason

    # the best is where the derivative is none
    def at_the_end(motion, extras):
        return returned(jnp.sqrt(extras["x"] ** 2) + 1.0)

    best = jk.optimize(at_the_end, planar_fourbar(1.0), extras={"x": design.Free(2.0, 0.0, 3.0)}, **given)
    assert best.values["x"] == 0 and "its derivative by x is none at the best design" in best.reason


def test_variables_of_one_name_are_told_apart():
    """A joint may be moved and driven, and an extra be called as it is."""
    mechanism = planar_fourbar(1.0)
    place = {"D": ((90.0, -10.0, 0.0), (110.0, 10.0, 0.0))}
    drive = {"D": design.Free(np.zeros(2), -1.0, 1.0), "A": FEW}
    extras = {"D": design.Free(0.5, 0.0, 1.0), "x": design.Free(0.5, 0.0, 1.0)}
    chosen = variables(mechanism, drive, {}, place, extras, {("ground", "D"): "D"})
    assert chosen.names == ["point D[0]", "point D[1]", "point D[2]", "drive D[0]", "drive D[1]", "extra D", "x"]
    assert _followers(chosen) == {"points": (("ground", "D"),), "inputs": (), "extras": ()}
    found = chosen.values(chosen.start)
    assert found.extras == {"D": 0.5, "x": 0.5} and set(found.points) == {"D", ("ground", "D")}
    with pytest.raises(
        ValueError, match=r"tie of 'B': 'D' names several variables .point, drive, extra.; write a drive"
    ):
        variables(mechanism, drive, {}, place, extras, {"B": "D"})


def _followers(chosen: Variables) -> dict[str, tuple]:
    entries: tuple[Entry, ...] = chosen.entries
    return {each.group: tuple(key for key, _ in each.ties) for each in entries if each.key == "D"}
