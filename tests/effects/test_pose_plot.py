"""Numbers over the poses of a motion, as they are drawn and saved."""

import csv
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from jaxkin._files import save_figure
from jaxkin.effects import pose_plot


@pytest.fixture
def drawn(monkeypatch):
    """The figures that would be written."""
    figures = []
    monkeypatch.setattr(pose_plot, "save_figure", lambda figure, path: figures.append(figure) or path)
    return figures


def test_what_is_known_at_one_pose_only_is_a_dot_within_all_poses(drawn):
    """A line needs two poses: without a marker a clearance known at one pose would not be seen."""
    rows = np.full((2, 7), np.nan)
    rows[0, 3], rows[1, 2:5], rows[1, 6] = 0.5, 1.0, 2.0
    pose_plot.draw_lines(["alone", "both"], rows, "clearance (mm)", "no clash", Path("clashes.png"))
    axes = drawn[0].axes[0]
    alone, both = axes.lines[:2]
    assert (alone.get_marker(), alone.get_markevery()) == ("o", [3])
    assert both.get_markevery() == [6]
    low, high = axes.get_xlim()
    assert low <= 0 and high >= 6


def test_numbers_of_different_units_have_axes_of_their_own(drawn):
    """An angle of 0.1 is seen beside a length of 100."""
    rows = np.outer([100.0, 0.1, 50.0], np.linspace(0, 1, 5))
    pose_plot.draw_lines(["s", "phi", "t"], rows, ["(mm)", "(rad)", "(mm)"], "", Path("rates.png"))
    lengths, angles = drawn[0].axes
    assert [axes.get_ylabel() for axes in (lengths, angles)] == ["(mm)", "(rad)"]
    assert [line.get_label() for line in lengths.lines[:2]] == ["s", "t"]
    assert angles.lines[0].get_label() == "phi"
    assert angles.get_ylim()[1] < 1 < lengths.get_ylim()[1]


def test_of_many_lines_the_largest_are_named_and_told_apart(drawn):
    """The others are grey, and the legend says how many and how large they are."""
    sizes = np.arange(1.0, 41.0)[::-1]
    names = [f"joint {size:g}" for size in sizes]
    pose_plot.draw_lines(names, np.outer(-sizes, np.ones(4)), "force (N)", "", Path("forces.png"))
    (axes,) = drawn[0].axes
    handles, labels = axes.get_legend_handles_labels()
    assert labels == [*names[: pose_plot.NAMED], "28 others, 28 at most"]
    looks = {(to_hex(line.get_color()), line.get_linestyle()) for line in handles}
    assert len(looks) == pose_plot.NAMED + 1
    grey = [line for line in axes.lines if line.get_color() == "0.75"]
    assert len(grey) == 28 and all(line.get_zorder() < handles[0].get_zorder() for line in grey)


def test_a_turn_is_divided_into_eighths_and_poses_are_whole(drawn):
    rows = np.ones((1, 5))
    for axis in (pose_plot.PoseAxis(np.linspace(0, 360, 5), "A (deg)"), None):
        pose_plot.draw_lines(["a"], rows, "force (N)", "", Path("forces.png"), axis=axis)
    turn, poses = (figure.axes[0].get_xticks() for figure in drawn)
    assert {0, 45, 90, 360} <= {*turn.tolist()}
    assert np.all(poses == np.round(poses))


@pytest.mark.long
@pytest.mark.parametrize("letters", [4, 35, 90, 400])
def test_legends_of_long_names_are_within_the_picture(letters, drawn):
    """Joints of CAD systems have names of two parts each; the end of a name tells its coordinates apart."""
    names = [f"{'abcdefg <1>-' * (letters // 12)}hijk.{end}" for end in ("x", "y", "z", "phi")]
    pose_plot.draw_lines(names, np.outer([1, 2, 3, 4.0], np.ones(4)), ["a", "a", "a", "b"], "", Path("rates.png"))
    (figure,) = drawn
    figure.draw_without_rendering()
    for panel in figure.subfigs:
        (legend,) = panel.legends
        box = legend.get_window_extent()
        assert box.x0 >= 0 and box.x1 <= figure.bbox.x1
        told = [text.get_text() for text in legend.get_texts()]
        assert [each[-3:] for each in told] == [each[-3:] for each in (names[:3] if len(told) == 3 else names[3:])]


def test_labels_are_not_cut_off(tmp_path):
    """Three views of one scale, as of a swept volume: numbers along the first one need more room than at first."""
    x, y, z = (0.656, 5.958), (-1.585, 2.494), (-0.930, 5.596)
    figure = Figure(figsize=(11, 4.2), layout="constrained")
    for number, (across, up) in enumerate(((x, y), (x, z), (y, z))):
        axes = figure.add_subplot(1, 3, number + 1)
        axes.set(xlim=across, ylim=up, xlabel="x (in)", ylabel="y (in)")
        axes.set_aspect("equal")
    save_figure(figure, tmp_path / "views.png")
    assert min(axes.get_tightbbox().x0 for axes in figure.axes) >= 0


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_saved_numbers_and_names_are_read_back(dtype, tmp_path):
    names, rows = ['bolt 1/4"', "a, b"], np.array([[1 / 3, 1e-17, 7.0], [-0.1, np.nan, np.inf]], dtype)
    with pose_plot.save_rows(names, rows, tmp_path / "rows.csv").open(newline="", encoding="utf-8") as file:
        heading, *lines = csv.reader(file)
    assert heading == ["pose", *names] and lines[2] == ["2", "7", "inf"]
    assert np.array_equal(np.array(lines)[:, 1:].T.astype(dtype), rows, equal_nan=True)
