"""Derivatives of known poses by the twists of planar loops: those of the least-norm solution of the closure.

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
from jaxkin.solve.closed_form.known_poses_in_plane import known_displacements_in_plane
from jaxkin.solve.range.known_poses import known_displacements
from reference import catalogue
from reference.mechanisms import flat, planar_fourbar, rssr_linkage, slider_crank

Z, GROUND = (0, 0, 1), "ground"


def wedge_with_play():
    """A crank moves a block between two guides that are parallel: how its two slides share the way is idle."""
    pin, guide = (30.0, 40.0), flat((0.6, 0.8))
    return jk.Mechanism.build(
        fixed=[GROUND],
        joints=[
            jk.revolute("A", GROUND, "crank", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "crank", "rod", point=flat(pin), axis=Z),
            jk.revolute("C", "rod", "block", point=flat((90.0, 20.0)), axis=Z),
            jk.prismatic("inner", "block", "sleeve", axis=guide, point=flat((90.0, 20.0))),
            jk.prismatic("outer", GROUND, "sleeve", axis=guide, point=flat((90.0, 20.0))),
        ],
    )


CASES = {
    "four-bar": (planar_fourbar, ("A",), True),
    "slider-crank": (slider_crank, ("A",), True),
    "Scotch yoke": (catalogue.scotch_yoke, ("A",), True),
    "four-bar, with least norm": (planar_fourbar, ("A",), False),
    "Scotch yoke, with least norm": (catalogue.scotch_yoke, ("A",), False),
    "redundant bar": (lambda: catalogue.parallelogram(3), ("A",), False),
    "idle slides": (wedge_with_play, ("A",), False),
    "three loops together": (catalogue.andrews, ("O",), False),
    "triad": (catalogue.stephenson, ("G",), False),
    "two inputs": (catalogue.fivebar, ("A", "E"), False),
    "Peaucellier": (catalogue.peaucellier, ("Q",), False),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_they_are_those_of_the_least_norm_solution(name):
    """Once and once more; none of poses that are not closed."""
    make, drive, regular = CASES[name]
    mechanism = make()
    way = np.linspace(-0.02, 0.03, 7)
    motion = mechanism.sweep({each: (1 - 2 * number) * way for number, each in enumerate(drive)})
    (group,) = plan_drive(mechanism.linkage, drive).loop_groups
    known = jnp.stack([motion.displacements[joint][:, k] for joint, k in group.columns])
    assert np.all(motion.closed)
    status = jnp.asarray(motion.status).at[3].set(jk.Status.UNREACHABLE.value)
    names = list(motion.inputs)
    inputs = jnp.stack([jnp.asarray(motion.inputs[names[each]]) for each in group.inputs])
    rates = jnp.asarray(np.random.default_rng(0).normal(size=inputs.shape))

    def twice(place):
        def once(inputs):
            return jax.jvp(place, (inputs,), (rates,))[1]

        return jax.jit(lambda inputs: jax.jvp(once, (inputs,), (rates,)))(inputs)

    axes = group.planar_axes
    found = twice(lambda u: known_displacements_in_plane(group.system, axes, u, known, status, regular=regular))
    expected = twice(lambda u: known_displacements(group.system, group.joints, u, known, status))
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * max(1.0, np.abs(np.asarray(other)).max()))
        assert np.all(one[:, 3] == 0) and np.any(one[:, 2] != 0)


@pytest.mark.long
def test_formulas_differentiate_only_ranges_that_no_singular_pose_may_lie_in():
    """The crank of a crank-rocker passes its turn without doubt; its rocker has limits, a parallelogram change points,
    in which its four hinges are in line."""

    def regular(motion):
        return [group.regular for group in known_motion(motion)[0].loop_groups]

    turn, fourbar = np.linspace(0.0, 6.0, 7), planar_fourbar()
    assert regular(fourbar.sweep({"A": turn})) == [True]
    assert regular(fourbar.sweep({"D": 0.3 * turn})) == [False]
    in_space = rssr_linkage().sweep({"A": 0.1 * turn})
    assert regular(in_space) == [False]  # one program, in any range
    assert not any(isinstance(numbers, AssembledAxes) for numbers in known_motion(in_space)[1].numbers)
    parallel = planar_fourbar(1.0, ground=100.0, crank=40.0, coupler=100.0, rocker=40.0)
    motion = parallel.sweep({"A": np.linspace(-1.0, 2.0 * np.pi - 1.0, 361)})
    assert regular(motion) == [False]
    rates = np.asarray(jk.velocities(motion, {"A": 1.0}).coordinates["D"])[np.asarray(motion.closed)]
    assert len(rates) == 361 and np.all(np.isfinite(rates))
    # opposite sides stay parallel; in the three flat poses the equations allow other rates, too
    assert np.sum(np.abs(rates - 1.0) > 1e-9) <= 3


@pytest.mark.long
def test_an_assembled_pose_in_line_has_the_rates_of_least_norm():
    """A parallelogram whose four hinges are in line has two ways to move, of which neither is preferred.

    With the crank A at a rate of one and the coupler at w, the end of the coupler rises by 40 + 100 w, that of the
    rocker D by 40 d: the rates of B, C and D are w - 1, d - w and d up to signs, with d = 1 + 2.5 w. The sum of their
    squares is least where (w - 1) + 1.5 (1 + 1.5 w) + 2.5 (1 + 2.5 w) = 0.
    """
    mechanism = planar_fourbar(0.0, ground=100.0, crank=40.0, coupler=100.0, rocker=40.0)
    motion = mechanism.sweep({"A": np.zeros(1)})
    assert motion.closed[0]
    rates = {name: float(rate[0, 0]) for name, rate in jk.velocities(motion, {"A": 1.0}).coordinates.items()}
    w = -3.0 / 9.5
    d = 1 + 2.5 * w
    expected = {"A": 1.0, "B": w - 1, "C": d - w, "D": d}
    assert {name: abs(rate) for name, rate in rates.items()} == pytest.approx(
        {name: abs(rate) for name, rate in expected.items()}, abs=1e-12
    )


@pytest.mark.long
def test_rates_are_differentiated_backwards_as_forwards():
    """With J the derivative of the rates by the inputs, c . (J t) = (J^T c) . t for any t and c, to some roundings."""
    mechanism = catalogue.peaucellier()
    way, random = np.linspace(-0.02, 0.03, 5), np.random.default_rng(4)
    (group,) = plan_drive(mechanism.linkage, ("Q",)).loop_groups
    motion = mechanism.sweep({"Q": way})
    known = jnp.stack([motion.displacements[joint][:, k] for joint, k in group.columns])
    inputs, axes = jnp.asarray(way)[None], group.planar_axes
    assert axes is not None

    def rates(inputs):
        def place(u):
            return known_displacements_in_plane(group.system, axes, u, known, motion.status, regular=False)

        return jax.jvp(place, (inputs,), (jnp.ones_like(inputs),))[1]

    along, across = random.normal(size=inputs.shape), random.normal(size=known.shape)
    forwards = jax.jit(lambda u: jax.jvp(rates, (u,), (along,))[1])(inputs)
    (backwards,) = jax.jit(lambda u: jax.vjp(rates, u)[1](across))(inputs)
    assert float(np.sum(across * forwards)) == pytest.approx(float(np.sum(backwards * along)), rel=1e-12)
    assert np.abs(forwards).max() > 1e-3
