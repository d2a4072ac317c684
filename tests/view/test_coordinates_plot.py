"""The chart of a motion: which coordinates are drawn, in which units, over what."""

import numpy as np
import pytest

from jaxkin.effects import pose_plot
from reference.mechanisms import planar_fourbar, slider_crank


@pytest.fixture
def drawn(monkeypatch):
    """The figures that would be written."""
    figures = []
    monkeypatch.setattr(pose_plot, "save_figure", lambda figure, path: figures.append(figure) or path)
    return figures


def charted(motion, drawn, tmp_path):
    from jaxkin.view.coordinates_plot import draw_coordinates

    draw_coordinates(motion, tmp_path / "coordinates.png")
    return [(axes, {line.get_label(): line for line in axes.lines[:-1]}) for axes in drawn[-1].axes]


def test_a_stroke_is_drawn_over_the_crank_in_degrees(drawn, tmp_path):
    mechanism = slider_crank()
    crank = next(iter(mechanism.joints))
    motion = mechanism.sweep({crank: np.linspace(0, np.pi, 7)})
    panels = charted(motion, drawn, tmp_path)
    assert {axes.get_ylabel() for axes, _ in panels} == {"displacement (deg)", "displacement"}
    assert {axes.get_xlabel() for axes, _ in panels} == {f"{crank} (deg)"}
    lines = {name: line for _, each in panels for name, line in each.items()}
    np.testing.assert_allclose(lines[f"{crank}.phi"].get_ydata(), np.linspace(0, 180, 7))
    (slide,) = [joint for joint in mechanism.all_joints if joint.kind.value == "prismatic"]
    np.testing.assert_allclose(lines[slide.full_names[0]].get_ydata(), motion.coordinates[slide.name][:, 0])
    np.testing.assert_allclose(lines[slide.full_names[0]].get_xdata(), np.linspace(0, 180, 7))


def test_a_drive_that_turns_back_is_drawn_over_the_poses(drawn, tmp_path):
    motion = planar_fourbar().sweep({"A": np.array([0.0, 0.1, 0.05])})
    ((axes, _),) = charted(motion, drawn, tmp_path)
    assert axes.get_xlabel() == "pose"


def test_what_rests_and_what_is_not_closed_is_not_drawn(drawn, tmp_path):
    from jaxkin.joints.pairs import cylindrical

    motion = planar_fourbar(pin=cylindrical).sweep({"D.phi": np.linspace(0, 3, 31)})
    assert 0 < motion.closed.sum() < 31
    ((_, lines),) = charted(motion, drawn, tmp_path)
    assert {name.rpartition(".")[2] for name in lines} == {"phi"}, "the pins do not slide"
    for line in lines.values():
        np.testing.assert_array_equal(np.isfinite(line.get_ydata()), motion.closed)


@pytest.mark.parametrize("values", [[], [0.0], [np.nan, np.nan]])
def test_motions_of_which_nothing_moves_are_drawn(values, drawn, tmp_path):
    motion = planar_fourbar().sweep({"A": np.array(values, float)})
    ((axes, _),) = charted(motion, drawn, tmp_path)
    assert axes.get_title() == "nothing moves"
