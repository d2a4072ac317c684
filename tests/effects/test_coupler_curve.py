"""Cusps and crossings of coupler curves: the pole of the coupler, and closed forms that SciPy solves.

Tolerance: 1e-10 of the drive, rounding of the poses over the slope of the curve.
"""

from dataclasses import replace

import jax
import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.effects.curve_range import CurvePoints, range_of
from jaxkin.effects.cusps_crossings import crossings_of, cusps_of
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


def at_the_pole(turned):
    """The point of the coupler, as assembled, that is at its pole after a turn, where crank and rocker meet; and it."""
    at = fourbar(np.array([START + turned]))
    crank, rocker = at.crank_pin[0], at.rocker_pin[0] - [100.0, 0.0]
    s, _ = np.linalg.solve(np.stack([crank, -rocker], axis=1), [100.0, 0.0])
    pole = s * crank - at.crank_pin[0]
    angle = float(at.coupler[0])
    along, across = pole @ [np.cos(angle), np.sin(angle)], pole @ [-np.sin(angle), np.cos(angle)]
    return (*coupler_point(START, along, across)[0], 7.0), (*(s * crank), 7.0)


@pytest.mark.long
def test_a_point_at_the_pole_of_the_coupler_has_a_cusp(motion):
    """Crank and rocker, prolonged, meet in the pole: the point of the coupler there stands still."""
    point, pole = at_the_pole(1.2345)
    found = jk.coupler_curve(motion, "coupler", point)
    (cusp,) = found.cusps
    assert abs(cusp.input - 1.2345) < 1e-10
    np.testing.assert_allclose(cusp.point, pole, atol=1e-9)
    near = jk.coupler_curve(motion, "coupler", np.add(point, (0.01, 0.0, 0.0)))
    assert near.cusps == ()


@pytest.mark.long
@pytest.mark.parametrize(
    ("turned", "start", "poses"),
    [
        (0.0, 0.0, 181),
        (0.0, -np.pi, 181),  # in the middle
        (0.3, 0.3, 13),
        (0.5, 0.0, 13),  # within a step of 0.52 of the ends
        (5.9, 0.0, 13),
    ],
)
def test_a_cusp_at_the_ends_of_a_full_turn_is_one(motion, turned, start, poses):
    point, pole = at_the_pole(turned)
    turn = motion.mechanism.sweep({"A": start + np.linspace(0.0, 2 * np.pi, poses)})
    found = jk.coupler_curve(turn, "coupler", point)
    (cusp,) = found.cusps
    assert abs(cusp.input - turned) < 1e-10
    np.testing.assert_allclose(cusp.point, pole, atol=1e-9)
    if poses == 181:  # far more steps than crossings: they are those of any other turn
        again = jk.coupler_curve(motion.mechanism.sweep({"A": 2.0 + TURN}), "coupler", point)
        assert len(found.crossings) == len(again.crossings)
        assert all(abs(each.inputs[0] - each.inputs[1]) > 0.1 for each in found.crossings)


@pytest.mark.long
def test_cusps_are_within_the_range(motion):
    """One beside the range, by less than a step, is none of it; one at its end is."""
    point, _ = at_the_pole(1.2345)
    beside = motion.mechanism.sweep({"A": np.linspace(1.3, 3.0, 18)})
    assert jk.coupler_curve(beside, "coupler", point).cusps == ()
    ends = motion.mechanism.sweep({"A": np.linspace(1.2345, 3.0, 18)})
    assert len(jk.coupler_curve(ends, "coupler", point).cusps) == 1


@pytest.mark.long
def test_a_crossing_at_the_ends_of_a_full_turn_is_one(motion):
    point = (*coupler_point(START, 50.0, -60.0)[0], 0.0)
    (first, *_) = jk.coupler_curve(motion, "coupler", point).crossings
    for start in first.inputs:
        turn = motion.mechanism.sweep({"A": start + TURN})
        found = jk.coupler_curve(turn, "coupler", point).crossings
        apart = abs(first.inputs[0] - first.inputs[1])
        other = apart if start == first.inputs[0] else 2 * np.pi - apart
        (one,) = [each for each in found if abs(each.inputs[0] - start) < 1e-9]
        np.testing.assert_allclose(one.inputs, (start, start + other), atol=1e-9)
        np.testing.assert_allclose(one.angle, first.angle, atol=1e-9)


def test_a_curve_may_begin_anew_after_two_turns():
    """The limacon r = 1 + 2 cos(u / 2) about the angle u / 2: its loop crosses at r = 0, by 60 degrees."""

    def limacon(u):
        e = np.exp(0.5j * u)
        points = e + 1 + e**2  # (1 + 2 cos) e
        slopes = 0.5j * e + 1j * e**2
        bends = -0.25 * e - e**2
        point, slope, bend = (np.stack([each.real, each.imag, 0 * u], axis=-1) for each in (points, slopes, bends))
        return CurvePoints(point, slope, bend, np.ones(len(u), bool))

    inputs = np.linspace(0.0, 6 * np.pi, 100)  # steps that no turn ends at
    curve = range_of(limacon, inputs, limacon(inputs).point, 3.0)
    assert curve.repeats
    np.testing.assert_allclose(curve.inputs[[0, -1]], [0.0, 4 * np.pi], atol=1e-14)
    (crossing,) = crossings_of(limacon, np.eye(3)[:2], curve, 3.0, cusps_of(limacon, curve))
    np.testing.assert_allclose(crossing.inputs, (4 * np.pi / 3, 8 * np.pi / 3), atol=1e-12)
    np.testing.assert_allclose(crossing.angle, np.pi / 3, atol=1e-12)
    once = range_of(limacon, inputs[:34], limacon(inputs[:34]).point, 3.0)  # one turn, which is half of it
    assert not once.repeats and len(once.inputs) == 34


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
def test_a_point_at_rest_has_neither_and_says_so(motion, tmp_path):
    """The pivot of the crank, and a point of the ground; that beside the pivot, by a millionth of the crank, draws."""
    for part, point in (("crank", (0.0, 0.0, 0.0)), ("ground", (3.0, 4.0, 5.0))):
        found = jk.coupler_curve(motion, part, point)
        assert found.rests and found.plane is None and found.cusps == found.crossings == ()
        assert str(found).startswith(f"Curve of a point of {part} over A.phi, 181 poses: the point rests at (")
        assert found.plot(tmp_path / "rest.png").stat().st_size > 1000
    beside = jk.coupler_curve(motion, "crank", (4e-5, 0.0, 0.0))
    assert not beside.rests and beside.plane is not None and beside.cusps == beside.crossings == ()


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
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_single_precision_has_the_same_cusps_and_crossings(motion):
    """Also in a plane that is tilted, and for curves of two turns; a point at rest is so but for rounding."""
    turned = 1.2345
    cusp, _ = at_the_pole(turned)
    eight = (*coupler_point(START, 50.0, -60.0)[0], 0.0)
    crossings = sorted(each.inputs for each in jk.coupler_curve(motion, "coupler", eight).crossings)
    assert crossings
    tilt = Rotation.from_rotvec([0.3, -0.5, 0.2]).as_matrix()
    places = {joint.name: np.asarray(joint.frames_1)[0, :3, 3] for joint in motion.mechanism.all_joints}
    with jax.enable_x64(False):
        tilted = jk.Mechanism.build(
            fixed=["ground"],
            joints=[
                jk.revolute(name, *motion.mechanism.joints[name].parts, point=tilt @ place, axis=tilt[:, 2])
                for name, place in places.items()
            ],
        )
        once, twice = (tilted.sweep({"A": np.linspace(0.0, turns * 2 * np.pi, 361)}) for turns in (1, 2))
        assert once.residual.dtype == np.float32
        for swept in (once, twice):
            found = jk.coupler_curve(swept, "coupler", tilt @ cusp)
            assert found.plane is not None
            # inputs of some radians are rounded to 5e-7, and poses to as much of 100, over slopes of some 50
            np.testing.assert_allclose([each.input for each in found.cusps], [turned], atol=1e-5)
            found = jk.coupler_curve(swept, "coupler", tilt @ eight)
            np.testing.assert_allclose(sorted(each.inputs for each in found.crossings), crossings, atol=1e-5)
            assert found.cusps == ()
        beside = jk.coupler_curve(once, "coupler", tilt @ np.add(cusp, (0.5, 0.0, 0.0)))
        assert beside.cusps == ()
        for part, point in (("crank", (0.0, 0.0, 0.0)), ("ground", (3.0, 4.0, 5.0))):
            assert jk.coupler_curve(once, part, point).rests
        assert not jk.coupler_curve(once, "crank", (0.1, 0.0, 0.0)).rests


@pytest.mark.long
def test_it_prints_draws_and_saves(motion, tmp_path):
    found = jk.coupler_curve(motion, "coupler", (*coupler_point(START, 50.0, -60.0)[0], 0.0))
    assert str(found).startswith("Curve of a point of coupler over A.phi, 181 poses, plane")
    assert str(found).count("crossing at") == len(found.crossings) > 0
    assert found.plot(tmp_path / "curve.png").stat().st_size > 10_000
    table = np.genfromtxt(found.save(tmp_path / "curve.csv"), delimiter=",", names=True)
    np.testing.assert_allclose(table["x"], found.points[:, 0], rtol=1e-8)


@pytest.mark.long
def test_what_makes_no_sense_is_refused(motion):
    with pytest.raises(ValueError, match="no part 'copler'; did you mean 'coupler'"):
        jk.coupler_curve(motion, "copler", (0, 0, 0))
    with pytest.raises(ValueError, match="three finite numbers"):
        jk.coupler_curve(motion, "coupler", (0, 0))
    with pytest.raises(ValueError, match=r"three finite numbers \(x, y, z\), got \(1, 2, nan\)"):
        jk.coupler_curve(motion, "coupler", (1, 2, np.nan))
    with pytest.raises(ValueError, match="of a motion"):
        jk.coupler_curve(motion.mechanism, "coupler", (0, 0, 0))
    with pytest.raises(ValueError, match="four closed poses"):
        jk.coupler_curve(motion.mechanism.sweep({"A": TURN[:3]}), "coupler", (0, 0, 0))
    with pytest.raises(ValueError, match="on the host"):
        jax.jit(lambda point: jk.coupler_curve(motion, "coupler", point).points)(np.zeros(3))


@pytest.mark.long
def test_poses_that_are_not_closed_are_told_and_those_between_them_drawn(motion, tmp_path, monkeypatch):
    inputs = TURN[:40].copy()
    inputs[[1, 3]] = np.nan  # the pose between them has no line to it
    figures = []
    monkeypatch.setattr("jaxkin.effects.coupler_curve.save_figure", lambda figure, path: figures.append(figure) or path)
    found = jk.coupler_curve(motion.mechanism.sweep({"A": inputs}), "crank", (3.0, 1.0, 0.0))
    assert str(found).startswith("Curve of a point of crank over A.phi, 40 poses, 2 of them not closed, plane")
    found.plot(tmp_path / "curve.png")
    dots = figures[0].axes[0].lines[1].get_xydata()
    np.testing.assert_allclose(dots, found.points[[0, 2], :2], atol=1e-12)


def test_places_have_their_unit(motion):
    mechanism = replace(motion.mechanism, unit="mm")
    found = jk.coupler_curve(mechanism.sweep({"A": TURN[:5]}), "crank", (0.0, 0.0, 0.0))
    assert str(found).endswith(") mm")
