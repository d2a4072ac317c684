"""Optima on the bounds of constraints, where the conditions of Karush, Kuhn and Tucker are solved by hand."""

import jax.numpy as jnp
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin import design
from jaxkin.design.augmented_lagrangian import MET, Penalty, Verdict, renewed, worth_more
from jaxkin.design.lbfgs import bounded
from jaxkin.design.least_squares import least_squares
from jaxkin.design.measures import lengths_now
from jaxkin.design.problem import design_problem
from jaxkin.design.variables import variables
from jaxkin.solve.options import SolverOptions
from reference.drawn_parts import box, loaded
from reference.mechanisms import Z, planar_fourbar, slider_crank

FEW = np.linspace(0.0, 0.2, 3)
TURN = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)


def test_multipliers_of_a_parabola():
    """Least x^2 / 2 for x >= 1 has the multiplier 1: the search between two updates is known in closed form.

    x^2 / 2 + w max(s - (x - 1), 0)^2 is least where x = 2 w (s + 1 - x): x = 2 w (s + 1) / (1 + 2 w).
    """
    penalty, unsettled = Penalty.plain(0.05, 1, 1), np.array([np.inf])
    for count in range(30):  # noqa: B007
        x = 2 * penalty.weight * (penalty.shifts[:, 0] + 1) / (1 + 2 * penalty.weight)
        charged = np.maximum(penalty.shifts - (x[:, None] - 1), 0.0)
        verdict = Verdict(x**2 / 2, np.zeros((1, 1)), charged, penalty.shifts)
        # the augmented Lagrangian is a lower bound, as the problem is convex
        assert verdict.least(penalty.weight) <= 0.5 + 1e-12
        if not worth_more(penalty, verdict):
            break
        penalty, unsettled = renewed(penalty, verdict, unsettled), verdict.unsettled
    assert count < 12 and verdict.violations <= MET
    assert x == pytest.approx(1.0, abs=MET)
    assert 2 * penalty.weight * charged[0, 0] == pytest.approx(1.0, abs=1e-4)  # MET times twice the weight


def test_a_design_inside_is_settled_only_without_multipliers():
    """A constraint that is met with a margin of 0.5 keeps the search going as long as it is charged for."""
    gaps = np.zeros((1, 1))
    for shift, goes_on in ((0.0, False), (0.3, True)):
        shifts = np.full((1, 1), shift)
        verdict = Verdict(np.ones(1), gaps, np.maximum(shifts - 0.5, 0.0), shifts)
        assert verdict.violations == 0.0
        assert worth_more(Penalty(np.ones(1), shifts), verdict) == goes_on


@pytest.mark.long
@pytest.mark.parametrize(
    "solver",
    [
        pytest.param(design.LevenbergMarquardt(), id="squares"),
        pytest.param(design.LBFGS(), id="any loss", marks=pytest.mark.study),
    ],
)
def test_nearest_point_of_a_disc(solver):
    """From (2, 1) to the unit disc: (2, 1) / sqrt 5, on its edge, with a constraint beside that is not touched."""

    def residuals(motion, extras):
        return jnp.stack([extras["x"] - 2.0, extras["y"] - 1.0])

    def loss(motion, extras):
        return jnp.sum(residuals(motion, extras) ** 2)

    def within(motion, extras):
        return jnp.stack([1.0 - extras["x"] ** 2 - extras["y"] ** 2, 2.0 - extras["x"]])

    best = jk.optimize(
        residuals if isinstance(solver, design.LevenbergMarquardt) else loss,
        planar_fourbar(1.0),
        drive={"A": FEW},
        extras={"x": design.Free(-1.5, -3.0, 3.0), "y": design.Free(1.5, -3.0, 3.0)},
        constraints=[within],
        solver=solver,
    )
    assert best.feasible and "searches for what constraints touch" in best.reason
    # where it breaks the edge by 1e-6 at most, it is half as far from it
    np.testing.assert_allclose([best.values["x"], best.values["y"]], np.array([2.0, 1.0]) / np.sqrt(5), atol=2 * MET)
    assert best.value == pytest.approx((np.sqrt(5) - 1) ** 2, abs=4 * MET)


@pytest.mark.long
@pytest.mark.parametrize("unit", [1e-6, 1e10])
def test_losses_may_be_in_any_unit(unit):
    """Least (x - 2)^2 + (x - 1)^2 / 4 is at 1.8."""

    def residuals(motion, extras):
        return unit * jnp.stack([extras["x"] - 2.0, 0.5 * (extras["x"] - 1.0)])

    given = {"drive": {"A": FEW}, "extras": {"x": design.Free(2.9, 0.0, 3.0)}}
    best = jk.optimize(residuals, planar_fourbar(1.0), solver=design.LevenbergMarquardt(), **given)
    assert best.values["x"] == pytest.approx(1.8, abs=1e-6)
    assert best.value == pytest.approx(0.2 * unit**2, rel=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("squares", [True, False])
def test_a_constraint_that_is_no_number_is_not_met(squares):
    """As a torque where friction locks: least x that is not below 1, with a constraint that is NaN there."""
    calls = {"drive": {"A": FEW}, "solver": design.LevenbergMarquardt() if squares else design.LBFGS()}
    calls["constraints"] = [lambda motion, extras: jnp.where(extras["x"] < 1.0, jnp.nan, extras["x"] - 1.2)]

    def loss(motion, extras):
        return jnp.atleast_1d(extras["x"]) if squares else extras["x"] ** 2

    chosen = variables(planar_fourbar(1.0), {"A": FEW}, {}, {}, {"x": design.Free(2.5, 0.0, 3.0)}, {})
    problem = design_problem(loss, squares, planar_fourbar(1.0), chosen, calls["constraints"], SolverOptions())
    solver = (least_squares if squares else bounded)(problem, 1)
    shifts = np.zeros((1, 1))
    for _ in range(3):  # whatever the searches before have charged for it
        verdict = solver.judge(np.array([[0.5]]), shifts)
        assert verdict.violations > 1e5
        shifts = verdict.charged

    best = jk.optimize(loss, planar_fourbar(1.0), extras={"x": design.Free(2.5, 0.0, 3.0)}, **calls)
    assert best.feasible
    assert best.values["x"] == pytest.approx(1.2, abs=10 * MET)
    with pytest.raises(ValueError, match=r"constraint 0 .* is NaN for the design given, 1 of its 1 numbers"):
        jk.optimize(loss, planar_fourbar(1.0), extras={"x": design.Free(0.5, 0.0, 3.0)}, **calls)


@pytest.mark.long
@pytest.mark.parametrize("as_solid", [True, False])
def test_the_longest_crank_whose_rod_clears_a_post_by_two_millimetres(tmp_path, as_solid):
    """The clearance of the rod from a post, as a bar or a solid, is 2 at the best crank: `jk.clashes` finds it so."""
    post, round_of, half, wanted = np.array([75.0, 35.0]), 10.0, 3.0, 2.0
    column = trimesh.creation.cylinder(round_of, 12.0, sections=720)
    column.apply_translation([*post, 0.0])
    crank = ("crank", "A", "B")

    def longest(motion):
        return jnp.atleast_1d(lengths_now(motion.mechanism, [crank])[0] - 60.0) / 60.0

    shape = design.solid("ground", column) if as_solid else design.bar("ground", (*post, -6), (*post, 6), round_of)
    best = jk.optimize(
        longest,
        slider_crank(0.0, crank=30.0, rod=120.0, offset=0.0),
        drive={"A": TURN},
        lengths={crank: (20.0, 60.0)},
        constraints=[design.apart(design.bar("rod", "B", "C", half), shape, least=wanted)],
        solver=design.LevenbergMarquardt(),
    )
    assert best.feasible and best.moves.everywhere
    found = float(best.mechanism.lengths[crank])
    assert 30.0 < found < 59.0
    solids = {
        "ground": column,
        "rod": box([found, -half, -2], [found + 120.0, half, 2]),
        "crank": box([-2, -2, -12], [found, 2, -10]),
        "slider": box([found + 118.0, -2, 10], [found + 122.0, 2, 12]),
    }
    joints = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "crank", "rod", point=(found, 0, 0), axis=Z),
        jk.revolute("C", "rod", "slider", point=(found + 120.0, 0, 0), axis=Z),
        jk.prismatic("S", "ground", "slider", axis=(1, 0, 0)),
    ]
    drawn = loaded(tmp_path, solids).mechanism(fixed=["ground"], joints=joints)
    clearance = jk.clashes(drawn.sweep({"A": TURN}), within=5.0)
    (pair,) = [k for k, each in enumerate(clearance.pairs) if {*each} == {"ground", "rod"}]
    # 1e-4 is what the search may break of a size of 100; chords of the column are 1e-4 inside it
    assert np.min(clearance.clearances[pair]) == pytest.approx(wanted, abs=3e-4)
