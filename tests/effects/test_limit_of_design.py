"""Limits as functions of lengths: closed forms and their derivatives, and differences of limits that are searched.

A limit is right to rounding, and its derivative to rounding over the second derivative of the drive, which is 1 or so.
"""

import warnings

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.catalogue import fivebar
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank

GROUND, CRANK, COUPLER, ROCKER = ("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")
DRAWN = {GROUND: 100.0, CRANK: 90.0, COUPLER: 60.0, ROCKER: 60.0}
THETA = 1.0
LOCKED = planar_fourbar(THETA, ground=100.0, crank=90.0, coupler=60.0, rocker=60.0)


def stretched(lengths):
    """Where the coupler and the rocker are in line: the law of cosines."""
    ground, crank, coupler, rocker = lengths
    return jnp.arccos((ground**2 + crank**2 - (coupler + rocker) ** 2) / (2 * ground * crank)) - THETA


def upper_of_fourbar():
    limit = jk.limits(LOCKED, "A").upper
    return lambda lengths: limit.of(LOCKED.with_lengths(dict(zip(DRAWN, lengths, strict=True))))


@pytest.mark.long
def test_where_a_fourbar_locks():
    """Value and gradient by all bars, from the drawn lengths to far from them, all compiled once; beyond Grashof's
    condition the crank turns fully, and there is no limit: NaN."""
    found, expected = (jax.jit(jax.value_and_grad(each)) for each in (upper_of_fourbar(), stretched))
    start = np.array([*DRAWN.values()])
    for change in ([0, 0, 0, 0], [0, 0, 1e-3, 0], [10, -10, 20, 5], [0, 0, 60, 0], [-5, 0, -40, 0], [50, 60, 10, 10]):
        (value, slope), (of_cosines, exact) = (each(start + change) for each in (found, expected))
        np.testing.assert_allclose(value, of_cosines, rtol=0, atol=1e-12)
        np.testing.assert_allclose(slope, exact, rtol=1e-8, atol=1e-11)
    assert np.isnan(found(start + [0, 0, 75.0, 0])[0])
    assert jk.limits(LOCKED.with_lengths({COUPLER: 135.0}), "A").upper.value == pytest.approx(
        2 * np.pi - float(jnp.arccos((100.0**2 + 90.0**2 - 75.0**2) / 18000.0)) - THETA, abs=1e-10
    )  # it goes on, to where they are folded


@pytest.mark.long
def test_second_derivatives():
    """Those of the extremum: where it is moves with the lengths."""
    start = jnp.array([*DRAWN.values()])
    found, expected = (jax.jit(jax.jacfwd(jax.grad(each)))(start) for each in (upper_of_fourbar(), stretched))
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-10)


@pytest.mark.long
def test_third_derivatives():
    """Those of the augmented system are right to any order: here by the coupler."""

    def of_coupler(function):
        return lambda coupler: function(jnp.array([100.0, 90.0, coupler, 60.0]))

    found, expected = (
        jax.jit(jax.jacfwd(jax.jacfwd(jax.jacfwd(of_coupler(each)))))(61.0) for each in (upper_of_fourbar(), stretched)
    )
    np.testing.assert_allclose(found, expected, rtol=1e-7)


@pytest.mark.long
def test_many_designs_at_once():
    """A design without the limit is NaN, with a gradient of zero, and leaves the others as they are."""
    couplers = jnp.array([60.0, 200.0, 75.0])
    designs = jnp.array([100.0, 90.0, 0.0, 60.0]) + couplers[:, None] * jnp.array([0.0, 0.0, 1.0, 0.0])
    values, slopes = jax.jit(jax.vmap(jax.value_and_grad(upper_of_fourbar())))(designs)
    expected, exact = jax.vmap(jax.value_and_grad(stretched))(designs[::2])
    np.testing.assert_allclose(values[::2], expected, rtol=0, atol=1e-12)
    np.testing.assert_allclose(slopes[::2], exact, rtol=1e-8)
    assert np.isnan(values[1]) and not np.any(slopes[1])


@pytest.mark.long
def test_single_precision():
    """Value and slope to what rounding leaves, a few parts in a million of a radian."""
    with jax.enable_x64(False), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that it is in float32
        function = jax.value_and_grad(upper_of_fourbar())
        for change in ([0, 0, 0, 0], [10, -10, 20, 5], [-5, 0, -40, 0]):
            lengths = np.array([*DRAWN.values()]) + change
            value, slope = function(jnp.asarray(lengths))
            assert value.dtype == slope.dtype == np.float32
            with jax.enable_x64(True):
                expected, exact = jax.value_and_grad(stretched)(jnp.asarray(lengths))
            np.testing.assert_allclose(value, expected, rtol=0, atol=4e-6)
            np.testing.assert_allclose(slope, exact, rtol=2e-5)


@pytest.mark.long
@pytest.mark.parametrize("offset", [0.0, 20.0])
def test_the_stroke_of_a_slider_crank(offset):
    """Twice the crank where the slide points at its pivot; by Pythagoras where it does not."""
    mechanism = slider_crank(1.0, crank=40.0, rod=120.0, offset=offset)
    found = jk.limits(mechanism, "S")
    keys = ("crank", "A", "B"), next(key for key in mechanism.lengths if len(key) == 3 and set(key[1:]) == {"B", "C"})

    def stroke(lengths):
        design = mechanism.with_lengths(dict(zip(keys, lengths, strict=True)))
        return found.upper.of(design) - found.lower.of(design)

    def expected(lengths):
        crank, rod = lengths
        return jnp.sqrt((rod + crank) ** 2 - offset**2) - jnp.sqrt((rod - crank) ** 2 - offset**2)

    both = [jax.jit(jax.value_and_grad(each)) for each in (stroke, expected)]
    for lengths in (jnp.array([40.0, 120.0]), jnp.array([25.0, 90.0])):
        (value, slope), (exact, by_hand) = (each(lengths) for each in both)
        np.testing.assert_allclose(value, exact, rtol=0, atol=1e-10)
        np.testing.assert_allclose(slope, by_hand, atol=1e-9)
        if not offset:
            np.testing.assert_allclose(slope, [2.0, 0.0], atol=1e-9)


def differences(limit_of, length):
    """Central differences of limits that are searched anew, which are right to 1e-12: the step leaves 1e-8 of that."""
    step = 1e-4 * length
    return (limit_of(length + step) - limit_of(length - step)) / (2 * step)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "drive", "key", "search"),
    [
        (planar_fourbar(THETA), "A", COUPLER, {"ranges": {"D": (-0.1, 0.3)}}),
        (rssr_linkage(0.3), "D", ("crank", "A", "B"), {}),
        (fivebar(), "A", ("b", "B", "C"), {"hold": ["E"]}),
    ],
    ids=["the range of the rocker ends", "a spatial linkage with a rod that spins", "one drive of two, the other held"],
)
def test_derivatives_are_differences_of_limits_that_are_searched(mechanism, drive, key, search):
    found, length = jk.limits(mechanism, drive, **search), float(mechanism.lengths[key])
    other = 1.02 * length
    for side in ("lower", "upper"):

        def of_design(length, side=side):
            return getattr(found, side).of(mechanism.with_lengths({key: length}))

        def searched(length, side=side):
            return getattr(jk.limits(mechanism.with_lengths({key: length}), drive, **search), side).value

        value, slope = jax.jit(jax.value_and_grad(of_design))(other)
        np.testing.assert_allclose(value, searched(other), rtol=0, atol=1e-10)
        np.testing.assert_allclose(slope, differences(searched, other), rtol=1e-6, atol=1e-9)


@pytest.mark.long
def test_a_limit_is_a_constraint_of_a_search():
    """The shortest coupler with which the crank goes on by 0.7 rad: by the cosines."""
    limit = jk.limits(LOCKED, "A").upper
    best = jk.optimize(
        lambda motion: (motion.mechanism.lengths[COUPLER] / 60.0) ** 2,
        LOCKED,
        drive={"A": [0.0]},
        lengths={COUPLER: (40.0, 100.0)},
        constraints=[lambda motion: limit.of(motion.mechanism) - 0.7],
    )
    wanted = np.sqrt(100.0**2 + 90.0**2 - 2 * 100.0 * 90.0 * np.cos(THETA + 0.7)) - 60.0
    assert best.mechanism.lengths[COUPLER] == pytest.approx(wanted, rel=1e-5)  # constraints are met to 1e-6
    # the search of the design finds the same limit
    assert jk.limits(best.mechanism, "A").upper.value == pytest.approx(0.7, abs=1e-5)


def test_limits_without_an_equation():
    turns = jk.limits(planar_fourbar(), "A")
    assert turns.full_turn and float(turns.upper.of(planar_fourbar())) == np.inf
    own = jk.limits(planar_fourbar(), "A", ranges={"A": (-0.5, 0.5)})
    assert float(own.lower.of(planar_fourbar().with_lengths({COUPLER: 125.0}))) == pytest.approx(-0.5, abs=1e-12)
    with pytest.raises(ValueError, match="known of a mechanism with other joints, couplings or limits of joints"):
        jk.limits(LOCKED, "A").upper.of(slider_crank())
    lost = jk.Limit(1.0, jk.LimitKind.LOST, (), "the motion was lost at a singular pose", {})
    with pytest.raises(
        ValueError, match="the limit where the motion was lost at a singular pose is the solution of no eq"
    ):
        lost.of(LOCKED)


@pytest.mark.long
def test_the_pose_of_a_mode_has_derivatives_by_lengths():
    """A mechanism that is assembled in the other mode is swept as any other: the rocker by its triangle, as a closed
    form of the diagonal, with the other sign."""
    mechanism = planar_fourbar(THETA)
    mode = jk.assembly_modes(mechanism, {"A": 0.0})[1].mechanism()

    def rocker(coupler):
        return mode.with_lengths({COUPLER: coupler}).sweep({"A": [0.0]}).coordinates["D"][0, 0]

    def by_cosines(coupler):
        pin = jnp.array([40.0 * np.cos(THETA) - 100.0, 40.0 * np.sin(THETA)])
        diagonal = jnp.linalg.norm(pin)
        return jnp.arccos((diagonal**2 + 80.0**2 - coupler**2) / (2 * diagonal * 80.0))

    slope, expected = jax.grad(rocker)(120.0), jax.grad(by_cosines)(120.0)
    np.testing.assert_allclose(abs(slope), abs(expected), rtol=1e-9)
    drawn = jax.grad(lambda x: mechanism.with_lengths({COUPLER: x}).sweep({"A": [0.0]}).coordinates["D"][0, 0])(120.0)
    np.testing.assert_allclose(slope, -drawn, rtol=1e-9)  # to the other side of the diagonal
