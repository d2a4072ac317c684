"""Clearances and clashes of parts along a motion: printed, drawn and saved."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._grouped import MAX_LINES
from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import NAMED, draw_lines, save_rows
from jaxkin.mechanism.motion import Motion

_SAME_LENGTH = 1e-6
"""Share of a length by which another one may differ and be told as the same: lengths are printed with four digits."""
_NO_LENGTH = 1e-9
"""Share of `within` below which lengths are told as the same: poses are closed up to a residual."""


@dataclass(frozen=True, eq=False, repr=False)
class Clashes(Result):
    """The clearance of each two parts that come near each other, at each pose. Prints, draws and saves itself."""

    motion: Motion
    """The motion that was looked at."""
    pairs: tuple[tuple[str, str], ...]
    """Parts of different bodies that come nearer than `within` at some pose."""
    joined: Bool[np.ndarray, " pairs"]
    """Which pairs touch by a contact that a joint stands for."""
    clearances: Float[np.ndarray, "pairs poses"]
    """Least distance of the two parts, in the unit of the mechanism; less than 0 where they cut each other: then it is
    the depth, with a minus. Infinite where it is more than `within`, 0 where joined parts do not clash, NaN at poses
    that are not closed (`motion.closed`)."""
    closed: Bool[np.ndarray, " poses"]
    """Which poses are closed: of the others nothing is known."""
    within: float
    """Up to which clearance it was measured."""
    unit: str
    """Unit of the lengths."""
    step: float = 0.0
    """Farthest that a point of a part moves from one closed pose to the next: parts that stay farther apart than that
    cannot cut each other between two poses, which are not looked at."""

    @property
    def depths(self) -> Float[np.ndarray, "pairs poses"]:
        """How deep parts are in each other: 0 where they do not clash, NaN at poses that are not closed."""
        return np.maximum(-self.clearances, 0.0)

    @property
    def clashing(self) -> Bool[np.ndarray, "pairs poses"]:
        """Which pairs clash at which poses."""
        return self.clearances < 0

    @property
    def first(self) -> tuple[int, int] | None:
        """The first pose with a clash, and the index of the pair, that of the deepest clash there; None without one."""
        if not self.clashing.any():
            return None
        pose = int(np.argmax(self.clashing.any(axis=0)))
        return pose, int(np.argmin(np.nan_to_num(self.clearances[:, pose])))

    @property
    def least(self) -> Float[np.ndarray, " poses"]:
        """The least clearance of each pose among the pairs that are not joined, and those that clash; NaN at poses that
        are not closed."""
        free = np.where(self.joined[:, None] & (self.clearances >= 0), np.inf, self.clearances)
        return np.where(self.closed, np.min(free, axis=0, initial=np.inf), np.nan)

    def __str__(self) -> str:
        poses, known = len(self.closed), int(self.closed.sum())
        if not known:
            return f"none of {poses} poses is closed: whether parts clash is not known"
        named = pose_names(self.motion)
        clash = np.flatnonzero(self.clashing.any(axis=1)).tolist()
        told = f"{known} closed poses of {poses}" if known < poses else counted(poses, "pose")
        count = "1 pair of parts comes" if len(self.pairs) == 1 else f"{len(self.pairs)} pairs of parts come"
        lines = [f"{count} near each other in {told}: {len(clash)} clash"]
        if known < poses:
            lines.append(f"  whether parts clash at the {poses - known} other poses is not known")
        if self.first is not None:
            pose, pair = self.first
            lines.append(f"  first at {named(pose)}: {self._named(pair)}, {self._length(self.depths[pair, pose])} deep")
        for pair in clash[:MAX_LINES]:
            row = np.nan_to_num(self.depths[pair])
            lines.append(
                f"  {self._named(pair)}: clash at {counted(np.sum(row > 0), 'pose')} from {named(np.argmax(row > 0))} "
                f"on, deepest {self._length(row.max())} at {named(self._first_at(row, row.max()))}"
            )
        free = [pair for pair in range(len(self.pairs)) if pair not in clash and not self.joined[pair]]
        least = {pair: np.where(np.isnan(self.clearances[pair]), np.inf, self.clearances[pair]) for pair in free}
        near = sorted((pair for pair in free if np.isfinite(least[pair]).any()), key=lambda pair: least[pair].min())
        for pair in near[:MAX_LINES]:
            row = least[pair]
            lines.append(
                f"  {self._named(pair)}: nearest {self._length(row.min())} at {named(self._first_at(row, row.min()))}"
            )
        left = max(0, len(clash) - MAX_LINES) + max(0, len(near) - MAX_LINES)
        if left:
            lines.append(f"  and {left} more pairs: see .pairs and .clearances")
        lines.append(f"  all others stay more than {self._length(self.within)} apart, or touch by contacts only")
        if self.step > min(self.within, float(np.nanmin(self.least))):
            lines.append(
                f"  between two poses parts move by up to {self._length(self.step)}: those that are nearer than that "
                "may cut each other there unseen; more poses tell"
            )
        return "\n".join(lines)

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw the clearances of the pairs that clash, or else of the nearest ones, over the drive or `times` into a
        picture file; returns its path."""
        lowest = np.where(np.isfinite(self.clearances), self.clearances, np.inf).min(axis=1, initial=np.inf)
        order = [int(pair) for pair in np.argsort(lowest) if lowest[pair] < 0 or not self.joined[pair]][:NAMED]
        label = f"clearance ({self.unit})" if self.unit else "clearance"
        title = "below 0: depth of a clash" if self.clashing.any() else "no clash" if self.closed.any() else "not known"
        if not self.closed.all():
            title += f"; {np.sum(~self.closed)} of {len(self.closed)} poses are not closed"
        names, axis = [self._named(pair) for pair in order], drive_axis(self.motion, times)
        return draw_lines(names, self.clearances[order], label, title, Path(path), axis=axis)

    def save(self, path: str | Path) -> Path:
        """Write the clearances as comma-separated values, a row a pose and a column a pair; returns the path."""
        names = [f"{self._named(pair)} [{self.unit or 'length'}]" for pair in range(len(self.pairs))]
        return save_rows(names, self.clearances, Path(path))

    def _named(self, pair: int) -> str:
        return " - ".join(self.pairs[pair])

    def _first_at(self, row: np.ndarray, value: float) -> int:
        """Find the first pose whose length is a given one but for rounding."""
        return int(np.argmax(np.abs(row - value) <= _SAME_LENGTH * abs(value) + _NO_LENGTH * self.within))

    def _length(self, value: float) -> str:
        return f"{value:.4g} {self.unit}".rstrip()
