"""Find the parts that cut each other along a motion, and how near the others come, on their meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._arguments import check_known, check_motion, numbers, several
from jaxkin._grouped import MAX_LINES
from jaxkin._names import nearest
from jaxkin.assembly.joined import all_contacts
from jaxkin.effects.clash_shapes import ClashShape, boxes_along, displaced, largest_step, near_pairs, shape_of
from jaxkin.effects.invariant_faces import SAME_PLACE, invariant
from jaxkin.effects.penetration import depths
from jaxkin.effects.pose_plot import NAMED, draw_lines, save_rows
from jaxkin.effects.sampled_depths import sampled_depths
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.part import size
from jaxkin.geometry.tree_crossings import Slack, crossings
from jaxkin.geometry.tree_distances import distances
from jaxkin.mechanism.lost_contacts import FaceSetting
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion

WITHIN = 0.02
"""Clearance over the size of the mechanism up to which it is measured by default: what is farther away is no concern,
and costs nothing."""
_SAME_LENGTH = 1e-6
"""Share of a length by which another one may differ and be told as the same: lengths are printed with four digits."""
_NO_LENGTH = 1e-9
"""Share of `within` below which lengths are told as the same: poses are closed up to a residual."""
_AT_REST = 1e-12
"""Change of a displacement, over the size, below which two parts are at rest relative to each other: rounding."""


@dataclass(frozen=True, eq=False)
class Clashes:
    """The clearance of each two parts that come near each other, at each pose. Prints, draws and saves itself."""

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
        """How deep parts are in each other: 0 where they do not clash, NaN at poses that are not closed
        (`motion.closed`)."""
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
        clash = np.flatnonzero(self.clashing.any(axis=1)).tolist()
        told = f"{known} closed poses of {poses}" if known < poses else f"{poses} poses"
        lines = [f"{len(self.pairs)} pairs of parts come near each other in {told}: {len(clash)} clash"]
        if known < poses:
            lines.append(f"  whether parts clash at the {poses - known} other poses is not known")
        if self.first is not None:
            pose, pair = self.first
            lines.append(f"  first at pose {pose}: {self._named(pair)}, {self._length(self.depths[pair, pose])} deep")
        for pair in clash[:MAX_LINES]:
            row = np.nan_to_num(self.depths[pair])
            lines.append(
                f"  {self._named(pair)}: clash at {np.sum(row > 0)} poses from pose {np.argmax(row > 0)} on, deepest "
                f"{self._length(row.max())} at pose {self._first_at(row, row.max())}"
            )
        free = [pair for pair in range(len(self.pairs)) if pair not in clash and not self.joined[pair]]
        least = {pair: np.where(np.isnan(self.clearances[pair]), np.inf, self.clearances[pair]) for pair in free}
        near = sorted((pair for pair in free if np.isfinite(least[pair]).any()), key=lambda pair: least[pair].min())
        for pair in near[:MAX_LINES]:
            row = least[pair]
            lines.append(
                f"  {self._named(pair)}: nearest {self._length(row.min())} at pose {self._first_at(row, row.min())}"
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

    def plot(self, path: str | Path) -> Path:
        """Draw the clearances of the pairs that clash, or else of the nearest ones, into a picture file."""
        lowest = np.where(np.isfinite(self.clearances), self.clearances, np.inf).min(axis=1, initial=np.inf)
        order = [int(pair) for pair in np.argsort(lowest) if lowest[pair] < 0 or not self.joined[pair]][:NAMED]
        label = f"clearance ({self.unit})" if self.unit else "clearance"
        title = "below 0: depth of a clash" if self.clashing.any() else "no clash" if self.closed.any() else "not known"
        if not self.closed.all():
            title += f"; {np.sum(~self.closed)} of {len(self.closed)} poses are not closed"
        return draw_lines([self._named(pair) for pair in order], self.clearances[order], label, title, Path(path))

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


def clashes(
    motion: Motion,
    *,
    within: float | int | None = None,
    tolerance: float | int | None = None,
    ignore: Sequence[Sequence[str]] = (),
) -> Clashes:
    """Find the parts that cut each other at the closed poses of a motion, and the clearances of the others.

    - `within`: clearances up to this length are measured, 2 % of the size of the mechanism by default; 0 measures none.
    - `tolerance`: overlap, a length, up to which parts count as touching; by default what counts as a contact.
    - `ignore`: pairs of parts that are left out, `[["bolt", "plate"]]`.

    The parts of one rigid body are not compared. Faces that are in contact by design may overlap each other, as the
    chords of a pin and of its hole do; each face may overlap others by the height of its chords, and by the misfit of
    its contacts. So a pin in its own hole is no clash, but the same pin through a wall is. Overlaps that are less deep
    than those lengths are not told.

    The depth is at most the largest distance from the surface of one part of a point of the surface of the other that
    is inside of it: it is that of the deepest of some points, which are corners of triangles, middles of the pieces of
    their edges that are inside, and points of the largest triangles of each face. Where none of them is inside, because
    faces lie on each other, it is that of a point half-way through a part. Poses between those of the motion are not
    looked at, and of those that are not closed nothing is known.

    Raises ValueError for a mechanism without solids, for names that are not there, for lengths that are negative, and
    inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "clashes")
    check_known("clashes", "jk.clashes", motion)
    mechanism = motion.mechanism
    if not any(part.is_solid for part in mechanism.solids):
        raise ValueError(
            "clashes needs solids, and this mechanism has none: make it from files, jk.load(files).mechanism(fixed=...)"
        )
    for name, given in (("within", within), ("tolerance", tolerance)):
        expected = "a length, zero or more in the unit of the mechanism"
        if given is not None and not (np.shape(given) == () and numbers(given, name, expected) >= 0):
            raise ValueError(f"{name} must be {expected}, got {given!r}")
    setting = FaceSetting(mechanism)
    within = WITHIN * size(mechanism.solids) if within is None else float(within)
    still = SAME_PLACE * setting.length
    least = setting.length if tolerance is None else float(tolerance)
    is_closed = np.asarray(motion.closed)
    (closed,) = np.nonzero(is_closed)
    places = [np.asarray(motion.transforms[part.name], float)[closed] for part in mechanism.solids]
    shapes = [shape_of(part) for part in mechanism.solids]
    boxes = np.stack([boxes_along(shape, place) for shape, place in zip(shapes, places, strict=True)])
    compared = _compared(mechanism, setting, ignore)
    misfits = _misfits(mechanism)
    pairs, joined, rows = [], [], []
    for i, j, near in near_pairs(boxes, compared, within):
        names = shapes[i].part.name, shapes[j].part.name
        slack = _slack(shapes[i], shapes[j], misfits, least)
        is_joined = frozenset(names) in misfits
        row = np.full(len(motion), np.nan)
        row[closed] = np.inf
        moved = displaced(shapes[i], shapes[j], places[i][near], places[j][near])
        pair = _ShapePair(shapes[i], shapes[j], slack, is_joined)
        row[closed[near]] = _clearances(pair, moved, 0.0 if is_joined else within, still)
        if is_joined or np.any(row <= within):
            pairs.append(names)
            joined.append(is_joined)
            rows.append(row)
    clearances = np.stack(rows) if rows else np.zeros((0, len(motion)))
    step = largest_step(shapes, places)
    return Clashes(tuple(pairs), np.array(joined, bool), clearances, is_closed, within, mechanism.unit, step)


def _compared(mechanism: Mechanism, setting: FaceSetting, ignore: Sequence[Sequence[str]]) -> np.ndarray:
    """Mark the pairs of solids that are of different bodies and not to be left out; boxes that mark places are none."""
    names = [part.name for part in mechanism.solids]
    bodies = np.unique([setting.body[name] for name in names], return_inverse=True)[1]
    solid = np.array([part.is_solid for part in mechanism.solids])
    compared = (bodies[:, None] != bodies[None]) & solid[:, None] & solid[None]
    for pair in several(ignore, "ignore", "pairs of parts", '[["bolt", "plate"]]'):
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise ValueError(f"ignore is a list of pairs of parts, [['bolt', 'plate']], got the entry {pair!r}")
        for name in pair:
            if name not in names:
                raise ValueError(f"ignore names the unknown part {name!r}{nearest(name, names)}")
        i, j = (names.index(name) for name in pair)
        compared[i, j] = compared[j, i] = False
    return compared


def _misfits(mechanism: Mechanism) -> dict[frozenset[str], dict[tuple[tuple[str, str], tuple[str, str]], float]]:
    """Collect, for each two parts in contact, the faces that touch, (part, face) each, and their largest misfit."""
    found: dict[frozenset[str], dict[tuple[tuple[str, str], tuple[str, str]], float]] = {}
    for contact in all_contacts(mechanism):
        one, other = zip(contact.parts, contact.faces, strict=True)
        of_pair = found.setdefault(frozenset(contact.parts), {})
        of_pair[one, other] = max(of_pair.get((one, other), 0.0), contact.misfit)
    return found


def _slack(one: ClashShape, other: ClashShape, misfits: dict, least: float) -> Slack:
    """Say by how much the triangles of two shapes may overlap, and which of them are in contact by design."""
    shapes = {one.part.name: one, other.part.name: other}
    numbers = {name: {face.name: k for k, face in enumerate(shape.part.faces)} for name, shape in shapes.items()}
    slack = {name: shape.bulges.copy() for name, shape in shapes.items()}
    ignored = np.zeros((len(one.bulges), len(other.bulges)), bool)
    for sides, misfit in misfits.get(frozenset(shapes), {}).items():
        at = {part: numbers[part][face] for part, face in sides}
        ignored[at[one.part.name], at[other.part.name]] = True
        for part, number in at.items():
            bulge = shapes[part].bulges[number]
            slack[part][number] = max(slack[part][number], bulge + misfit)
    first, second = (slack[shape.part.name][shape.labels] for shape in (one, other))
    return Slack(least, first, second, ignored)


class _ShapePair(NamedTuple):
    """Two shapes that may clash."""

    one: ClashShape
    other: ClashShape
    slack: Slack
    joined: bool
    """Whether faces of theirs are in contact by design."""


def _clearances(pair: _ShapePair, moved: Displaced, within: float, still: float) -> Float[np.ndarray, " poses"]:
    """Measure the clearance of two shapes at each displacement; infinite beyond `within`.

    Faces that all displacements of joined shapes leave in place, to `still`, may touch.
    """
    one, other, slack, joined = pair
    count = len(moved.shift)
    reach = max(1.0, float(np.abs(moved.shift).max()))
    change = max(np.ptp(moved.rotation, axis=0).max(), np.ptp(moved.shift, axis=0).max() / reach)
    if count > 1 and change <= _AT_REST:
        return np.repeat(_clearances(pair, moved.at(np.array([0])), within, still), count)
    if joined and not len(crossings(one.tree, other.tree, moved.at(np.array([0])), slack).pose):
        slack = slack._replace(ignored=slack.ignored | invariant(one, other, moved, still))
    crossed = crossings(one.tree, other.tree, moved, slack)
    on_faces, amid = sampled_depths(one, other, moved, slack)
    suspects = np.union1d(crossed.pose, np.flatnonzero(np.maximum(on_faces, amid)))
    result = np.zeros(count)
    if len(suspects):
        here = crossed._replace(pose=np.searchsorted(suspects, crossed.pose))
        deep = np.maximum(depths(one, other, moved.at(suspects), here, slack), on_faces[suspects])
        # two solids that coincide have no point of their surfaces in each other
        result[suspects] = -np.where(deep > 0, deep, amid[suspects])
    free = np.flatnonzero(result == 0)
    if not joined and len(free):
        result[free] = distances(one.tree, other.tree, moved.at(free), within) if within else np.inf
    return result
