"""Tolerances, held to derivatives by hand of closed forms, to sums of independent deviations, and to full designs."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar
from reference import planar
from reference.mechanisms import bennett_linkage, rssr_linkage, spherical_linkage
from reference.spatial import rssr, spherical_fourbar

GROUND, CRANK, COUPLER, ROCKER = (
    ("ground", "A", "D"),
    ("crank", "A", "B"),
    ("coupler", "B", "C"),
    ("rocker", "C", "D"),
)
BARS = (GROUND, CRANK, COUPLER, ROCKER)
LENGTHS = (100.0, 40.0, 120.0, 80.0)
"""Norton's example 4-1."""
INPUT = 0.7
Z = (0.0, 0.0, 1.0)


def rocker(pose):
    return pose.coordinates["D"][0]


def rocker_by_freudenstein(theta):
    """Angle of the rocker, and its derivatives by ground d, crank a, coupler b and rocker c, from the loop equation.

    With the unit vectors of the bars, a A + b B = d X + c C; multiplied by B, the unknown turn of the coupler drops
    out: b = (d X + c C - a A) . B, and its differential is db = X.B dd + C.B dc - A.B da + c C'.B dpsi.
    """
    d, a, b, c = LENGTHS
    found = planar.fourbar(np.array([theta]), d, a, b, c)
    unit = [np.array([np.cos(t), np.sin(t)]) for t in (0.0, theta, found.coupler[0], found.rocker[0])]
    ground, crank, coupler, out = unit
    turn = c * np.array([-out[1], out[0]]) @ coupler
    return found.rocker[0], np.array([-(ground @ coupler), crank @ coupler, 1.0, -(out @ coupler)]) / turn


@pytest.fixture(scope="module")
def found():
    """The four-bar with all its lengths even within 0.05, but for a rocker with a normal distribution."""
    stated = dict.fromkeys(BARS, 0.05) | {ROCKER: jk.sigma(0.02)}
    return jk.tolerances(
        fourbar(*LENGTHS),
        stated,
        rocker,
        drive={"A": INPUT},
        clearances={"C": 0.03},
        samples=4000,
        wanted=(-0.1, -0.093),
    )


@pytest.mark.long
def test_sensitivities_of_a_fourbar_are_those_of_freudenstein(found):
    angle, slopes = rocker_by_freudenstein(INPUT)
    start = planar.fourbar(np.array([0.0]), *LENGTHS).rocker[0]
    np.testing.assert_allclose(found.nominal, angle - start, atol=1e-12)
    np.testing.assert_allclose(found.sensitivities[:4], slopes, rtol=1e-10)
    # a pin that lies beside its hole makes the coupler longer or shorter, and the rest of it turns the coupler only
    np.testing.assert_allclose(found.sensitivities[4], abs(slopes[2]), rtol=1e-10)
    limits = np.array([0.05, 0.05, 0.05, 0.06, 0.03])
    by_hand = np.abs(np.append(slopes, slopes[2])) * limits
    np.testing.assert_allclose(found.worst_case, by_hand.sum(), rtol=1e-10)
    np.testing.assert_allclose(found.root_sum_of_squares, np.sqrt((by_hand**2).sum()), rtol=1e-10)
    assert found.contributions.sum() == pytest.approx(100.0)


@pytest.mark.long
def test_the_extremes_are_full_designs(found):
    """The corners, computed by the closed form; the pin in its hole, on the line of the coupler, is part of that."""
    _, slopes = rocker_by_freudenstein(INPUT)
    start = planar.fourbar(np.array([0.0]), *LENGTHS).rocker[0]
    for sign, value in zip((-1, 1), found.extremes, strict=True):
        lengths = np.array(LENGTHS) + sign * np.sign(slopes) * [0.05, 0.05, 0.05 + 0.03, 0.06]
        by_hand = planar.fourbar(np.array([INPUT]), *lengths).rocker[0] - start
        # across the coupler the pin is off by the turn of the coupler, 1e-3, times the clearance
        np.testing.assert_allclose(value, by_hand, atol=2e-6)
    assert found.extremes[0] < found.samples.min() and found.samples.max() < found.extremes[1]


@pytest.mark.long
def test_samples_spread_as_the_first_order_says(found):
    """The measure is nearly linear within the tolerances: deviations within 4 standard errors of 4000 samples."""
    assert found.not_closed == 0
    spread = found.samples.std()
    np.testing.assert_allclose(spread, found.standard_deviation, rtol=4 / np.sqrt(2 * 4000))
    assert abs(found.samples.mean() - found.nominal) < 4 * spread / np.sqrt(4000)
    assert found.within == np.mean((found.samples >= -0.1) & (found.samples <= -0.093))
    assert 0.4 < found.within < 0.9


@pytest.mark.long
def test_a_result_prints_draws_and_saves(found, tmp_path):
    text = str(found)
    for word in ("worst case", "coupler B C", "clearance", "yield", "sigma 0.02", "± 0.05"):
        assert word in text
    assert found.plot(tmp_path / "found.png").stat().st_size > 10_000
    lines = found.save(tmp_path / "found.csv").read_text().splitlines()
    name, nominal, limit, *_ = lines[3].split(",")
    assert len(lines) == 6 and name == '"coupler B C"' and float(nominal) == pytest.approx(120) and limit == "0.05"


@pytest.mark.long
def test_the_tolerances_of_a_wanted_error(found):
    worst, squares = found.allowed(0.01), found.allowed(0.01, "root sum of squares")
    slopes = np.abs(found.sensitivities)
    for tolerances in (worst.scaled, worst.equal):
        assert sum(slopes * list(tolerances.values())) == pytest.approx(0.01)
    for tolerances in (squares.scaled, squares.equal):
        assert np.linalg.norm(slopes * list(tolerances.values())) == pytest.approx(0.01)
    np.testing.assert_allclose(slopes * list(worst.equal.values()), 0.002)
    assert worst.scaled[CRANK] == pytest.approx(0.05 * worst.scale)
    assert "equal shares" in str(squares)
    with pytest.raises(ValueError, match="did you mean 'worst case'"):
        found.allowed(0.01, "worst")
    for wrong in (-1, "0.01"):
        with pytest.raises(ValueError, match=f"must be a positive number, got {wrong!r}"):
            found.allowed(wrong)


@pytest.mark.long
def test_monte_carlo_of_a_sum_is_that_of_its_terms():
    """A chain of two slides, the measure a sum of two offsets: even and normal deviations add as textbooks have it."""
    arm = jk.Mechanism.build(
        fixed=["g"],
        joints=[
            jk.revolute("A", "g", "a", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "a", "b", point=(3, 0, 0), axis=Z),
            jk.revolute("C", "b", "c", point=(5, 0, 0), axis=Z),
        ],
    )

    def reach(mechanism):
        return mechanism.lengths["a", "A", "B"] + 2.0 * mechanism.lengths["b", "B", "C"]

    found = jk.tolerances(
        arm, {("a", "A", "B"): 0.3, ("b", "B", "C"): jk.sigma(0.1)}, reach, samples=40_000, wanted=(7 - 0.2, 7 + 0.2)
    )
    variance = 0.3**2 / 3 + 4 * 0.1**2
    assert found.nominal == pytest.approx(7.0) and found.worst_case == pytest.approx(0.3 + 2 * 0.3)
    np.testing.assert_allclose(found.standard_deviation, np.sqrt(variance), rtol=1e-12)
    np.testing.assert_allclose(found.contributions, [100 * 0.03 / variance, 100 * 0.04 / variance], rtol=1e-12)
    # the density of the sum: the bell of deviation 0.2, averaged over 0.6; 4 standard errors of the share
    shift = np.linspace(-0.3, 0.3, 6001)
    bell = np.vectorize(lambda x: 0.5 * jax.scipy.special.erf(x / (0.2 * np.sqrt(2))))
    exact = np.mean(np.asarray(bell(0.2 - shift) - bell(-0.2 - shift)))
    np.testing.assert_allclose(found.within, exact, atol=4 * np.sqrt(exact * (1 - exact) / 40_000))


@pytest.mark.long
def test_slider_crank_and_its_units():
    """x = a cos + sqrt(b^2 - (e - a sin)^2) by hand; in metres all is the same, with the tolerances."""
    theta, (a, b, e) = 1.1, (40.0, 120.0, -20.0)

    def slider_crank(scale):
        def place(x, y):
            return (scale * x, scale * y, 0.0)

        crank, stop = (a, 0.0), (a + np.sqrt(b**2 - e**2), e)
        return jk.Mechanism.build(
            fixed=["ground"],
            joints=[
                jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
                jk.revolute("B", "crank", "rod", point=place(*crank), axis=Z),
                jk.revolute("C", "rod", "slider", point=place(*stop), axis=Z),
                jk.prismatic("S", "ground", "slider", axis=(1, 0, 0), point=place(*stop)),
            ],
        )

    def results(scale):
        return jk.tolerances(
            slider_crank(scale),
            {("crank", "A", "B"): 0.05 * scale, ("rod", "B", "C"): 0.1 * scale},
            lambda pose: pose.coordinates["S"][0],
            drive={"A": theta},
            clearances={"A": 0.02 * scale, "C": jk.sigma(0.01 * scale)},
            samples=100,
        )

    large, small = results(1.0), results(1e-3)
    rise = e - a * np.sin(theta)
    run = np.sqrt(b**2 - rise**2)
    by_crank = np.cos(theta) + rise * np.sin(theta) / run
    by_pin = np.hypot(1.0, rise / run)  # along the line, and across it by the slope of the rod
    np.testing.assert_allclose(large.sensitivities, [by_crank, b / run, by_pin, by_pin], rtol=1e-10)
    np.testing.assert_allclose(small.sensitivities, large.sensitivities, rtol=1e-9)
    np.testing.assert_allclose(small.contributions, large.contributions, rtol=1e-9)
    np.testing.assert_allclose(1e3 * small.samples, large.samples, rtol=1e-9)


@pytest.mark.long
def test_a_measure_of_a_motion_and_of_a_mechanism_agree():
    mechanism, angles = fourbar(*LENGTHS), np.linspace(0.0, 1.5, 4)

    def swing(motion):
        return jnp.ptp(motion.coordinates["D"][:, 0])

    stated = {COUPLER: 0.05, ROCKER: 0.1}
    one = jk.tolerances(mechanism, stated, swing, drive={"A": angles}, samples=5)
    two = jk.tolerances(mechanism, stated, lambda each: swing(each.sweep({"A": angles})), samples=5)
    np.testing.assert_allclose(one.sensitivities, two.sensitivities, rtol=1e-9)
    np.testing.assert_allclose(one.samples, two.samples, rtol=1e-9)


@pytest.mark.long
def test_a_spherical_fourbar_by_its_arcs():
    """Its lengths are angles: against differences of the closed form, exact to the square of the step."""
    arcs, start, turn, step = np.array([1.2, 0.5, 1.1, 0.9]), 0.4, 0.6, 1e-4
    mechanism = spherical_linkage(start, *arcs)
    keys = [key for key in mechanism.lengths if key[-1] == "angle"]
    order = [[*arcs].index(pytest.approx(mechanism.lengths[key])) for key in keys]
    assert sorted(order) == [0, 1, 2, 3]
    found = jk.tolerances(mechanism, dict.fromkeys(keys, 1e-3), rocker, drive={"A": turn}, samples=0)

    def output(lengths):
        return spherical_fourbar(np.array([start + turn]), *lengths).output[0]

    by_hand = [(output(arcs + step * row) - output(arcs - step * row)) / (2 * step) for row in np.eye(4)]
    np.testing.assert_allclose(np.abs(found.sensitivities), np.abs(by_hand)[order], rtol=1e-6)


@pytest.mark.long
def test_balls_that_lie_beside_their_sockets():
    """RSSR: a ball that is off along the rod makes the rod longer; across it, it turns the rod only."""

    def output(rod):
        return rssr(np.array([0.3 + 0.5]), rod=rod).output[0]

    found = jk.tolerances(
        rssr_linkage(0.3),
        {("rod", "B", "C"): 0.1},
        rocker,
        drive={"A": 0.5},
        clearances={"B": 0.03, "C": jk.sigma(0.02)},
        samples=4000,
    )
    by_hand = (output(140.0 + 1e-3) - output(140.0 - 1e-3)) / 2e-3
    np.testing.assert_allclose(found.sensitivities, [by_hand, abs(by_hand), abs(by_hand)], rtol=1e-6)
    # a place evenly in a ball has a fifth of the squared radius along each axis
    variance = by_hand**2 * (0.1**2 / 3 + 0.03**2 / 5 + 0.02**2)
    np.testing.assert_allclose(found.standard_deviation, np.sqrt(variance), rtol=1e-6)
    np.testing.assert_allclose(found.samples.std(), np.sqrt(variance), rtol=4 / np.sqrt(2 * 4000))


@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "stated"), [(bennett_linkage(), ("first", "A", "B")), (spherical_linkage(), None)]
)
def test_overconstrained_mechanisms_have_no_room(mechanism, stated):
    """Lengths of a Bennett linkage hang together, and the axes of a spherical one meet."""
    with pytest.raises(ValueError, match=r"do not close, .* an overconstrained mechanism has no room"):
        more = {} if stated else {"clearances": {"B": 0.01}}
        jk.tolerances(mechanism, {stated: 0.01} if stated else {}, rocker, drive={"A": 0.2}, samples=0, **more)


@pytest.mark.long
def test_designs_that_do_not_close_are_counted():
    """Just before a limit of the crank a longer coupler reaches, and a shorter one does not."""
    lengths = (100.0, 60.0, 80.0, 60.0)
    start = planar.fourbar(np.array([0.0]), *lengths).rocker[0]
    # coupler and rocker in line, less a milliradian
    theta = np.arccos((60.0**2 + 100.0**2 - 140.0**2) / (2 * 60.0 * 100.0)) - 1e-3
    stated = dict.fromkeys(BARS, 1e-12) | {COUPLER: 1.0}
    found = jk.tolerances(
        fourbar(*lengths), stated, rocker, drive={"A": theta}, clearances={"C": 1e-12}, samples=1000, seed=2
    )
    random = np.random.default_rng(2)
    couplers = np.concatenate([random.uniform(-1, 1, (1000, 1)) for _ in BARS], axis=1)[:, BARS.index(COUPLER)] + 80.0
    exact = np.array([planar.fourbar(np.array([theta]), 100.0, 60.0, each, 60.0).rocker[0] for each in couplers])
    np.testing.assert_array_equal(np.isnan(found.samples), np.isnan(exact))
    np.testing.assert_allclose(found.samples, exact - start, atol=1e-8)  # the root of 1e-12, near the limit
    assert 0 < found.not_closed < 1000 and "do not close" in str(found)
    assert np.isnan(found.extremes).any() and "not closed" in str(found)
