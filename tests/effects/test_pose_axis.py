"""What charts of effects are drawn over: the input that moves the mechanism, in the unit that people read."""

import re

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects import pose_plot
from jaxkin.effects.pose_axis import drive_axis
from reference.mechanisms import Z, planar_fourbar, slider_crank
from reference.planar_robots import five_bar

ANGLES = np.linspace(0.0, 1.0, 5)


@pytest.fixture
def drawn(monkeypatch):
    """The figures that would be written."""
    figures = []
    monkeypatch.setattr(pose_plot, "save_figure", lambda figure, path: figures.append(figure) or path)
    return figures


@pytest.fixture(scope="module")
def motion():
    return jk.load(jk_example()).mechanism(fixed=["ground"]).sweep({"ground-crank": ANGLES})


def jk_example():
    from jaxkin.examples import path

    return path("fourbar")


EFFECTS = {
    "rates": lambda motion: jk.accelerations(motion, {"ground-crank": 2.0}),
    "drive forces": lambda motion: jk.drive_forces(motion, jk.masses(motion.mechanism, "steel")),
    "reactions": lambda motion: jk.reactions(motion, jk.masses(motion.mechanism, "steel")),
    "transmission": lambda motion: jk.transmission(motion, "ground-rocker"),
    "clashes": jk.clashes,
    "contacts": jk.contact_validity,
    "equilibrium": lambda motion: jk.equilibrium(
        motion.mechanism, {"ground-crank": ANGLES}, jk.masses(motion.mechanism, "steel")
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("name", EFFECTS)
def test_effects_are_drawn_over_the_crank_in_degrees(name, motion, drawn, tmp_path):
    EFFECTS[name](motion).plot(tmp_path / "effect.png")
    for axes in drawn[0].axes:
        assert axes.get_xlabel() == "ground-crank (deg)"
        for line in axes.lines[:-1]:
            np.testing.assert_allclose(line.get_xdata(), np.rad2deg(ANGLES))


def test_equilibria_are_marked_where_the_curve_of_degrees_passes_zero(drawn, tmp_path):
    """The marks are on the axis of the curve: the slope there is that between its neighbours."""
    mechanism = jk.load(jk_example()).mechanism(fixed=["ground"])
    found = jk.equilibrium(mechanism, {"ground-crank": np.linspace(0, 2 * np.pi, 61)}, jk.masses(mechanism, "steel"))
    found.plot(tmp_path / "equilibria.png")
    curve, _, *marks = drawn[0].axes[0].lines
    at = np.sort([mark.get_xdata()[0] for mark in marks])
    x, y = curve.get_xdata(), curve.get_ydata()
    assert len(at) == 2
    for place in at:
        before = int(np.searchsorted(x, place)) - 1
        assert y[before] * y[before + 1] < 0


@pytest.mark.long
def test_a_follower_is_drawn_over_its_shaft(drawn, tmp_path):
    angle = 2 * np.pi * np.arange(40) / 40
    profile = np.stack([3 * np.cos(angle) + 0.5, 3 * np.sin(angle)], axis=1)
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.cam("contact", "cam", "follower", profile=profile, follower="roller", radius=1.0, point2=(0, 3.95, 0)),
            jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        ],
    )
    motion = mechanism.close(hold=["shaft"]).mechanism.sweep({"shaft": ANGLES})
    jk.curve_contacts(motion).plot(tmp_path / "contacts.png")
    assert drawn[0].axes[0].get_xlabel() == "shaft (deg)"


def test_lengths_have_the_unit_of_the_mechanism():
    mechanism = slider_crank()
    (slide,) = [joint.name for joint in mechanism.all_joints if joint.kind.value == "prismatic"]
    axis = drive_axis(mechanism.sweep({slide: np.linspace(0.0, -0.1, 3)}))
    assert axis is not None and axis.label == slide, "the unit of this mechanism is not known"
    np.testing.assert_allclose(axis.values, [0.0, -0.05, -0.1])


def test_texts_tell_poses_by_the_drive_too(motion):
    said = str(jk.velocities(motion, {"ground-crank": 2.0}))
    at = {int(pose): float(degrees) for pose, degrees in re.findall(r"at pose (\d) \(([-\d.]+) deg\)", said)}
    assert len(at) > 1
    assert all(degrees == pytest.approx(np.rad2deg(ANGLES[pose]), rel=1e-3) for pose, degrees in at.items())
    again = motion.mechanism.sweep({"ground-crank": np.array([0.0, 0.1, 0.0])})
    assert " deg)" not in str(jk.velocities(again, {"ground-crank": 2.0}))


@pytest.mark.parametrize("name", [name for name in EFFECTS if name != "equilibrium"])
def test_effects_are_drawn_over_times_that_are_given(name, motion, drawn, tmp_path):
    """A drive that rests or comes back does not tell its poses apart, and time does."""
    times = 0.25 * ANGLES
    EFFECTS[name](motion).plot(tmp_path / "effect.png", times=times)
    for axes in drawn[0].axes:
        assert axes.get_xlabel() == "time"
        for line in axes.lines[:-1]:
            np.testing.assert_allclose(line.get_xdata(), times)


@pytest.mark.parametrize("times", [np.zeros(4), np.zeros((5, 1)), 0.1, "now"])
def test_times_of_another_number_are_refused(times, motion, tmp_path):
    with pytest.raises(ValueError, match=r"times|one time for each of the 5 poses"):
        jk.velocities(motion, {"ground-crank": 1.0}).plot(tmp_path / "rates.png", times)
    assert not (tmp_path / "rates.png").exists()


@pytest.mark.parametrize("values", [[0.0, 0.1, 0.1], [0.0, 0.1, 0.05], [0.0, np.nan, 0.1], [0.1], []])
def test_a_drive_that_rests_or_turns_back_tells_no_poses_apart(values):
    assert drive_axis(planar_fourbar().sweep({"A": np.array(values, float)})) is None


def test_of_several_inputs_the_one_that_changes_is_drawn_over():
    mechanism, one, other = five_bar(100.0), "A", "E"
    held = drive_axis(mechanism.sweep({one: np.zeros(3), other: np.array([0.0, 0.1, 0.2])}))
    assert held is not None and held.label == f"{other} (deg)"
    assert drive_axis(mechanism.sweep({one: np.array([0.0, 0.1, 0.2]), other: np.array([0.0, 0.1, 0.2])})) is None
