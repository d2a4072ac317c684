"""Lines over the poses of a motion, as they are drawn."""

from pathlib import Path

import numpy as np

from jaxkin.effects import pose_plot


def test_what_is_known_at_one_pose_only_is_a_dot_within_all_poses(monkeypatch):
    """A line needs two poses: without a marker a clearance known at one pose would not be seen."""
    drawn = []
    monkeypatch.setattr(pose_plot, "save_figure", lambda figure, path: drawn.append(figure) or path)
    rows = np.full((2, 7), np.nan)
    rows[0, 3], rows[1, 2:5], rows[1, 6] = 0.5, 1.0, 2.0
    pose_plot.draw_lines(["alone", "both"], rows, "clearance (mm)", "no clash", Path("clashes.png"))
    axes = drawn[0].axes[0]
    alone, both = axes.lines[:2]
    assert (alone.get_marker(), alone.get_markevery()) == ("o", [3])
    assert both.get_markevery() == [6]
    low, high = axes.get_xlim()
    assert low <= 0 and high >= 6
