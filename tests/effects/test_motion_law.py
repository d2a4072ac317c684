"""Motion laws against their published peaks; jerks and screw axes against closed forms."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.motion_law import LAWS
from jaxkin.examples import path

Z = (0.0, 0.0, 1.0)
PEAKS = {
    "harmonic": (np.pi / 2, np.pi**2 / 2),
    "cycloidal": (2.0, 2 * np.pi),
    "3-4-5": (15 / 8, 10 / np.sqrt(3)),
    "4-5-6-7": (35 / 16, 7.5132),
    "modified sine": (1.7596, 5.5280),
    "modified trapezoid": (2.0, 4.8881),
    "s-curve": (8 / 5, 32 / 5),
}
"""Largest velocity and acceleration for a unit rise in a unit of time (R. L. Norton, Cam Design and Manufacturing
Handbook, Table 3-1, four decimals); of the s-curve, whose ramps are eighths, from its areas."""


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in LAWS if name != "dwell"])
def test_a_law_rises_from_rest_to_rest_evenly(name):
    """Half the way is half the time, and the rates are symmetric."""
    law = jk.motion_law([(name, 1.0, 1.0)])
    times = np.linspace(0, 1, 801)
    rise = np.asarray(law(times))
    np.testing.assert_allclose(rise[[0, 400, 800]], [0, 0.5, 1], atol=1e-14)
    np.testing.assert_allclose(rise + rise[::-1], 1.0, atol=1e-13)
    assert np.all(np.diff(rise) > 0)
    if name in PEAKS:
        most = [float(jnp.abs(law(times, order)).max()) for order in (1, 2)]
        np.testing.assert_allclose(most, PEAKS[name], rtol=2e-4)  # four decimals, and 801 samples of a smooth peak


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in PEAKS if name != "harmonic"])
def test_velocity_and_acceleration_are_continuous(name):
    """From rest, through the stages of a law, to rest: within the largest jerk times the distance of two samples."""
    law = jk.motion_law([("dwell", 0.2), (name, 1.0, 1.0), ("dwell", 0.2)])
    times = law.times(14001)
    for order in (1, 2):
        jumps = np.abs(np.diff(np.asarray(law(times, order)))).max()
        assert jumps < 1.2 * float(jnp.abs(law(times, order + 1)).max()) * 1e-4


@pytest.mark.long
def test_derivatives_are_those_of_the_displacement():
    law = jk.motion_law([("modified sine", 0.5, 2.0), ("dwell", 0.25), ("4-5-6-7", 1.0, -2.0)], start=0.3)
    times, step = np.array([0.1, 0.3, 0.6, 0.9, 1.6]), 1e-5
    for order in (0, 1, 2):
        difference = (law(times + step, order) - law(times - step, order)) / (2 * step)
        np.testing.assert_allclose(difference, law(times, order + 1), atol=1e-6)  # the square of the step, times s''''
    assert float(law([9.0])[0]) == pytest.approx(0.3) and float(law([9.0], 1)[0]) == 0.0
    assert law.duration == 1.75 and "velocity" in str(law)
    np.testing.assert_allclose(jax.grad(lambda t: law(t[None])[0])(jnp.asarray(0.3)), law([0.3], 1)[0], rtol=1e-12)


@pytest.mark.long
def test_one_time_is_as_many_and_has_a_gradient():
    law = jk.motion_law([("cycloidal", 1.0, 2.0)])
    np.testing.assert_allclose(law(0.3), law([0.3])[0], atol=1e-15)
    np.testing.assert_allclose(jax.vmap(jax.grad(law))(law.times(5)), law(law.times(5), order=1), atol=1e-14)


@pytest.mark.parametrize(
    ("segments", "infinite"),
    [
        ([("cycloidal", 1.0, 1.0)], [False, False, False]),
        ([("3-4-5", 1.0, 1.0), ("dwell", 0.2), ("4-5-6-7", 0.01, -1.0)], [False, False, False]),
        ([("harmonic", 1.0, 1.0), ("harmonic", 1.0, -1.0)], [False, False, True]),
        ([("dwell", 0.5), ("constant speed", 1.0, 2.0), ("dwell", 0.5)], [False, True, True]),
    ],
)
@pytest.mark.parametrize("x64", [True, False])
def test_what_jumps_has_an_infinite_derivative(segments, infinite, x64):
    """A harmonic law begins and ends with an acceleration, a constant speed with a velocity."""
    with jax.enable_x64(x64):
        law = jk.motion_law(segments)
        assert np.isinf(law.largest()).tolist() == infinite
        assert ("infinite" in str(law)) == any(infinite)


def test_a_law_is_drawn_and_saved(tmp_path):
    law = jk.motion_law([("cycloidal", 1.0, 1.0), ("dwell", 0.5)])
    assert law.plot(tmp_path / "law.png").stat().st_size > 10_000
    table = np.genfromtxt(law.save(tmp_path / "law.csv", poses=7), delimiter=",", names=True)
    for order, name in enumerate(("displacement", "velocity", "acceleration", "jerk")):
        np.testing.assert_allclose(table[name], law(table["time_s"], order), rtol=1e-12, atol=1e-12)


def test_traced_numbers_of_a_law_are_refused():
    with pytest.raises(ValueError, match=r"segment 1: its numbers are traced.*multiply what it returns"):
        jax.grad(lambda rise: jk.motion_law([("cycloidal", 1.0, rise)])(0.3))(1.0)


@pytest.mark.long
@pytest.mark.parametrize(
    ("segments", "said"),
    [
        ([("cycloid", 1.0, 1.0)], "segment 1: the law must be one of .*, got 'cycloid'; did you mean 'cycloidal'"),
        (
            [("dwell", 1.0), ("harmonic", 1.0)],
            r"segment 2: expected \('harmonic', duration, rise\) with finite numbers",
        ),
        ([("dwell", 1.0, 2.0)], r"expected \('dwell', duration\)"),
        ([("harmonic", -1.0, 2.0)], "its duration must be positive, got -1.0"),
        ([("harmonic", "1", 2.0)], r"expected \('harmonic', duration, rise\) with finite numbers"),
        ([("harmonic", 1.0, 1j)], r"expected \('harmonic', duration, rise\) with finite numbers"),
        ([], "at least one segment"),
    ],
)
def test_laws_that_are_none(segments, said):
    with pytest.raises(ValueError, match=said):
        jk.motion_law(segments)


def test_a_time_that_is_not_known_has_no_displacement():
    law = jk.motion_law([("3-4-5", 1.0, 2.0)], start=5.0)
    np.testing.assert_array_equal(law([-1.0, np.nan, 2.0]), [5.0, np.nan, 7.0])
    assert np.isnan(law(np.nan, 1))
    with pytest.raises(ValueError, match="the times of a motion law must be numbers, got 'x'"):
        law("x")


@pytest.mark.long
def test_the_jerk_of_a_crank_pin_and_of_its_part():
    """For an angle a(t): p''' = (a''' - a'^3) t + 3 a' a'' n with the tangent t and the inward normal n, times r."""
    arm = jk.Mechanism.build(fixed=["g"], joints=[jk.revolute("A", "g", "arm", point=(0, 0, 0), axis=Z)])
    motion = arm.sweep({"A": np.array([0.0, 0.7])})
    found = jk.jerks(motion, {"A": 2.0}, {"A": 3.0}, {"A": 5.0})
    angle = np.array([0.0, 0.7])
    tangent = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    outward = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    wanted = 1.5 * ((5.0 - 2.0**3) * tangent - 3 * 2.0 * 3.0 * outward)
    np.testing.assert_allclose(found.points("arm", (1.5, 0, 0)), wanted, atol=1e-12)
    np.testing.assert_allclose(found.angular("arm"), [[0, 0, 5.0]] * 2, atol=1e-12)
    np.testing.assert_allclose(found.coordinates["A"], 5.0)


@pytest.mark.long
def test_angular_jerks_in_space_are_the_rates_of_angular_accelerations():
    joints = [
        jk.revolute("A", "g", "a", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "a", "b", point=(1, 0, 0), axis=(0, 1, 0.3)),
    ]
    arm = jk.Mechanism.build(fixed=["g"], joints=joints)
    rates, changes, step = {"A": 1.1, "B": -0.8}, {"A": 0.4, "B": 0.9}, 1e-5
    angles = {name: np.array([-step, 0.0, step]) for name in rates}
    place = {name: 0.3 + rates[name] * t + changes[name] * t**2 / 2 for name, t in angles.items()}
    motion = arm.sweep(place)
    now = {name: rates[name] + changes[name] * t for name, t in angles.items()}
    alpha = jk.accelerations(motion, now, changes).angular("b")
    jerk = jk.jerks(motion, now, changes).angular("b")
    np.testing.assert_allclose((alpha[2] - alpha[0]) / (2 * step), jerk[1], atol=1e-8)


@pytest.mark.long
def test_the_centrodes_of_a_double_slider_are_the_circles_of_cardano():
    """A rod of length L with its ends on two perpendicular lines: radius L about the corner, and L/2 on the rod."""
    length, start = 2.0, 0.6
    ends = np.array([[length * np.cos(start), 0, 0], [0, length * np.sin(start), 0]])
    joints = [
        jk.prismatic("x", "g", "low", axis=(1, 0, 0), point=ends[0]),
        jk.revolute("a", "low", "rod", point=ends[0], axis=Z),
        jk.revolute("b", "rod", "high", point=ends[1], axis=Z),
        jk.prismatic("y", "g", "high", axis=(0, 1, 0), point=ends[1]),
    ]
    rod = jk.Mechanism.build(fixed=["g"], joints=joints)
    motion = rod.sweep({"x": np.linspace(-0.5, 0.2, 8)}, throw=True)
    axes = jk.screw_axes(jk.velocities(motion, {"x": 1.0}), "rod")
    np.testing.assert_allclose(np.linalg.norm(axes.point, axis=1), length, atol=1e-12)
    middle = ends.mean(axis=0)
    np.testing.assert_allclose(np.linalg.norm(axes.moving - middle, axis=1), length / 2, atol=1e-12)
    np.testing.assert_allclose(axes.pitch, 0, atol=1e-12)
    back = (
        np.einsum("pij,pj->pi", motion.transforms["rod"][:, :3, :3], axes.moving) + motion.transforms["rod"][:, :3, 3]
    )
    np.testing.assert_allclose(back, axes.point, atol=1e-12)


@pytest.mark.long
def test_a_screw_has_its_own_axis_and_pitch():
    nut = jk.Mechanism.build(fixed=["g"], joints=[jk.screw("S", "g", "nut", point=(1, 2, 0), axis=Z, pitch=0.5)])
    axes = jk.screw_axes(jk.velocities(nut.sweep({"S": np.array([0.0, 2.0])}), {"S": np.array([3.0, 0.0])}), "nut")
    np.testing.assert_allclose(axes.point[0], [1, 2, 0], atol=1e-14)
    np.testing.assert_allclose([axes.pitch[0], axes.direction[0, 2]], [0.5 / (2 * np.pi), 1.0], rtol=1e-14)
    assert np.isnan(axes.point[1]).all()  # it rests
    np.testing.assert_allclose(axes.angular_speed, [3.0, 0.0], rtol=1e-14)


@pytest.mark.parametrize("x64", [True, False])
@pytest.mark.parametrize(
    ("law", "share", "peaks"),
    [
        ("cycloidal", 1e-4, (2, 2 * np.pi, 4 * np.pi**2)),
        ("s-curve", 1e-3, (1.6, 6.4, 51.2)),
        ("3-4-5", 1e-5, (15 / 8, 10 / np.sqrt(3), 60)),
        ("constant speed", 1e-4, (1, np.inf, np.inf)),
        ("harmonic", 1e-3, (np.pi / 2, np.pi**2 / 2, np.inf)),
    ],
)
def test_the_largest_rates_of_a_short_rise_between_long_dwells(law, share, peaks, x64):
    """Textbook coefficients, over the duration to the power of the order: 2001 times of a segment miss 1e-6 of them."""
    with jax.enable_x64(x64):
        found = jk.motion_law([("dwell", 1.0), (law, share, 0.5), ("dwell", 1.0)]).largest()
    expected = [0.5 * peak / share**order for order, peak in enumerate(peaks, start=1)]
    np.testing.assert_allclose(found, expected, rtol=2e-6)


@pytest.mark.parametrize("x64", [True, False])
def test_gradients_far_from_a_short_rise_are_numbers(x64):
    """Ten million times its duration, to the sixth power, is beyond single precision: in the dwell they are zeros."""
    with jax.enable_x64(x64):
        law = jk.motion_law([("4-5-6-7", 1e-3, 1.0), ("dwell", 1e4)])
        for order in range(3):
            assert jax.grad(partial(law, order=order))(9e3) == 0.0


@pytest.mark.parametrize("poses", [2.5, None, "a", -3])
def test_times_are_a_whole_number(poses):
    with pytest.raises(ValueError, match="poses must be a whole number, 0 or more"):
        jk.motion_law([("harmonic", 1.0, 1.0)]).times(poses)


def test_screw_axes_print_their_ranges_and_where_there_are_none():
    nut = jk.Mechanism.build(
        fixed=["g"], unit="mm", joints=[jk.screw("S", "g", "nut", point=(1, 2, 0), axis=Z, pitch=0.5)]
    )
    motion = nut.sweep({"S": np.array([0.0, 2.0, 3.0, np.nan, 1.0])})
    axes = jk.screw_axes(jk.velocities(motion, {"S": np.array([3.0, 0.0, -1.0, 1.0, np.nan])}), "nut")
    assert str(axes).splitlines() == [
        "Screw axes of nut over 5 poses, 3 of them with rates",
        "  angular speed [rad/time]: from 1 at pose 2 to 3 at pose 0",
        "  pitch [mm/rad]: 0.07958",  # 0.5 mm a turn
        "  only slides or rests in 1 of 5 poses, first at pose 1: no axis there",
    ]


@pytest.mark.long
def test_a_part_that_turns_in_a_tilted_plane_has_no_pitch():
    """Rounding made it 1e-11 mm a radian, from one pose to another."""
    motion = jk.load(path("fourbar")).mechanism(fixed=["ground"]).sweep({"ground-crank": np.linspace(0, 6, 31)})
    axes = jk.screw_axes(jk.velocities(motion, {"ground-crank": 20.0}), "coupler")
    assert 0 < np.abs(axes.pitch).max() < 1e-8
    assert "  pitch [mm/rad]: 0 but for rounding" in str(axes).splitlines()


@pytest.mark.long
def test_the_coupler_of_a_parallelogram_has_no_screw_axis():
    """It slides on circles: what rounding turns it by is no axis."""
    places = {"A": (0, 0, 0), "B": (10, 3, 0), "C": (42, 3, 0), "D": (32, 0, 0)}
    pairs = {"A": ("g", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker"), "D": ("g", "rocker")}
    joints = [jk.revolute(name, *pairs[name], point=place, axis=Z) for name, place in places.items()]
    motion = jk.Mechanism.build(fixed=["g"], joints=joints).sweep({"A": np.linspace(0.0, 1.0, 11)}, throw=True)
    velocities = jk.velocities(motion, {"A": 2.0})
    axes = jk.screw_axes(velocities, "coupler")
    assert np.isnan(axes.point).all() and np.all(np.asarray(axes.angular_speed) == 0)
    assert "only slides or rests in 11 of 11 poses" in str(axes)
    np.testing.assert_allclose(jk.screw_axes(velocities, "rocker").angular_speed, 2.0, rtol=1e-12)


def test_accelerations_have_no_screw_axes():
    """Taken for velocities they would give axes, and wrong ones."""
    hinge = jk.revolute("A", "g", "coupler", point=(0, 0, 0), axis=Z)
    motion = jk.Mechanism.build(fixed=["g"], joints=[hinge]).sweep({"A": np.linspace(0.0, 1.0, 3)})
    for order, rates in ((2, jk.accelerations), (3, jk.jerks)):
        with pytest.raises(
            ValueError, match=f"screw axes are those of jk.velocities.*got derivatives of order {order}"
        ):
            jk.screw_axes(rates(motion, {"A": 1.0}), "coupler")
