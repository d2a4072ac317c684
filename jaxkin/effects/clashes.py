"""Find the parts that cut each other along a motion, and how near the others come, on their meshes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain

import numpy as np

from jaxkin._arguments import check_known, check_motion, numbers, several
from jaxkin._names import nearest
from jaxkin.assembly.joined import all_contacts
from jaxkin.assembly.kept_contacts import kept_contacts
from jaxkin.effects.clash_cases import ClashCase, distinct_cases
from jaxkin.effects.clash_progress import ClashProgress
from jaxkin.effects.clash_result import Clashes
from jaxkin.effects.clash_search import clearances
from jaxkin.effects.clash_shapes import ClashPart, boxes_along, clash_parts, displaced, largest_step, near_pairs
from jaxkin.effects.invariant_faces import SAME_PLACE
from jaxkin.geometry.part import size
from jaxkin.geometry.tree_crossings import Slack
from jaxkin.mechanism.lost_contacts import FaceSetting
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion

WITHIN = 0.02
"""Clearance over the size of the mechanism up to which it is measured by default: what is farther away is no concern,
and costs nothing."""


def clashes(
    motion: Motion,
    *,
    within: float | int | None = None,
    tolerance: float | int | None = None,
    ignore: Sequence[Sequence[str]] = (),
    progress: bool | Callable[[int, int], None] | None = None,
) -> Clashes:
    """Find the parts that cut each other at the closed poses of a motion, and the clearances of the others.

    - `within`: clearances up to this length are measured, 2 % of the size of the mechanism by default; 0 measures none.
    - `tolerance`: overlap, a length, up to which parts count as touching; by default what counts as a contact.
    - `ignore`: pairs of parts that are left out, `[["bolt", "plate"]]`.
    - `progress`: whether to draw a bar, by default on a terminal only; or a function that is called with how many
      placements of two parts are searched, and with the number of all.

    The parts of one rigid body are not compared. Faces that are in contact by design, those that joints were read from
    or that joints by hand keep on each other, may overlap, as the chords of a pin and of its hole do; each face may
    overlap others by the height of its chords, and by the misfit of its contacts. So a pin in its own hole is no clash,
    but the same pin through a wall is. Overlaps that are less deep than those lengths are not told.

    The depth is at most the largest distance from the surface of one part of a point of the surface of the other that
    is inside of it: it is that of the deepest of some points, which are corners of triangles, middles of the pieces of
    their edges that are inside, and points of the largest triangles of each face. Where none of them is inside, because
    faces lie on each other, it is that of a point half-way through a part. Poses between those of the motion are not
    looked at, and of those that are not closed nothing is known.

    Warns, as soon as it is known, of a search that will take longer than two minutes. Raises ValueError for a mechanism
    without solids, for names that are not there, for lengths that are negative, and inside `jit`, `vmap` and `grad`.
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
    boxes = np.stack([boxes_along(part, place) for part, place in zip(mechanism.solids, places, strict=True)])
    near = near_pairs(boxes, _compared(mechanism, setting, ignore), within)
    parts = clash_parts(mechanism.solids)
    misfits = _misfits(mechanism)
    cases = [_case(parts[i], parts[j], misfits, least, places[i][some], places[j][some]) for i, j, some in near]
    distinct = distinct_cases(cases, size(mechanism.solids))
    with ClashProgress(progress, _advice(within, mechanism.unit)) as told:
        measured = clearances(distinct.cases, within, still, told)
    pairs, joined, rows = [], [], []
    for (i, j, some), case, which, poses in zip(near, cases, distinct.which, distinct.poses, strict=True):
        row = np.full(len(motion), np.nan)
        row[closed] = np.inf
        row[closed[some]] = measured[which][poses]
        if case.joined or np.any(row <= within):
            pairs.append((parts[i].part.name, parts[j].part.name))
            joined.append(case.joined)
            rows.append(row)
    found = np.stack(rows) if rows else np.zeros((0, len(motion)))
    step = largest_step(mechanism.solids, places)
    return Clashes(motion, tuple(pairs), np.array(joined, bool), found, is_closed, within, mechanism.unit, step)


def _advice(within: float, unit: str) -> str:
    """Say what a search would take less time with."""
    less = "fewer poses take as much less, and pairs can be left out, ignore=[[part, part]]"
    if not within:
        return less
    given = f"{within:.3g} {unit}".rstrip()
    return f"{less}; within=0 finds clashes only, and a length less than {given} measures fewer clearances"


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
    """Collect, for each two parts in contact, the faces that touch, (part, face) each, and their largest misfit.

    Of joints by hand these are the contacts that the joints keep: what a joint holds together touches by design.
    """
    found: dict[frozenset[str], dict[tuple[tuple[str, str], tuple[str, str]], float]] = {}
    kept = () if mechanism.contacts else kept_contacts(mechanism).values()
    for contact in (*all_contacts(mechanism), *chain.from_iterable(kept)):
        one, other = zip(contact.parts, contact.faces, strict=True)
        of_pair = found.setdefault(frozenset(contact.parts), {})
        of_pair[one, other] = max(of_pair.get((one, other), 0.0), contact.misfit)
    return found


def _case(
    one: ClashPart, other: ClashPart, misfits: dict, least: float, of_one: np.ndarray, of_other: np.ndarray
) -> ClashCase:
    """Say how two parts are displaced, (poses, 4, 4) each, and by how much which of their triangles may overlap."""
    parts = {each.part.name: each for each in (one, other)}
    slack = {name: each.shape.bulges for name, each in parts.items()}
    ignored = np.broadcast_to(False, (len(one.shape.bulges), len(other.shape.bulges)))
    touching = misfits.get(frozenset(parts), {})
    if touching:
        numbers = {name: {face.name: k for k, face in enumerate(each.part.faces)} for name, each in parts.items()}
        slack, ignored = {name: each.copy() for name, each in slack.items()}, ignored.copy()
    for sides, misfit in touching.items():
        at = {part: numbers[part][face] for part, face in sides}
        ignored[at[one.part.name], at[other.part.name]] = True
        for part, number in at.items():
            bulge = parts[part].shape.bulges[number]
            slack[part][number] = max(slack[part][number], bulge + misfit)
    first, second = slack[one.part.name], slack[other.part.name]
    moved = displaced(one, other, of_one, of_other)
    return ClashCase(one.shape, other.shape, Slack(least, first, second, ignored), bool(touching), moved)
