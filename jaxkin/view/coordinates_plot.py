"""`coordinates.png`: the displacements of the joints of a motion over its drive."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.effects.pose_axis import drive_axis
from jaxkin.effects.pose_plot import draw_lines
from jaxkin.geometry.movements import is_length
from jaxkin.view.labels import headline

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

_REST = 1e-9
"""Range of a coordinate, in radians or over that of the largest length, up to which it is at rest, and not drawn."""


def draw_coordinates(motion: Motion, path: Path) -> None:
    """Draw the coordinates that move into a picture file, degrees and lengths on axes of their own.

    They are drawn over the drive where that is one displacement which only rises or only falls, else over the poses;
    those of poses that are not on the branch are left out.
    """
    names, lengths = [], []
    for joint in motion.mechanism.all_joints:
        names += joint.full_names
        lengths += map(is_length, joint.coordinates)
    rows = np.concatenate([np.asarray(each, float) for each in motion.displacements], axis=1).T
    known = np.asarray(motion.on_branch) & np.isfinite(rows).all(axis=0)
    rows[:, ~known] = np.nan
    ranges = np.ptp(rows[:, known], axis=1) if known.any() else np.zeros(len(rows))
    of_lengths = np.array(lengths, bool)
    scales = np.where(of_lengths, ranges[of_lengths].max(initial=0.0), 1.0)
    moving = np.flatnonzero(ranges > _REST * scales)
    unit = motion.mechanism.unit
    label = {True: f"displacement ({unit})" if unit else "displacement", False: "displacement (deg)"}
    shown = np.where(of_lengths, 1.0, 180.0 / np.pi)[:, None] * rows
    labels = [label[lengths[k]] for k in moving]
    title = headline(motion)[0] if len(moving) else "nothing moves"
    draw_lines(
        [names[k] for k in moving], shown[moving], labels or "displacement", title, path, axis=drive_axis(motion)
    )
