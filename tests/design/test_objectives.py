"""Objectives and constraints on a motion that is known: zero where it does what is wanted, right elsewhere."""

import traceback

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from jaxkin.design.penalty import closure_gaps
from reference import planar, spatial
from reference.mechanisms import planar_fourbar, slider_crank

TURN = np.linspace(0.0, 2 * np.pi, 30)
START = 1.0
POINT = (30.0, 60.0, 0.0)
KEYS = [("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")]


@pytest.fixture(scope="module")
def motion():
    return planar_fourbar(START).sweep({"A": TURN})


@pytest.mark.long
def test_path(motion):
    own = np.asarray(motion.points("coupler", POINT))[:, :2]
    assert design.path("coupler", POINT, own)(motion) < 1e-20
    assert design.path("coupler", POINT, own + [3.0, 4.0])(motion) == pytest.approx(30 * 25.0)
    named = design.path("coupler", "P", own[::-1], timing=False)
    assert named(motion, {"P": jnp.array(POINT)}) < 1e-20  # any order
    between = 0.5 * (own[4] + own[5])
    normal = np.array([-(own[5] - own[4])[1], (own[5] - own[4])[0]]) / np.linalg.norm(own[5] - own[4])
    beside = design.path("coupler", POINT, [between + 0.01 * normal], timing=False)
    assert beside(motion) == pytest.approx(1e-4)
    cos, sin = np.cos(0.3), np.sin(0.3)
    moved = own @ np.array([[cos, sin], [-sin, cos]]) + [7.0, -2.0]
    placed = design.path("coupler", POINT, moved, placement="place")
    assert placed(motion, {"place": jnp.array([7.0, -2.0, 0.3])}) < 1e-20


@pytest.mark.long
def test_the_path_of_a_single_pose_is_its_place(motion):
    """All of a path that is one place is nearest to every target."""
    alone = motion.mechanism.sweep({"A": np.array([0.3])})
    place = np.asarray(alone.points("coupler", (30.0, 60.0, 0.0)))[0, :2]
    objective = design.path("coupler", (30.0, 60.0, 0.0), place + [[3.0, 4.0], [0.0, 1.0]], timing=False)
    assert float(objective(alone)) == pytest.approx(26.0, rel=1e-12)


def test_function_and_dwell(motion):
    rocker = planar.fourbar(START + TURN).rocker
    wanted = rocker - rocker[0]
    assert design.function("D", wanted + 0.7)(motion) < 1e-20
    assert design.function("D", wanted + 0.7, relative=False)(motion) == pytest.approx(30 * 0.49)
    chosen = [3, 4, 5]
    assert design.dwell("D", chosen)(motion) == pytest.approx(3 * np.var(rocker[chosen]))


@pytest.mark.long
def test_guidance(motion):
    at = planar.fourbar(START + TURN)
    turn = at.coupler - at.coupler[0]
    own = np.column_stack([np.asarray(motion.points("coupler", POINT))[:, :2], turn + 2 * np.pi])
    assert design.guidance("coupler", POINT, own, size=50.0)(motion) < 1e-18  # full turns do not matter
    off = own + [0.0, 0.0, 1e-3]
    assert design.guidance("coupler", POINT, off, size=50.0)(motion) == pytest.approx(30 * (50 * 1e-3) ** 2, rel=1e-6)


@pytest.mark.long
def test_transmission_angle_by_the_law_of_cosines(motion):
    diagonal = 100.0**2 + 40.0**2 - 2 * 100.0 * 40.0 * np.cos(START + TURN)
    expected = np.arccos((120.0**2 + 80.0**2 - diagonal) / (2 * 120.0 * 80.0))
    found = design.transmission_angle(motion, "C", ("B", "D"))
    np.testing.assert_allclose(found, expected, atol=1e-12)
    assert design.transmission("C", ("B", "D"))(motion) == pytest.approx(np.sum(np.cos(expected) ** 2))
    excess = np.maximum(np.abs(np.cos(expected)) - np.sin(0.5), 0.0)
    assert design.transmission("C", ("B", "D"), beyond=0.5)(motion) == pytest.approx(np.sum(excess**2))
    within = design.transmission_within("C", ("B", "D"), 0.6)(motion, {})
    assert (np.min(within) >= 0) == (expected.min() >= 0.6)


@pytest.mark.long
def test_heights_of_hinges_do_not_change_the_transmission_angle(motion):
    """A linkage is drawn with its links on layers, and joints read from solids lie at their heights."""
    z, at = (0, 0, 1), planar.fourbar(np.array([START]))
    pins = [(0, 0, 0), (*at.crank_pin[0], 35.0), (*at.rocker_pin[0], -20.0), (100.0, 0, 50.0)]
    bars = [("ground", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("ground", "rocker")]
    joints = [jk.revolute(name, *bar, point=pin, axis=z) for name, bar, pin in zip("ABCD", bars, pins, strict=True)]
    layered = jk.Mechanism.build(fixed=["ground"], joints=joints).sweep({"A": TURN})
    found = [design.transmission_angle(each, "C", ("B", "D")) for each in (layered, motion)]
    np.testing.assert_allclose(found[0], found[1], atol=1e-12)


@pytest.mark.long
def test_the_transmission_angle_of_a_spherical_linkage_is_that_of_its_planes():
    """By the cosine law of spheres: cos(diagonal) = cos(coupler) cos(rocker) + sin(coupler) sin(rocker) cos(angle)."""
    ground, coupler, rocker = 1.2, 1.1, 0.9
    at = spatial.spherical_fourbar(np.array([0.4]))
    poles = [np.array([0, 0, 50.0]), 60.0 * at.input_pin[0], 40.0 * at.output_pin[0]]
    poles.append(70.0 * np.array([0.0, -np.sin(ground), np.cos(ground)]))
    bars = [("ground", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("ground", "rocker")]

    def linkage(points):
        return jk.Mechanism.build(
            fixed=["ground"],
            joints=[
                jk.revolute(name, *bar, point=point, axis=pole)
                for name, bar, point, pole in zip("ABCD", bars, points, poles, strict=True)
            ],
        )

    motion = linkage(poles).sweep({"A": TURN})
    moved = spatial.spherical_fourbar(0.4 + TURN).input_pin @ (poles[3] / 70.0)
    cosine = (moved - np.cos(coupler) * np.cos(rocker)) / (np.sin(coupler) * np.sin(rocker))
    found = design.transmission_angle(motion, "C", ("B", "D"))
    np.testing.assert_allclose(found, np.arccos(cosine), atol=1e-12)
    with pytest.raises(ValueError, match="the point of joint 'D' is on the axis of 'C'"):
        design.transmission_angle(linkage([*poles[:3], np.zeros(3)]).sweep({"A": TURN[:3]}), "C", ("B", "D"))


@pytest.mark.long
def test_stroke():
    motion = slider_crank(START).sweep({"A": np.linspace(0.0, 2 * np.pi, 30)})
    slider = planar.slider_crank(START + TURN).slider
    assert design.stroke(motion, "S") == pytest.approx(np.ptp(slider))
    assert design.stroke_of("S", 2 * float(np.ptp(slider)))(motion) == pytest.approx(0.25)


def test_weighted_sums(motion):
    own = np.asarray(motion.points("coupler", POINT))[:, :2]
    one, other = design.path("coupler", POINT, own + 1.0), design.transmission("C", ("B", "D"))
    assert (2.0 * one + other * 3.0)(motion) == pytest.approx(2.0 * one(motion) + 3.0 * other(motion))
    with pytest.raises(ValueError, match="must not be negative"):
        -1.0 * one


@pytest.mark.long
def test_grashof_and_full_crank():
    """Norton's linkage is a crank-rocker; lengthening the crank beyond 60 makes it a triple rocker."""
    mechanism = planar_fourbar(START)
    for crank, turns in ((40.0, True), (59.0, True), (61.0, False)):
        motion = mechanism.with_lengths({KEYS[1]: crank}).sweep({"A": TURN})
        assert (np.min(design.full_crank(*KEYS)(motion, {})) >= 0) == turns
        backwards = [(part, *joints[::-1]) for part, *joints in KEYS]
        assert (np.min(design.grashof(*backwards)(motion, {})) >= 0) == turns  # either end of a bar may come first
        assert bool(np.all(motion.closed)) == turns


def test_box_and_sequence(motion):
    path = np.asarray(motion.points("coupler", POINT))
    lower, upper = path.min(axis=0) - 1e-9, path.max(axis=0) + 1e-9
    assert np.min(design.in_box("coupler", POINT, lower, upper)(motion, {})) >= 0
    assert np.min(design.in_box("coupler", POINT, lower + [0.1, 0, 0], upper)(motion, {})) < 0
    assert np.min(design.in_sequence("A")(motion, {})) >= 0
    assert np.min(design.in_sequence("A", least=0.3)(motion, {})) < 0
    assert np.min(design.above("D", -0.2)(motion, {})) >= 0  # the rocker goes back by 0.1506
    assert np.min(design.above("D", -0.1)(motion, {})) < 0


def test_every_objective_is_drawn(motion):
    from matplotlib.figure import Figure

    own = np.asarray(motion.points("coupler", POINT))[:, :2]
    for objective in (
        design.path("coupler", POINT, own),
        design.function("D", TURN),
        design.guidance("coupler", POINT, np.column_stack([own, TURN]), size=1.0),
        design.transmission("C", ("B", "D")),
        design.stroke_of("D", 1.0),
        design.dwell("D", [1, 2, 3]),
    ):
        axes = Figure().subplots()
        objective.plot(axes, motion, color="C1")
        assert axes.has_data()


@pytest.mark.long
def test_the_penalty_is_the_closure_residual_and_its_derivative():
    """Where a four-bar cannot close, least residuals fall as the coupler grows: the slope against differences."""
    mechanism = planar_fourbar(START, ground=40.0, crank=20.0, coupler=25.0, rocker=30.0)
    inputs = jnp.linspace(0.0, 3.0, 20)

    def gaps(coupler):
        motion = mechanism.with_lengths({("coupler", "B", "C"): coupler}).sweep({"A": inputs})
        return closure_gaps(motion)

    motion = mechanism.sweep({"A": inputs})
    found, failed = np.asarray(gaps(25.0)), ~np.asarray(motion.closed)
    assert 0 < failed.sum() < len(failed)
    np.testing.assert_array_equal(found > 0, failed)
    assert np.all(found <= np.asarray(motion.residual) * (1 + 1e-9))  # rotations count by half here
    slope, step = jax.jvp(gaps, (25.0,), (1.0,))[1], 1e-3
    numeric = (gaps(25.0 + step) - gaps(25.0 - step)) / (2 * step)
    # a least residual is found to about 1e-6 of itself: it is flat there, its slope is not
    np.testing.assert_allclose(slope, numeric, rtol=1e-3, atol=1e-6)


def test_bad_objectives(motion):
    with pytest.raises(ValueError, match=r"shape \(poses, 2\), got shape \(3, 3\)"):
        design.path("coupler", POINT, np.zeros((3, 3)))
    with pytest.raises(ValueError, match="3 targets but 30 poses"):
        design.path("coupler", POINT, np.zeros((3, 2)))(motion)
    with pytest.raises(ValueError, match="no part 'couplr'; did you mean"):
        design.path("couplr", POINT, np.zeros((30, 2)))(motion)
    with pytest.raises(ValueError, match="no joint 'Q'"):
        design.function("Q", TURN)(motion)
    with pytest.raises(ValueError, match="'A' is on neither of the links"):
        design.transmission_angle(motion, "C", ("A", "D"))
    with pytest.raises(ValueError, match="must be one positive number"):
        design.stroke_of("D", -1.0)
    with pytest.raises(ValueError, match="at least two poses"):
        design.dwell("D", [1])
    with pytest.raises(ValueError, match="crnk"):
        design.grashof(("crnk", "A", "B"), *KEYS[1:])(motion, {})
    with pytest.raises(ValueError, match="four bars"):
        design.grashof(KEYS[0])


GOOD = {
    "path": {"part": "coupler", "point": POINT, "targets": np.zeros((30, 2)), "timing": True, "placement": None},
    "function": {"joint": "D", "targets": TURN, "relative": True},
    "guidance": {"part": "coupler", "point": POINT, "targets": np.zeros((30, 3)), "size": 1.0},
    "transmission": {"joint": "C", "ends": ("B", "D"), "beyond": 0.1},
    "stroke_of": {"joint": "D", "wanted": 1.0},
    "dwell": {"joint": "D", "poses": [1, 2, 3]},
    "full_crank": dict(zip(("ground", "crank", "coupler", "rocker"), KEYS, strict=True)),
    "transmission_within": {"joint": "C", "ends": ("B", "D"), "least": 0.5, "largest": 2.0},
    "in_box": {"part": "coupler", "point": POINT, "lower": (0, 0, -1), "upper": (90, 90, np.inf)},
    "in_sequence": {"joint": "A", "least": 0.0},
    "above": {"joint": "D", "least": 0.5, "size": 1.0},
}
"""Arguments of every function that makes an objective or a constraint."""

WRONG = (None, np.nan, -7.0, "Q", (), (np.nan, 0.0), np.zeros((5, 3)), lambda x: x, {}, ("A", "D"), ["crank", "A", "Q"])


@pytest.mark.parametrize("name", GOOD)
def test_wrong_arguments_are_refused_in_words(name, motion):
    """No argument may end in an error of Python's or numpy's own, or in numbers that are none."""
    make = getattr(design, name)
    assert np.all(np.isfinite(make(**GOOD[name])(motion, {})))
    # a search traces the numbers of an objective: no check may look at them there
    jax.eval_shape(lambda found: found(motion, {}), make(**GOOD[name]))
    for argument in GOOD[name]:
        for wrong in WRONG:
            try:
                found = make(**(GOOD[name] | {argument: wrong}))(motion, {})
            except ValueError as error:
                raised = traceback.extract_tb(error.__traceback__)[-1]
                assert "jaxkin" in raised.filename, f"{argument} = {wrong!r}: {error}"
                continue
            assert np.all(np.isfinite(found)), (argument, wrong)


def test_refused_arguments_say_what_to_give(motion):
    for make, message in (
        (lambda: design.in_sequence("D")(motion, {}), r"'D.phi' is not driven; .*A.phi"),
        (lambda: design.in_box("coupler", POINT, (0, 0), (4, 4)), r"lower must be three numbers \(x, y, z\), -inf"),
        (lambda: design.in_box("coupler", POINT, 3, 4), "lower must be three numbers"),
        (lambda: design.transmission_within("D", 0.7, 2.4), r"ends must name the joint .* as in \('B', 'D'\), got 0.7"),
        (lambda: design.transmission_within("D", ("A", "C"), 40), r"from 0 to 3.14159 radians \(np.radians"),
        (lambda: design.function("D", lambda x: x), r"one a pose, such as f\(angles\) for a drive by angles"),
        (lambda: design.path("coupler", POINT, np.zeros((30, 2)), components=(0, 5)), "some of 0, 1, 2"),
        (
            lambda: design.path("coupler", "P", np.zeros((30, 2)))(motion, {"Q": POINT}),
            "no extra variable .P.; there",
        ),
        (lambda: design.guidance("coupler", POINT, np.zeros((1, 3)), size=1.0)(motion), "1 targets but 30 poses"),
        (lambda: design.dwell("D", [1, 30])(motion), "pose 30 is named, the motion has 30"),
        (lambda: design.dwell("D", np.ones(5, bool))(motion), "a mask of 5 poses, the motion has 30"),
        (lambda: design.transmission_angle(motion, "C", ("B", "A")), "'A' is on neither"),
        (lambda: design.transmission_angle(motion, "C", ("B", "C")), "two other joints"),
    ):
        with pytest.raises(ValueError, match=message):
            make()


def test_a_name_that_another_begins_with_is_not_taken_for_it():
    """`in_sequence("A")` judges A, not A2, whichever is driven first."""
    turning = {"A2": "wheel", "A": "crank"}
    joints = [jk.revolute(name, "ground", part, point=(0, 0, 0), axis=(0, 0, 1)) for name, part in turning.items()]
    motion = jk.Mechanism.build(fixed=["ground"], joints=joints).sweep({"A2": -TURN, "A": TURN})
    assert np.min(design.in_sequence("A")(motion, {})) >= 0 > np.max(design.in_sequence("A2")(motion, {})[:-1])


def test_a_box_of_one_side_has_finite_values(motion):
    found = design.in_box("coupler", POINT, (-np.inf, 10.0, -np.inf), (np.inf,) * 3)(motion, {})
    np.testing.assert_allclose(found, np.asarray(motion.points("coupler", POINT))[:, 1] - 10.0, atol=1e-12)  # rounding
