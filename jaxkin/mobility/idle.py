"""Find idle motions: passive parts that move about themselves while all other parts of the mechanism rest (host code).

- A part with an idle motion is held by two or more other parts: a rod between balls, a pin in two holes, a washer
  between two plates. A part that is held in several places by one and the same part is a hinge or a slide, and its
  motion is not idle; neither is a motion that would carry another part along.
- Parts in a row have an idle motion together if it carries the motions between them into themselves (their Lie brackets
  with it vanish): the halves of a leg that slide along its line, but not a thigh and a shin with a knee between them.
- A ball may be written as three hinges with two small links, as in files of robots; the links then move along.
- A shaft between two universal joints, with bearings in two different parts, has an idle motion by its joints alone.

All this follows from the twists that joints allow, and does not depend on a basis of the motions, nor on names or the
order of joints. Of two bodies that hold each other alike the first in the order of the parts counts as idle.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import skew
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.body_graph import BodyGraph, Constraints, Twists
from jaxkin.mobility.loop_freedoms import LoopFreedoms

_TOLD = 5
"""Parts of an idle motion, and of what holds them, that a line names."""


@dataclass(frozen=True)
class IdleMotion:
    """One idle freedom: the parts that move, the kind of motion, and the parts that hold them."""

    parts: tuple[str, ...]
    """The parts that move; all others rest."""
    kind: str
    """"turns" about an axis, perhaps advancing along it, or "slides"."""
    between: tuple[str, ...]
    """The parts that hold the moving ones, at rest."""
    coordinates: tuple[str, ...]
    """Coordinates "joint.coordinate" in which the motion shows. Other motions may show in them too."""

    def __str__(self) -> str:
        verb = self.kind if len(self.parts) == 1 else self.kind.removesuffix("s") + " together"
        *first, last = _told(self.between)
        between = f"{', '.join(first)} and {last}" if first else last
        return f"{' + '.join(_told(self.parts))} {verb} between {between}"


def _told(parts: Sequence[str]) -> Sequence[str]:
    """List the names of parts, of many the first ones: a body of a machine has dozens."""
    more = len(parts) - _TOLD
    return parts if more <= 0 else (*parts[:_TOLD], f"{more} more")


@dataclass(frozen=True, eq=False)
class _End:
    """A connection from a body that may move idly to a body at rest, direct or over the small links of a ball."""

    bodies: tuple[str, ...]
    """The body, the links in order, and the body at rest."""
    allowed: Twists
    """Twists that the joints allow each body relative to the next, (6, twists), side by side."""
    sizes: tuple[int, ...]
    """Number of columns of `allowed` for each pair of neighbouring bodies."""
    forbidden: Constraints
    """Constraints on the twist of the first body relative to the last."""


@dataclass(frozen=True, eq=False)
class _Row:
    """Bodies that may have an idle motion together, and their connections to bodies at rest."""

    bodies: tuple[str, ...]
    inner: Constraints
    """Constraints on the twist of the row by bodies that are joined to it from outside the loop group, and by the
    condition that the twist carries the motions between the bodies of the row into themselves."""
    ends: tuple[_End, ...]

    @property
    def moving(self) -> tuple[str, ...]:
        """All bodies that move: those of the row and the small links of its ends."""
        return (*self.bodies, *(link for end in self.ends for link in end.bodies[1:-1]))

    @property
    def resting(self) -> tuple[str, ...]:
        """The bodies between which the row moves."""
        return tuple(dict.fromkeys(end.bodies[-1] for end in self.ends))


class IdleMotions:
    """The idle motions of one loop group. Parts in `left_out` hold no other part and are not examined."""

    def __init__(self, linkage: Linkage, found: LoopFreedoms, left_out: Collection[str] = ()) -> None:
        self._linkage, self._found, self._left_out = linkage, found, set(left_out)
        self._graph = BodyGraph(linkage, found, left_out)

    @property
    def carrier(self) -> frozenset[str]:
        """The rows of parts by which the loop group is connected to the fixed parts, or those of the fixed parts."""
        return frozenset(self._graph.parts_of[self._graph.carrier])

    @property
    def rates(self) -> Float[np.ndarray, "idle columns"]:
        """An orthonormal basis of the rates of the idle motions."""
        return self._independent[1]

    @property
    def motions(self) -> tuple[IdleMotion, ...]:
        """One description for each idle freedom; motions that are linear combinations of others are left out."""
        return self._independent[0]

    @cached_property
    def _independent(self) -> tuple[tuple[IdleMotion, ...], Float[np.ndarray, "idle columns"]]:
        basis, motions = np.zeros((0, len(self._found.columns))), []
        for row, twists in self._by_size():
            if not self._is_between_bodies(row, basis):
                continue
            for kind, some in self._turns_and_slides(twists):
                rates = np.array([self._rates(row, twist) for twist in some])
                described = self._described(row, kind, rates)
                for one in rates:
                    new = one - (one @ basis.T) @ basis
                    if (size := np.linalg.norm(new)) > self._found.thresholds.rate:
                        basis = np.concatenate([basis, new[None] / size])
                        motions.append(described)
        return tuple(motions), basis

    def _by_size(self) -> list[tuple[_Row, Twists]]:
        """List the rows that can move while all other bodies rest, with their twists, in the order of examination.

        Rows of few bodies come first, and among these the rows with more freedoms: of two bodies that hold each other,
        as a washer and a block that slides on it, the one with more freedoms counts as idle.
        """
        found = [
            (row, self._graph.free_of(np.concatenate([row.inner, *(end.forbidden for end in row.ends)])))
            for row in self._rows()
        ]
        order = self._linkage.structure.parts.index
        return sorted(
            ((row, twists) for row, twists in found if twists.size),
            key=lambda pair: (len(pair[0].moving), -pair[1].shape[1], sorted(map(order, pair[0].bodies))),
        )

    def _is_between_bodies(self, row: _Row, idle: Float[np.ndarray, "idle columns"]) -> bool:
        """Tell whether at least two bodies hold a row, when links without motions other than idle ones are contracted.

        A link that never moves relative to the next body, or by idle motions `idle` only, counts as one body with it. A
        row that is held in two places by one such body is a hinge or a slide, and its motion is not idle.
        """
        graph, held_by = self._graph, set()
        for end in row.ends:
            before, last = end.bodies[-2:]
            while graph.is_link(last):
                following = graph.beyond(last, before)
                all_motions, idle_ones = (graph.relative(last, following, m) for m in (self._found.motions, idle))
                if all_motions.shape[1] > idle_ones.shape[1]:
                    break
                before, last = last, following
            held_by.add(last)
        return len(held_by - self._left_out) > 1

    def _rows(self) -> Iterator[_Row]:
        """Yield single bodies, and rows of bodies with two neighbours each, each with direct ends and with ends over
        the small links of a ball."""
        graph, seen = self._graph, set()
        for body in graph.movable:
            yield from self._held([body], graph.held_outside(body))
            for start in graph.neighbours[body] if graph.is_in_row(body) else []:
                row, inner, came = [body], graph.held_outside(body), start
                while True:
                    following = graph.beyond(row[-1], came)
                    if not graph.is_in_row(following) or following in row or following == start:
                        break
                    came = row[-1]
                    inner = np.concatenate(
                        [
                            inner,
                            graph.held_outside(following),
                            _bracket(graph.relative(came, following, self._found.motions)),
                        ]
                    )
                    row.append(following)
                    ends = [self._straight(body, start), self._over_links(body, start)]
                    if not any(graph.free_of(np.concatenate([inner, end.forbidden])).size for end in ends):
                        break
                    if frozenset(row) not in seen:
                        seen.add(frozenset(row))
                        yield from self._held(row, inner)

    def _held(self, bodies: Sequence[str], inner: Constraints) -> Iterator[_Row]:
        """Yield the row of these bodies, once with direct ends and once with ends over as many links as possible."""
        pairs = [(body, other) for body, other in self._graph.joints if body in bodies and other not in bodies]
        row = _Row(tuple(bodies), inner, tuple(self._straight(*pair) for pair in pairs))
        if len(set(row.resting) - self._left_out) > 1:
            yield row
        row = _Row(row.bodies, inner, tuple(self._over_links(*pair) for pair in pairs))
        apart = len(set(row.moving)) == len(row.moving) and not set(row.moving) & set(row.resting)
        if len(row.moving) == len(bodies) or not apart or len(set(row.resting) - self._left_out) < 2:
            return
        # if all ends turn about one point, this is no rod but a spherical linkage
        if _centre(np.concatenate([end.allowed for end in row.ends], axis=1), self._found.thresholds.rate) is None:
            yield row

    def _straight(self, body: str, other: str) -> _End:
        """Make the direct connection between two bodies that are joined."""
        allowed = self._graph.allowed(body, other)
        return _End((body, other), allowed, (allowed.shape[1],), self._graph.forbidden(body, other))

    def _over_links(self, body: str, other: str) -> _End:
        """Extend the connection from a body over links, as long as all joints passed turn about one point."""
        end = self._straight(body, other)
        while self._graph.is_link(end.bodies[-1]):
            last, before = end.bodies[-1], end.bodies[-2]
            following = self._graph.beyond(last, before)
            step = self._graph.allowed(last, following)
            allowed = np.concatenate([end.allowed, step], axis=1)
            if following in end.bodies or _centre(allowed, self._found.thresholds.rate) is None:
                break
            forbidden = _complement(allowed, self._found.thresholds.rate)
            end = _End((*end.bodies, following), allowed, (*end.sizes, step.shape[1]), forbidden)
        return end

    def _rates(self, row: _Row, twist: Float[np.ndarray, "6"]) -> Float[np.ndarray, " columns"]:
        """Compute joint rates, of unit norm, of a row that moves with a twist while the bodies that hold it rest."""
        rates = np.zeros(len(self._found.columns))
        for end in row.ends:
            shares = np.linalg.lstsq(end.allowed, twist, rcond=1e-9)[0]
            pieces = np.split(np.arange(len(shares)), np.cumsum(end.sizes)[:-1])
            for one, other, piece in zip(end.bodies, end.bodies[1:], pieces, strict=False):
                rates += self._graph.rates(one, other, end.allowed[:, piece] @ shares[piece])
        return rates / np.linalg.norm(rates)

    def _turns_and_slides(self, twists: Twists) -> Iterator[tuple[str, Float[np.ndarray, "twists 6"]]]:
        """Yield a basis of these twists by kind, with as few twists as possible that have an angular velocity."""
        _, sizes, mixes = np.linalg.svd(twists[:3], full_matrices=True)
        turning = int((sizes > self._found.thresholds.rate).sum())
        for kind, some in (("turns", mixes[:turning]), ("slides", mixes[turning:])):
            if len(some):
                yield kind, some @ twists.T

    def _described(self, row: _Row, kind: str, rates: Float[np.ndarray, "motions columns"]) -> IdleMotion:
        """Describe the motions of a row by the names of parts and coordinates; `rates` are those of its motions."""
        joints, rows_of, order = self._linkage.joints, self._graph.parts_of, self._linkage.structure.parts.index
        shows = [
            self._found.columns[k] for k in np.flatnonzero((np.abs(rates) > self._found.thresholds.rate).any(axis=0))
        ]
        return IdleMotion(
            tuple(sorted((part for body in row.moving for part in rows_of[body]), key=order)),
            kind,
            tuple(sorted(set(row.resting) - self._left_out, key=order)),
            tuple(joints[joint].full_names[k] for joint, k in shows),
        )


def _centre(twists: Twists, noise: float) -> Float[np.ndarray, "3"] | None:
    """Find the one point about which all these twists turn; None where there is no such point or more than one."""
    cross = np.concatenate([np.zeros((0, 3)), *(-skew(w) for w in twists[:3].T)])
    if np.linalg.matrix_rank(cross, tol=noise) < 3:
        return None
    velocities = twists[3:].T.ravel()
    point = np.linalg.lstsq(cross, velocities, rcond=None)[0]
    return point if np.abs(cross @ point - velocities).max() < noise else None


def _bracket(twists: Twists) -> Constraints:
    """Compute the constraints on a twist that carries these twists into themselves: their Lie brackets vanish."""
    rows = np.zeros((twists.shape[1], 6, 6))
    for block, w, v in zip(rows, twists[:3].T, twists[3:].T, strict=True):
        block[:3, :3] = block[3:, 3:] = skew(w)
        block[3:, :3] = skew(v)
    return rows.reshape(-1, 6)


def _complement(twists: Twists, noise: float) -> Constraints:
    """Compute an orthonormal basis, one a row, of the complement of the span of these twists."""
    basis, sizes, _ = np.linalg.svd(twists)
    return basis[:, int((sizes > noise).sum()) :].T
