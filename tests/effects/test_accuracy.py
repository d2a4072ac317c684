"""What accuracy costs: errors against extended precision, which has its own checks; methods; the advice."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.accuracy import TIGHTEST_32, WorkPrecision, WorkPrecisionPoint, _ExactPoses, combinations
from jaxkin.effects.extended import Extended
from jaxkin.solve.execution.compiler import compilations
from jaxkin.solve.options import METHODS
from jaxkin.solve.status import Status
from reference import planar
from reference.mechanisms import cardan_shafts, planar_fourbar, rssr_linkage

TURN = np.linspace(0.0, 2 * np.pi, 25)


def exact_fourbar(mp, theta):
    """The rocker angle by the law of cosines in extended precision."""
    x, y = 100 - 40 * mp.cos(theta), -40 * mp.sin(theta)
    return mp.atan2(-y, -x) - mp.acos((80**2 + x * x + y * y - 120**2) / (160 * mp.sqrt(x * x + y * y)))


def test_extended_precision_finds_the_closed_form():
    """From a pose that is off by 1e-3 to the closed form in fifty digits; the frames hold rounding of 1e-16."""
    mechanism = planar_fourbar(1.0)
    loops = Extended(mechanism, mechanism.structure.loop_groups[0], [1, 2, 3])
    start = planar.fourbar(np.array([1.0]))
    for turn in (0.3, 2.0, 5.0):
        expected = exact_fourbar(loops.mp, 1 + loops.mp.mpf(turn)) - exact_fourbar(loops.mp, loops.mp.mpf(1))
        at = planar.fourbar(np.array([1.0 + turn]))
        coupler, rocker = float(at.coupler[0] - start.coupler[0]), float(at.rocker[0] - start.rocker[0])
        pose, ended = loops.closed(np.array([turn, coupler - turn + 1e-3, rocker - coupler - 1e-3, rocker + 1e-3]))
        assert ended
        np.testing.assert_allclose(np.cos(pose[3] - float(expected)), 1.0, atol=1e-15)
        np.testing.assert_allclose(np.sin(pose[3] - float(expected)), 0.0, atol=2e-15)


OTHERS = [name for name in METHODS if name != "continuation"]


@pytest.mark.parametrize("method", [pytest.param(name, marks=pytest.mark.long) for name in OTHERS])
def test_other_methods_find_the_same_poses(method):
    """Held to what is asked for, over the smallest singular value (0.3); BFGS and DFP may give up at some poses."""
    motion = planar_fourbar(1.0).sweep({"A": TURN}, method=method, tolerance=1e-9)
    expected = np.unwrap(planar.fourbar(1.0 + TURN).rocker)
    closed = np.asarray(motion.closed)
    assert closed.mean() > 0.9
    assert set(np.asarray(motion.status).tolist()) <= {Status.CLOSED, Status.STALLED}
    assert np.max(np.asarray(motion.residual)[closed]) <= 1e-9
    np.testing.assert_allclose(
        np.asarray(motion.coordinates["D"][:, 0])[closed], (expected - expected[0])[closed], atol=1e-8
    )


@pytest.mark.long
def test_a_tolerance_is_kept_and_compiles_nothing():
    mechanism = cardan_shafts()
    mechanism.sweep({"in": TURN})
    before = compilations()
    for tolerance in (1e-3, 1e-6, 1e-9):
        motion = mechanism.sweep({"in": TURN}, tolerance=tolerance)
        assert np.all(motion.closed) and np.max(motion.residual) <= tolerance
    assert compilations() == before


@pytest.mark.parametrize(
    "make, joint", [pytest.param(make, "A", marks=pytest.mark.long) for make in (planar_fourbar, rssr_linkage)]
)
def test_work_precision_measures_errors_within_what_was_asked(make, joint):
    work = jk.work_precision(make(), {joint: TURN}, tolerances=(1e-4, 1e-9), methods=["continuation"])
    assert [(p.method, p.precision, p.tolerance) for p in work.points] == combinations((1e-4, 1e-9), ["continuation"])
    for point in work.points:
        assert point.closed > 0.9 and point.seconds > 0
        limit = point.tolerance or (1e-12 if point.precision == "float64" else 1e-5)
        assert point.error <= 20 * limit  # over the smallest singular value, which is above 0.05 here
    assert min(point.error for point in work.points) < 1e-13


def test_the_table_and_the_advice(tmp_path):
    def point(method, precision, tolerance, seconds, error):
        return WorkPrecisionPoint(method, precision, tolerance, seconds, error, error, 1.0)

    work = WorkPrecision(
        (
            point("continuation", "float64", 1e-6, 1.0, 4e-7),
            point("continuation", "float64", None, 1.12, 3e-15),
            point("continuation", "float32", None, 0.8, 3e-7),
            point("dfp", "float64", 1e-12, 56.0, 2e-14),
        ),
        100,
        12,
    )
    assert work.advice == (
        "An error of 3e-15 costs 12% more than one of 4e-07 here; float32 stops at 3e-07; "
        "dfp, as accurate, takes 50 times as long."
    )
    assert str(work).splitlines()[-1] == work.advice and "rounding" in str(work)
    without = replace(work, points=work.points[-1:])
    assert without.advice == "The least error, 2e-14, costs no more than larger ones here."
    unknown = replace(work, points=(*work.points, point("bfgs", "float64", 1e-12, 0.1, np.nan)))
    assert unknown.advice == work.advice and "nan" in str(unknown)
    assert "no error to tell" in replace(work, points=unknown.points[-1:]).advice
    picture = unknown.plot(tmp_path / "work.png")
    assert picture.read_bytes().startswith(b"\x89PNG") and [file.name for file in tmp_path.iterdir()] == ["work.png"]


@pytest.mark.long
def test_a_sweep_none_of_whose_poses_closed_has_no_error():
    mechanism = planar_fourbar(1.0)
    motion = mechanism.sweep({"A": TURN})
    exact = _ExactPoses(mechanism, motion, np.arange(0, len(TURN), 8))
    assert exact.known.all() and exact.error(motion) < 1e-13
    assert np.isnan(exact.error(replace(motion, status=np.full(len(TURN), Status.STALLED.value))))


@pytest.mark.long
def test_bad_input():
    mechanism = planar_fourbar()
    with pytest.raises(ValueError, match=r"no method 'dpf'.*'dfp'"):
        mechanism.sweep({"A": TURN}, method="dpf")
    for wrong in (0.0, -1e-3, float("nan")):
        with pytest.raises(ValueError, match="positive finite number"):
            mechanism.sweep({"A": TURN}, tolerance=wrong)
    stuck = planar_fourbar(1.0, crank=95.0, coupler=60.0)
    with pytest.raises(ValueError, match="no pose of this drive closes"):
        jk.work_precision(stuck, {"A": np.linspace(1.0, 1.2, 5)})


def test_float32_is_asked_for_what_it_can():
    assert all(t is None or t >= TIGHTEST_32 for _, precision, t in combinations() if precision == "float32")
