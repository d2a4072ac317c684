"""`optimize` on problems whose answer is known, its result on disk, and what it refuses."""

import json
import warnings
from dataclasses import fields

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from jaxkin.design import result
from jaxkin.design.variables import variables
from reference.mechanisms import fourbar_through, planar_fourbar

TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
POINT = (30.0, 60.0, 0.0)
CRANK, COUPLER, ROCKER = ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")
BOUNDS = {CRANK: (20.0, 60.0), COUPLER: (90.0, 150.0), ROCKER: (60.0, 120.0)}
TRUTH = planar_fourbar(1.0)
START = TRUTH.with_lengths({CRANK: 45.0, COUPLER: 110.0, ROCKER: 90.0})


@pytest.fixture(scope="module")
def recovered():
    """From a path that crank 40, coupler 120, rocker 80 draw, from another linkage and seven random ones."""
    path = np.asarray(TRUTH.sweep({"A": TURN}).points("coupler", POINT))[:, :2]
    return jk.optimize(design.path("coupler", POINT, path), START, drive={"A": TURN}, lengths=BOUNDS, starts=8)


@pytest.mark.long
@pytest.mark.study
def test_a_synthetic_target_is_recovered(recovered):
    """To 1e-6 relative, as asked for; a sum of squares that falls to none converges quadratically, to rounding."""
    found = [recovered.values[f"({', '.join(key)})"] for key in BOUNDS]
    np.testing.assert_allclose(found, [40.0, 120.0, 80.0], rtol=1e-9)
    assert recovered.mechanism.lengths[CRANK] == pytest.approx(40.0, rel=1e-9)
    assert recovered.feasible and recovered.moves.everywhere
    assert recovered.moves.counts == {"CLOSED": 361}
    assert recovered.reason.startswith("converged after")
    least = np.nanmin(recovered.history, axis=1)
    assert recovered.history.shape[1] == 8 and least[-1] < 1e-15 * least[0]


@pytest.mark.long
@pytest.mark.study
def test_a_result_is_saved_and_read_back(recovered, tmp_path):
    again = design.read_optimum(recovered.save(tmp_path / "best.npz"))
    assert str(again) == str(recovered)
    assert again.mechanism.lengths == recovered.mechanism.lengths
    np.testing.assert_array_equal(again.history, recovered.history)
    np.testing.assert_array_equal(again.drive["A"], TURN)
    assert [file.name for file in tmp_path.iterdir()] == ["best.npz"]  # nothing half written is left
    assert again.plot().axes and len(recovered.plot().axes) == 2
    with pytest.raises(ValueError, match=r"saved as a \.npz file, got .*best\.png"):
        recovered.save(tmp_path / "best.png")
    (tmp_path / "bad.npz").write_bytes(b"no archive")
    with pytest.raises(ValueError, match=r"bad\.npz' is no saved result"):
        design.read_optimum(tmp_path / "bad.npz")


@pytest.mark.long
@pytest.mark.study
def test_bounded_minimum_of_any_loss():
    """Mean transmission quality with rocker and coupler tied: the best crank is the shortest that is allowed.

    In a symmetric four-bar the cosine of the transmission angle swings by 2 ground crank / (2 coupler rocker) about a
    mean that the tied length sets, so its squares fall with the crank; an extra that nothing depends on is named.
    """

    def loss(motion, extras):
        return jnp.mean(jnp.cos(design.transmission_angle(motion, "C", ("B", "D"))) ** 2)

    with pytest.warns(UserWarning, match=r"the loss does not depend on spare: the derivative is zero"):
        best = jk.optimize(
            loss,
            START,
            drive={"A": TURN},
            lengths={CRANK: (30.0, 60.0), COUPLER: (90.0, 150.0)},
            extras={"spare": design.Free(0.5, 0.0, 1.0)},
            ties={ROCKER: COUPLER},
            constraints=[design.full_crank(("ground", "A", "D"), CRANK, COUPLER, ROCKER)],
        )
    assert best.values["(crank, A, B)"] == pytest.approx(30.0, abs=1e-6)
    assert best.mechanism.lengths[ROCKER] == pytest.approx(best.mechanism.lengths[COUPLER], rel=1e-12)
    # cos = 1 - (100^2 + 30^2 - 2 100 30 cos theta) / (2 l^2), of which the mean square is least at:
    angles, lengths = 1.0 + TURN, np.linspace(90.0, 150.0, 60001)
    diagonal = 100.0**2 + 30.0**2 - 2 * 100.0 * 30.0 * np.cos(angles)
    expected = [np.mean((1 - diagonal / (2 * length**2)) ** 2) for length in lengths[::100]]
    coarse = lengths[::100][np.argmin(expected)]
    assert best.values["(coupler, B, C)"] == pytest.approx(coarse, abs=0.1)  # the grid's spacing
    assert best.value == pytest.approx(np.min(expected), rel=1e-5)
    assert best.values["spare"] == 0.5


@pytest.mark.long
def test_a_variable_without_influence_is_named_and_keeps_its_value():
    """The residual is of the crank's length and of nothing else: its derivative by an extra is exactly zero."""

    def loss(motion, extras):
        return jnp.atleast_1d(design.measures.lengths_now(motion.mechanism, [CRANK])[0] - 30.0)

    with pytest.warns(UserWarning, match=r"the loss does not depend on spare: the derivative is zero for every start"):
        best = jk.optimize(
            loss,
            START,
            drive={"A": TURN[:3]},
            lengths={CRANK: (20.0, 60.0)},
            extras={"spare": design.Free(0.5, 0.0, 1.0)},
            solver=design.LevenbergMarquardt(iterations=10),
        )
    assert best.values["spare"] == 0.5
    assert best.values["(crank, A, B)"] == pytest.approx(30.0, rel=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("solver", [design.LevenbergMarquardt(), design.LBFGS()], ids=str)
def test_a_loss_that_no_variable_changes_is_not_searched(solver, tmp_path):
    """Where the points of the crank are follows from the angle alone, but for rounding."""
    objective = design.path("crank", (2.0, 1.0), np.ones((3, 2)))
    with pytest.warns(UserWarning, match=r"the loss does not depend on \(coupler, B, C\)"):
        best = jk.optimize(
            objective,
            START,
            drive={"A": TURN[:3]},
            lengths={COUPLER: (90.0, 150.0)},
            solver=solver,
        )
    assert best.values["(coupler, B, C)"] == 110.0
    assert best.reason.startswith("there was nothing to search for")
    assert best.history.shape == (0, 1) and best.feasible
    assert best.value == pytest.approx(float(objective(START.sweep({"A": TURN[:3]}))), rel=1e-12)
    assert best.plot(tmp_path / "best.png").axes and (tmp_path / "best.png").is_file()


@pytest.mark.long
def test_what_is_zero_already_is_no_loss_without_variables():
    """The transmission angle is as near to a right one as was asked for: nothing is warned of."""
    objective = design.transmission("C", ("B", "D"), beyond=1.5)
    best = jk.optimize(objective, START, drive={"A": TURN[:3]}, lengths={COUPLER: (109.0, 111.0)})
    assert best.value == 0 and best.values["(coupler, B, C)"] == 110.0


def quality(motion):
    return jnp.mean(motion.coordinates["D"] ** 2)


BAD = {
    "part": (dict(lengths={("crnk", "A", "B"): (20, 60)}), r"crnk"),
    "joint": (dict(lengths={("crank", "A", "Q"): (20, 60)}), r"Q"),
    "negative": (dict(lengths={CRANK: (-5, 60)}), r"\('crank', 'A', 'B'\): the lower bound -5.0 is negative"),
    "start": (dict(lengths={CRANK: (50, 60)}), r"the bounds exclude the start, start 45.0, bounds 50.0 to 60.0"),
    "swapped": (dict(lengths={CRANK: (60, 20)}), r"the lower bound is above the upper one"),
    "one bound": (dict(lengths={CRANK: 60}), r"give its bounds as \(lower, upper\), got 60"),
    "infinite": (dict(lengths={CRANK: (20, np.inf)}), r"must be finite"),
    "nothing": (dict(), r"nothing to choose"),
    "point": (dict(points={"Q": (-1, 1)}), r"Q"),
    "tie": (dict(lengths={CRANK: (20, 60)}, ties={ROCKER: COUPLER}), r"\('coupler', 'B', 'C'\) is no variable"),
    "angle": (dict(lengths={(*CRANK, "angle"): (0, 7)}), r"in radians between 0 and pi, got the bounds 0 to 7"),
    "end": (dict(lengths={COUPLER: (90, 150)}, points={"C": (0, 200)}), r"ends at the joint of the point 'C'"),
    "tied end": (
        dict(
            points={("ground", "A"): (-9, 9), ROCKER[:2]: (-1e3, 1e3)}, lengths={CRANK: (9, 60)}, ties={ROCKER: CRANK}
        ),
        r"length \('rocker', 'C', 'D'\) ends at the joint of the point \('rocker', 'C'\)",
    ),
    "extra": (dict(extras={"x": 3.0}), r"write jk\.design\.Free"),
    "method": (dict(lengths={CRANK: (20, 60)}, solver="newton"), r"LevenbergMarquardt\(...\) or .*, got 'newton'"),
    "starts": (dict(lengths={CRANK: (20, 60)}, starts=0), r"starts must be a whole number, 1 or more, got 0"),
    "drive": (dict(drive={"Q": TURN}, lengths={CRANK: (20, 60)}), r"no joint 'Q'"),
}


@pytest.mark.parametrize("name", BAD)
def test_refusals(name):
    given, said = BAD[name]
    with pytest.raises(ValueError, match=said):
        jk.optimize(quality, START, **{"drive": {"A": TURN}, **given})


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_a_start_is_within_its_bounds_in_any_unit(unit):
    """Rounding of what is measured is moved onto the bounds; a hundred-thousandth of it is no rounding, and was taken
    for some where numbers are small, as of millimetres in kilometres."""
    mechanism = fourbar_through(*unit * np.array([(0.0, 0.0), (21.6, 33.7), (115.0, 78.6), (100.0, 0.0)]))
    crank = float(mechanism.lengths[CRANK])
    chosen = variables(mechanism, {"A": TURN}, {CRANK: (crank * (1 + 1e-12), 2 * crank)}, {}, {}, {})
    assert chosen.start[0] == chosen.lower[0]
    with pytest.raises(ValueError, match="the bounds exclude the start"):
        variables(mechanism, {"A": TURN}, {CRANK: (crank * (1 + 1e-5), 2 * crank)}, {}, {}, {})


@pytest.mark.parametrize(
    ("loss", "said"),
    [
        (lambda m: m.coordinates["D"], r"must return one number, got an array of shape \(24, 1\)"),
        (lambda m: jnp.asarray(3.0), r"the loss is the same for every design: it must depend on the motion"),
        (lambda m: "good", r"must return one number, got str"),
        (lambda m: jnp.max(m.coordinates["D"]) > 0.1, r"must return a number, got a truth value"),
        (
            lambda m: jnp.sum(m.coordinates["D"] > 0.1),
            r"returns whole numbers, .* have no derivative; return what",
        ),
        (lambda m: jnp.sum(m.coordinates["D"]) * 1j, r"must return one number, got numbers of type complex128"),
        (
            lambda m: np.sum(np.asarray(m.coordinates["D"])),
            r"the loss is differentiated by JAX: write it with jax.numpy",
        ),
        (lambda m: float(m.coordinates["D"][0, 0]), r"the loss is differentiated by JAX: write it with jax.numpy"),
        pytest.param(
            lambda m: jnp.sum(jnp.log(-1.0 - m.coordinates["D"] ** 2)),
            r"the loss of the design given is nan",
            marks=pytest.mark.long,  # its motions are compiled before that is known
        ),
    ],
)
def test_losses_that_are_none(loss, said):
    with warnings.catch_warnings(), pytest.raises(ValueError, match=said):
        warnings.simplefilter("ignore", RuntimeWarning)
        jk.optimize(loss, START, drive={"A": TURN}, lengths={CRANK: (20, 60)})


@pytest.fixture
def saved(tmp_path):
    nothing = np.zeros(0)
    verdict = result.SweepVerdict(1, {"CLOSED": 1}, 1.0)
    found = result.Optimum(TRUTH, 1.0, 0.0, nothing, "", 0.0, {}, {}, {"A": TURN}, nothing, nothing, verdict)
    return found.save(tmp_path / "best.npz")


def test_a_saved_result_of_another_format_is_refused(saved, monkeypatch):
    assert design.read_optimum(saved).mechanism.lengths == TRUTH.lengths
    monkeypatch.setattr(result, "SAVED_FORMAT", result.SAVED_FORMAT + 1)
    with pytest.raises(ValueError, match=r"no saved result of optimize: format 3, and this version reads 4"):
        design.read_optimum(saved)


def test_a_damaged_result_is_refused_by_name(saved):
    """Whatever is gone or altered: files that were cut off were an error of zipfile, missing keys a KeyError."""
    whole = saved.read_bytes()
    with np.load(saved) as file:
        arrays = {name: file[name] for name in file.files}
    text = json.loads(str(arrays["text"]))
    for size in (0, 1, 100, len(whole) // 2, len(whole) - 1):
        saved.write_bytes(whole[:size])
        with pytest.raises(ValueError, match=r"best\.npz' is no saved result of optimize"):
            design.read_optimum(saved)
    for key, value in (("moves", None), ("moves", {}), ("value", ...), ("unit", "cubit"), ("linkage", [])):
        words = {name: each for name, each in (text | {key: value}).items() if each is not ...}
        np.savez(saved, **arrays | {"text": np.array(json.dumps(words))})
        with pytest.raises(ValueError, match=r"best\.npz' is no saved result of optimize"):
            design.read_optimum(saved)


def test_the_format_of_saved_results_changes_with_what_is_saved():
    """Whoever changes the fields raises `SAVED_FORMAT`, and writes both here."""
    assert result.SAVED_FORMAT == 3
    assert [field.name for field in fields(result.SweepVerdict)] == ["poses", "counts", "steepest"]


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_a_search_in_float32_overflows_nowhere():
    """At the minimum rounding refuses steps one after the other, each with a damping that grows faster: by the time the
    search is given up it is no number of float32. Rounding of points leaves 1e-5 of the length."""
    angles, coupler = np.linspace(0.0, 1.0, 9), ("coupler", "B", "C")
    places = [("A", "ground", "crank", (0, 0, 0)), ("B", "crank", "coupler", (1, 0, 0))]
    places += [("C", "coupler", "rocker", (3.2, 2.9, 0)), ("D", "ground", "rocker", (4, 0, 0))]
    joints = [jk.revolute(name, one, two, point=at, axis=(0, 0, 1)) for name, one, two, at in places]
    with jax.enable_x64(False):
        start = jk.Mechanism.build(fixed=["ground"], joints=joints)
        path = start.with_lengths({coupler: 3.8}).sweep({"A": angles}).points("coupler", (2.0, 1.0, 0.0))[:, :2]
        objective = design.path("coupler", (2.0, 1.0, 0.0), path)
        found = jk.optimize(objective, start, drive={"A": angles}, lengths={coupler: (3, 4.5)})
    assert found.mechanism.lengths[coupler] == pytest.approx(3.8, rel=1e-5)
