"""Bores and pins of different parts on common axes: a pin in a hole, with clearance or interference, or equal bores."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from jaxkin.assembly.inference.bores import NEAR_LENGTH, Bore, shared

MAX_TILT = 2e-3
"""Radians between the axes of a pin and its hole: a tenth of a millimetre over the length of a finger."""
MAX_CLEARANCE = 0.29
"""Radial clearance over the radius of the hole. Of 191 loose pins in 18 assemblies that people drew, 177 are within
0.25; screws that are drawn as thick as the root of their thread have up to 0.28 in holes by ISO 273."""
MAX_IN_GROOVE = 0.1
"""The same in a groove that is open by half: a wheel in its arch has a tenth to a fifth, and is not guided by it."""
MAX_INTERFERENCE = 0.1
"""The same of pins that are thicker than their holes. Of 92 such pins in the exports tried, 63 are within 0.1 of the
radius; thicker ones are threads (`CommonAxis.threaded`)."""
MAX_THREAD = 0.5
"""The same of screws in holes that are drawn as they are drilled for the thread: M3 to M10 have 0.17 to 0.21, M1.6
0.28, and screws for wood 0.25 to 0.5."""
EQUAL_BORES = 0.1
"""Radii of two bores without a pin that are one axis differ by so much at most, over the larger one."""
MAX_TAPPED = 0.35
"""The same of a hole that a screw goes through and one that it is screwed into, where the screw is not drawn: M3 to M10
have 0.22 to 0.28 by tables, and more with wide holes. Two such axes are asked for, and faces that touch."""
MAX_OFFSET = 0.05
"""Distance of axes that count as one beside the clearance, over the radius."""
_OTHER_RADIUS = 1.02
"""Radii of which one is larger by this factor are those of two surfaces, a pin and a sleeve on it."""
MIN_ENGAGED = 0.05
"""Length of a pin in its hole, over the radius, at least: a pin that ends where a hole of the next part begins is not
in it."""
MAX_AXIAL_GAP = 4.0
"""Equal bores farther apart along their axis, over the radius, have nothing to do with each other."""
MAX_FAR = 20.0
"""The same of parts that nothing else ties: plates on spacers that are not drawn."""
MAX_LOOSE = 0.5
"""Radial clearance over the radius of the hole of parts that nothing else ties: bushes that are not drawn. Radii of an
eye and its fork differ by so much where pin and bush are not drawn, and those of bores beside each other of parts that
nothing else ties."""
MAX_BESIDE = 0.5
"""Gap between two such bores along the axis, over the radius of the larger one."""


@dataclass(frozen=True, eq=False)
class CommonAxis:
    """Two bores of two parts on one axis: a pin and its hole, or two equal bores with nothing in them."""

    one: Bore
    """The pin, where there is one."""
    other: Bore
    offset: float
    """Distance between the two axes."""
    tilt: float
    """Angle between them, radians."""

    @property
    def virtual(self) -> bool:
        """Whether there is no pin."""
        return self.one.hole

    @property
    def clearance(self) -> float:
        """Radial clearance of the pin in its hole; negative where the pin is thicker."""
        return self.other.radius - self.one.radius

    @property
    def tight(self) -> bool:
        """Whether the pin is thicker than its hole by more than what counts as one radius."""
        return self.one.radius > _OTHER_RADIUS * self.other.radius

    @property
    def threaded(self) -> bool:
        """Whether the pin is thicker than its hole as a screw is in the hole drilled for its thread."""
        return not self.virtual and self.clearance < -MAX_INTERFERENCE * self.other.radius

    @property
    def tapped(self) -> bool:
        """Whether there is no pin, and the two bores are not equal: those of a screw that is not drawn."""
        unequal = abs(self.clearance) > EQUAL_BORES * max(self.one.radius, self.other.radius)
        return self.virtual and unequal and not is_eye_in_fork(self)

    @property
    def parts(self) -> tuple[str, str]:
        return self.one.part, self.other.part


def common_axes(bores: Sequence[Bore], clearance: float | None = None) -> list[CommonAxis]:
    """Find all pairs of bores of different parts that share an axis; pins with a sleeve between are not in the hole.

    Equal bores with nothing in them have no pin near to both: one that is in far lugs of one of them only, such as the
    pin of the other side of a frame, leaves these empty. A thinner pin that runs through both, and is in a hole of its
    own size elsewhere, fills them: they are room for its head, or for its nut.

    `clearance` is the largest radial clearance of a pin in its hole, in the unit of the file; by default MAX_CLEARANCE
    times the radius of the hole.
    """
    if len(bores) < 2:
        return []
    near = _coaxial(bores, clearance)
    pins = [each for each in near if each.one.hole != each.other.hole and _fits(each, clearance)]
    pins = [each for each in pins if not _sleeved(each, pins)]
    filling: dict[int, list[Bore]] = {}
    for each in pins:
        filling.setdefault(id(each.other), []).append(each.one)
    empty = [each for each in near if each.one.hole and each.other.hole and _equal(each)]
    empty = [each for each in empty if not _is_filled(each, filling)]
    return [*pins, *_not_run_through(empty, pins)]


def _is_filled(pair: CommonAxis, filling: Mapping[int, Sequence[Bore]]) -> bool:
    """Tell whether a pin is in one of two bores, near to the other one."""
    for bore, other in ((pair.one, pair.other), (pair.other, pair.one)):
        for each in filling.get(id(bore), ()):
            if shared_length(other, each) > -MAX_AXIAL_GAP * max(bore.radius, other.radius):
                return True
    return False


def _not_run_through(pairs: Sequence[CommonAxis], found: Sequence[CommonAxis]) -> list[CommonAxis]:
    """Leave out bores without a pin through both of which a pin of a third part runs, one of those that were found in a
    hole; it may begin at the floor of a counterbore, where its head lies."""
    pins = list({id(each.one): each.one for each in found if not (each.virtual or each.threaded)}.values())
    if not pins or not pairs:
        return [*pairs]
    points = np.array([each.point for each in pins])

    def is_run_through(pair: CommonAxis) -> bool:
        offset, axis = points - pair.one.point, pair.one.axis
        apart = np.linalg.norm(offset - np.outer(offset @ axis, axis), axis=1)
        near = [pins[k] for k in np.flatnonzero(apart <= NEAR_LENGTH * pair.one.radius).tolist()]
        near = [each for each in near if each.part not in pair.parts and each.on_axis_of(pair.one)]
        lengths = [sorted(shared_length(bore, each) / each.radius for bore in (pair.one, pair.other)) for each in near]
        return any(least >= -MIN_ENGAGED and most > MIN_ENGAGED for least, most in lengths)

    return [pair for pair in pairs if not (pair.virtual and is_run_through(pair))]


def far_axes(bores: Sequence[Bore], near: Sequence[CommonAxis]) -> list[CommonAxis]:
    """Find pairs of bores on one axis that are too far from each other, or too loose, to be among the `near` ones."""
    if len(bores) < 2:
        return []
    known, result = {(id(pair.one), id(pair.other)) for pair in near}, []
    for pair in _coaxial(bores, None):
        radius = max(pair.one.radius, pair.other.radius)
        if (id(pair.one), id(pair.other)) in known or pair.offset > MAX_OFFSET * radius:
            continue
        if pair.virtual:
            unequal, gap = abs(pair.clearance), -engaged(pair)
            far = unequal <= EQUAL_BORES * radius and gap <= MAX_FAR * radius
            far |= unequal <= MAX_LOOSE * radius and gap <= MAX_BESIDE * radius
        else:
            far = pair.other.hole and 0 <= pair.clearance <= MAX_LOOSE * radius and engaged(pair) > MIN_ENGAGED * radius
        if far:
            result.append(pair)
    filled = {id(bore) for pair in (*near, *result) if not pair.virtual for bore in (pair.one, pair.other)}
    result = [pair for pair in result if not pair.virtual or not {id(pair.one), id(pair.other)} & filled]
    return _not_run_through(result, near)


def _coaxial(bores: Sequence[Bore], clearance: float | None) -> list[CommonAxis]:
    """Find pairs of bores of different parts whose axes are one within the largest clearance; the pin comes first."""
    points, axes = (np.array([getattr(bore, name) for bore in bores]) for name in ("point", "axis"))
    radii = np.array([bore.radius for bore in bores])
    parts = np.unique([bore.part for bore in bores], return_inverse=True)[1]
    found = []
    for i in range(len(bores) - 1):
        rest = slice(i + 1, None)
        offset = points[rest] - points[i]
        tilt = np.linalg.norm(np.cross(axes[rest], axes[i]), axis=1)
        apart = np.linalg.norm(offset - np.outer(offset @ axes[i], axes[i]), axis=1)
        reach = np.maximum(MAX_CLEARANCE * np.maximum(radii[rest], radii[i]), clearance or 0.0)
        for k in np.flatnonzero((parts[rest] != parts[i]) & (tilt <= MAX_TILT) & (apart <= reach)).tolist():
            pair = (bores[i], bores[i + 1 + k])
            if all(bore.hole and bore.is_half_open for bore in pair):
                continue  # the webs of two forks, or the ends of two slots: a pin would fall out of both
            one, other = pair if not pair[0].hole or pair[1].hole else pair[::-1]
            found.append(CommonAxis(one, other, float(apart[k]), float(tilt[k])))
    return found


def _fits(pair: CommonAxis, clearance: float | None) -> bool:
    """Tell whether the pin can be in the hole: by its radius, by how far it is off centre, and along the axis."""
    loose, radius = pair.clearance, pair.other.radius
    centred = pair.offset <= max(loose, 0.0) + MAX_OFFSET * radius
    most = MAX_CLEARANCE * radius if clearance is None else clearance
    if pair.other.is_half_open:
        most = min(most, MAX_IN_GROOVE * radius)
    return bool(-MAX_THREAD * radius <= loose <= most and centred and engaged(pair) > MIN_ENGAGED * radius)


def _equal(pair: CommonAxis) -> bool:
    """Tell whether two bores without a pin belong to one axis: equal ones, or those of a screw that is not drawn."""
    radius = max(pair.one.radius, pair.other.radius)
    most = MAX_LOOSE if is_eye_in_fork(pair) else MAX_TAPPED
    if pair.offset > MAX_OFFSET * radius or abs(pair.clearance) > most * radius:
        return False
    return bool(-engaged(pair) <= (MIN_ENGAGED if pair.tapped else MAX_AXIAL_GAP) * radius)


def is_eye_in_fork(pair: CommonAxis) -> bool:
    """Tell whether all of one bore is between two neighbouring spans of the other, with a gap of at most `MAX_BESIDE`
    on both sides, as an eye is between the lugs of a fork: a pin goes through, perhaps in a bush."""
    along = pair.one.axis
    slack, least = MAX_BESIDE * max(pair.one.radius, pair.other.radius), MIN_ENGAGED * pair.other.radius
    for fork, eye in ((pair.one, pair.other), (pair.other, pair.one)):
        spans = eye.spans_along(along)
        low, high = min(first for first, _ in spans), max(last for _, last in spans)
        for (_, below), (above, _) in pairwise(sorted(fork.spans_along(along))):
            if -least <= low - below <= slack and -least <= above - high <= slack:
                return True
    return False


def apart(one: Bore, other: Bore) -> tuple[float, float]:
    """Measure the distance between the axes of two bores, at the middle of the first, and the angle between them."""
    offset = one.point - other.point
    across = offset - (offset @ other.axis) * other.axis
    return float(np.linalg.norm(across)), float(np.linalg.norm(np.cross(one.axis, other.axis)))


def engaged(pair: CommonAxis) -> float:
    """Measure the length along the axis that both bores share; negative where there is a gap between them."""
    return shared_length(pair.one, pair.other)


def shared_length(one: Bore, other: Bore) -> float:
    """Measure the length that two bores on one axis share along it; negative where there is a gap between them."""
    return shared(one.spans_along(one.axis), other.spans_along(one.axis))


def _sleeved(pair: CommonAxis, pins: Sequence[CommonAxis]) -> bool:
    """Tell whether a third part is between: a thicker pin that fills the hole, or a tighter hole that holds the pin.

    A pin that is thicker than the hole is not in it where another hole holds it without interference, or another pin
    is in the hole without one, in the midst of the thicker one: that is a ring around it, such as a shim. A part
    that is itself in that other hole, as a nut is in its carriage, is between this and the pin.
    """
    apart = MIN_ENGAGED * pair.other.radius
    for each in pins:
        thicker = each.other is pair.other and each.one.radius > _OTHER_RADIUS * pair.one.radius
        thicker = thicker and (pair.tight or not each.tight)
        if thicker and each.one.part != pair.one.part and shared_length(pair.one, each.one) > apart:
            return True
        filled = pair.tight and each.other is pair.other and not each.tight and each.one.part != pair.one.part
        if filled and shared_length(pair.one, each.one) > 0.0:
            return True
        tighter = each.one is pair.one and _OTHER_RADIUS * each.other.radius < pair.other.radius
        fits = each.one is pair.one and pair.tight and not each.tight
        fits = fits and not any(pin.other is each.other and pin.one.part == pair.other.part for pin in pins)
        beside = each.other.part != pair.other.part and (tighter or fits)
        if beside and (fits or not each.tight) and shared_length(each.other, pair.other) > apart:
            return True
    return False


def plugged_holes(found: Sequence[CommonAxis]) -> set[int]:
    """Find the holes, by their identity, with nothing in them but what is in no other part, as a grease nipple is: a
    screw in the end of a ram goes through what it holds there."""
    where: dict[str, set[str]] = {}
    for pair in found:
        where.setdefault(pair.one.part, set()).add(pair.other.part)
    inside: dict[int, set[str]] = {}
    for pair in found:
        inside.setdefault(id(pair.other), set()).add(pair.one.part)
    return {hole for hole, parts in inside.items() if all(len(where[part]) == 1 for part in parts)}
