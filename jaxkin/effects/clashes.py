"""Find the parts that cut each other along a motion, and how near the others come, on their meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import check_known, check_motion, numbers, several
from jaxkin._names import nearest
from jaxkin.assembly.joined import all_contacts
from jaxkin.effects.clash_result import Clashes
from jaxkin.effects.clash_shapes import ClashShape, boxes_along, displaced, largest_step, near_pairs, shape_of
from jaxkin.effects.invariant_faces import SAME_PLACE, invariant
from jaxkin.effects.penetration import depths
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
_AT_REST = 1e-12
"""Change of a displacement, over the size, below which two parts are at rest relative to each other: rounding."""


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
    shapes = "jk.design.clearance of the shapes of two parts inside"
    check_known("clashes", "jk.clashes", motion, within, tolerance, inside=shapes)
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
    return Clashes(motion, tuple(pairs), np.array(joined, bool), clearances, is_closed, within, mechanism.unit, step)


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
