"""Cusps and crossings of coupler curves: the pole of the coupler, and closed forms that SciPy solves.

Tolerance: 1e-10 of the drive, rounding of the poses over the slope of the curve.
"""

import jax
import numpy as np
import pytest
from scipy.optimize import fsolve

import jaxkin as jk
from reference.mechanisms import planar_fourbar
from reference.planar import fourbar

START = 1.0
TURN = np.linspace(0.0, 2 * np.pi, 181)


def coupler_point(theta, along, across):
    """The point of the coupler by the closed form: in the frame of its pins."""
    at = fourbar(np.atleast_1d(theta))
    x, y = np.array([np.cos(at.coupler), np.sin(at.coupler)]), np.array([-np.sin(at.coupler), np.cos(at.coupler)])
    return at.crank_pin + along * x.T + across * y.T


@pytest.fixture(scope="module")
def motion():
    return planar_fourbar(START).sweep({"A": TURN})


@pytest.mark.long
def test_a_point_at_the_pole_of_the_coupler_has_a_cusp(motion):
    """Crank and rocker, prolonged, meet in the pole: the point of the coupler there stands still."""
    theta = START + 1.2345
    at = fourbar(np.array([theta]))
    crank, rocker = at.crank_pin[0], at.rocker_pin[0] - [100.0, 0.0]
    s, _ = np.linalg.solve(np.stack([crank, -rocker], axis=1), [100.0, 0.0])
    pole = s * crank - at.crank_pin[0]
    turned = float(at.coupler[0])
    along, across = pole @ [np.cos(turned), np.sin(turned)], pole @ [-np.sin(turned), np.cos(turned)]
    point = (*coupler_point(START, along, across)[0], 7.0)
    found = jk.coupler_curve(motion, "coupler", point)
    (cusp,) = found.cusps
    assert abs(cusp.input - 1.2345) < 1e-10
    np.testing.assert_allclose(cusp.point, (*(s * crank), 7.0), atol=1e-9)
    near = jk.coupler_curve(motion, "coupler", np.add(point, (0.01, 0.0, 0.0)))
    assert near.cusps == ()


@pytest.mark.long
def test_crossings_are_those_of_the_closed_form(motion):
    found = jk.coupler_curve(motion, "coupler", (*coupler_point(START, 50.0, -60.0)[0], 0.0))
    dense = np.linspace(0.0, 2 * np.pi, 2001)
    curve = coupler_point(START + dense, 50.0, -60.0)
    np.testing.assert_allclose(found.points[:, :2], coupler_point(START + TURN, 50.0, -60.0), atol=1e-9)
    # brute force: pairs of far inputs at nearly one place, refined on the closed form
    apart = np.linalg.norm(curve[:, None] - curve[None], axis=2) + 1e3 * (np.abs(dense[:, None] - dense) < 0.3)
    apart += 1e3 * (np.abs(dense[:, None] - dense) > 2 * np.pi - 0.3)
    expected: list[np.ndarray] = []
    for i, j in zip(*np.nonzero((apart < 1.0) & (dense[:, None] < dense)), strict=True):
        both, _, fine, _ = fsolve(
            lambda u: (np.diff(coupler_point(START + u, 50.0, -60.0), axis=0))[0],
            (dense[i], dense[j]),
            xtol=1e-14,
            full_output=True,
        )
        if abs(both[0] - both[1]) > 0.1 and fine in (1, 4, 5):
            expected.append(np.sort(both))
    expected = [own for k, own in enumerate(expected) if not any(np.allclose(own, other) for other in expected[:k])]
    assert expected
    # both are refined until rounding of the points, 1e-14, is left, over tangents of some 50 a radian
    np.testing.assert_allclose(sorted(each.inputs for each in found.crossings), sorted(map(list, expected)), atol=1e-10)
    for each in found.crossings:
        both = coupler_point(START + np.array(each.inputs), 50.0, -60.0)
        np.testing.assert_allclose(both[0], both[1], atol=1e-9)
        np.testing.assert_allclose(each.point[:2], both[0], atol=1e-9)


@pytest.mark.long
def test_a_circle_has_neither(motion):
    """The pin of the crank, once around: that the ends meet is no crossing."""
    found = jk.coupler_curve(motion, "crank", (40 * np.cos(START), 40 * np.sin(START), 0.0))
    assert found.cusps == found.crossings == ()
    assert "no cusp, no crossing" in str(found)


@pytest.mark.long
def test_a_curve_that_is_drawn_twice_has_what_one_turn_has(motion):
    """Also at its cusp, beside which the steps of both turns cut each other."""
    point = (*coupler_point(START, 50.0, -60.0)[0], 0.0)
    twice = motion.mechanism.sweep({"A": np.linspace(0.0, 4 * np.pi, 361)})
    once, again = (jk.coupler_curve(each, "coupler", point) for each in (motion, twice))
    assert len(once.crossings) == len(again.crossings) > 0
    for one, other in zip(once.crossings, again.crossings, strict=True):
        np.testing.assert_allclose(one.inputs, other.inputs, atol=1e-9)
    pole = np.asarray(jk.screw_axes(jk.velocities(motion, {"A": 1.0}), "coupler").moving)[40]
    once, again = (jk.coupler_curve(each, "coupler", pole) for each in (motion, twice))
    assert len(again.cusps) == len(once.cusps) == 1 and len(again.crossings) == len(once.crossings)


@pytest.mark.long
def test_it_prints_draws_and_saves(motion, tmp_path):
    found = jk.coupler_curve(motion, "coupler", (*coupler_point(START, 50.0, -60.0)[0], 0.0))
    assert str(found).startswith("Curve of a point of coupler over A.phi, 181 poses, plane")
    assert str(found).count("crossing at") == len(found.crossings) > 0
    assert found.plot(tmp_path / "curve.png").stat().st_size > 10_000
    table = np.genfromtxt(found.save(tmp_path / "curve.csv"), delimiter=",", names=True)
    np.testing.assert_allclose(table["x"], found.points[:, 0], rtol=1e-8)


def test_what_makes_no_sense_is_refused(motion):
    with pytest.raises(ValueError, match="no part 'copler'; did you mean 'coupler'"):
        jk.coupler_curve(motion, "copler", (0, 0, 0))
    with pytest.raises(ValueError, match="three numbers"):
        jk.coupler_curve(motion, "coupler", (0, 0))
    with pytest.raises(ValueError, match="of a motion"):
        jk.coupler_curve(motion.mechanism, "coupler", (0, 0, 0))
    with pytest.raises(ValueError, match="four closed poses"):
        jk.coupler_curve(motion.mechanism.sweep({"A": TURN[:3]}), "coupler", (0, 0, 0))
    with pytest.raises(ValueError, match="on the host"):
        jax.jit(lambda point: jk.coupler_curve(motion, "coupler", point).points)(np.zeros(3))
