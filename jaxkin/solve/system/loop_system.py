"""Describe a system of closed loops for the solver: static, hashable, without floating-point numbers.

A loop system holds the joints of one loop group, the loops through these joints, the couplings between them, the
coordinates that are driven, and the order of solution. The coordinates of all joints, one joint after another, are the
columns of the Jacobian.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from typing import NamedTuple

from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.joints.screws import freedoms
from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.linkage.loop_class import LoopClass


class Sections(NamedTuple):
    """The loops in space by their kinds of equations, in the order of the rows of the Jacobian.

    A loop may be in two sections: that of its rotation, and that of its translation.
    """

    rotation: tuple[int, ...]
    """Numbers of the loops with three equations of rotation."""
    spherical: tuple[int, ...]
    """Numbers of the loops whose axes meet in one point: three equations in all."""
    one_rotation: tuple[int, ...]
    """Numbers of the loops that turn about one direction only: one equation of rotation."""
    translation: tuple[int, ...]
    """Numbers of the loops with three equations of translation; a loop that is cut at a ball has no others."""
    rod_length: tuple[int, ...]
    """Numbers of the loops that are cut at both balls of a rod: one equation, for the length of the rod."""


EQUATIONS_OF = (3, 3, 1, 3, 1)
"""Number of equations of a loop in each of the `Sections`."""


class PlacedMovement(NamedTuple):
    """A movement of a joint, with its place in the loop system."""

    movement: str
    """Key of `MOVEMENTS`."""
    frame: int
    """Number of the frame of the joint in which it moves."""
    column: int
    """First column of its coordinates."""
    ball: int | None
    """Number of the ball that this movement rotates; None for other movements."""


@dataclass(frozen=True)
class LoopSystem:
    """The loops and couplings of a loop group, the driven columns, the class of the loops and the order of solution."""

    movements: tuple[tuple[str, ...], ...]
    """For each joint the keys of `MOVEMENTS` of its frames."""
    loops: tuple[tuple[tuple[int, int], ...], ...]
    """For each loop (joint, sign) in order of travel: +1 where travelled from part 1 to part 2, else -1."""
    driven: tuple[int, ...]
    """Columns of the driven coordinates, ascending."""
    loop_class: LoopClass
    """Properties by which the loops need fewer equations."""
    order: tuple[tuple[int, ...], ...] = ()
    """Groups in order of solution, each the numbers of the loops and couplings that are solved together; each is in one
    group. Couplings are numbered behind the loops. By default all are one group."""
    couplings: tuple[tuple[int, ...], ...] = ()
    """For each coupling the columns of the coordinates that it ties."""

    def __post_init__(self) -> None:
        if not self.order:
            object.__setattr__(self, "order", (tuple(range(len(self.loops) + len(self.couplings))),))

    @cached_property
    def chains(self) -> tuple[tuple[PlacedMovement, ...], ...]:
        """For each joint its movements, from part 1 to part 2."""
        return tuple(
            tuple(
                PlacedMovement(name, frame, own.start, self.places.get((joint, frame), (None,))[0])
                for frame, (name, own) in enumerate(zip(movements, self._movement_columns[joint], strict=True))
            )
            for joint, movements in enumerate(self.movements)
        )

    @cached_property
    def balls(self) -> tuple[tuple[int, ...], ...]:
        """For each ball the columns of its rotation about the axes of its frame: three, or two
        for the line between the centres of two balls (contact state p).

        Ball pairs come first, then the balls that replace pairs of movements whose angles would lock.
        """
        return tuple(columns for _, columns in self.places.values())

    @cached_property
    def _first_columns(self) -> tuple[int, ...]:
        return tuple(accumulate(map(freedoms, self.movements), initial=0))

    @cached_property
    def _movement_columns(self) -> tuple[tuple[range, ...], ...]:
        """For each joint the columns of each of its movements."""
        ranges = iter(coordinate_ranges(name for movements in self.movements for name in movements))
        return tuple(tuple(next(ranges) for _ in movements) for movements in self.movements)

    @cached_property
    def places(self) -> dict[tuple[int, int], tuple[int, tuple[int, ...]]]:
        """(joint, frame) of each ball -> its number and its columns, by rising number."""
        pairs, locking = {}, {}
        for joint, movements in enumerate(self.movements):
            given = not set(self.driven).isdisjoint(self.span(joint))
            for frame, (name, columns) in enumerate(zip(movements, self._movement_columns[joint], strict=True)):
                # a ball driven by some of its angles is a chain of three turns, of which the others are unknown
                if MOVEMENTS[name].ball and sum(k in self.driven for k in columns) in (0, len(columns)):
                    pairs[joint, frame] = tuple(columns)
                lock = MOVEMENTS[name].lock
                follows = lock is not None and movements[frame + 1 : frame + 2] == (lock.follower,)
                if lock and follows and not given:  # a pair with a driven coordinate keeps its angles
                    locking[joint, frame + lock.ball] = tuple(columns.start + k for k in lock.columns)
        return {place: (number, columns) for number, (place, columns) in enumerate((pairs | locking).items())}

    def axes(self, joints: Iterable[int]) -> list[tuple[int, int]]:
        """List (frame, axis) of each elementary motion of some joints; frames are numbered through all joints."""
        first = tuple(accumulate(map(len, self.movements), initial=0))
        return [
            (first[joint] + frame, element.axis)
            for joint in joints
            for frame, name in enumerate(self.movements[joint])
            for element in MOVEMENTS[name].elements
        ]

    @cached_property
    def is_length(self) -> tuple[bool, ...]:
        """For each column whether it is a translation."""
        return tuple(
            is_length(name)
            for movements in self.movements
            for movement in movements
            for name in MOVEMENTS[movement].coordinates
        )

    def span(self, joint: int) -> range:
        """List the columns of a joint."""
        first = self._first_columns[joint]
        return range(first, first + freedoms(self.movements[joint]))

    @cached_property
    def curves(self) -> tuple[tuple[int, int], ...]:
        """(joint, frame) of each movement that travels along a curve or over a surface, in order."""
        return tuple(
            (joint, frame)
            for joint, movements in enumerate(self.movements)
            for frame, name in enumerate(movements)
            if MOVEMENTS[name].follows
        )

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        return len(self.is_length)

    @property
    def planar(self) -> bool:
        """Whether all coordinates act in one plane; coordinates out of the plane are no columns then."""
        return self.loop_class.plane is not None

    @cached_property
    def cuts(self) -> tuple[tuple[int, ...], ...]:
        """For each loop the balls at which it is cut: none, one, or both balls of a rod.

        A ball that is in no other loop takes up whatever rotation the rest of the loop leaves. The loop then only
        demands that the centres of both sides of the ball coincide: three equations, and three coordinates less. A rod
        between two such balls only demands that their centres are at its length: one equation, and six coordinates
        less.
        """
        if self.planar or not self.loop_class.cut_at_balls:
            return ((),) * len(self.loops)
        inside = [
            {ball for joint, _ in loop for *_, ball in self.chains[joint] if ball is not None} for loop in self.loops
        ]
        found = []
        for number, here in enumerate(inside):
            elsewhere = set().union(*inside[:number], *inside[number + 1 :])
            mine = [ball for ball in sorted(here - elsewhere) if self._may_be_cut(self.balls[ball])]
            rods = [(one, other) for one, other, *_ in self.spins if one in mine and other in mine]
            found.append(rods[-1] if rods else tuple(mine[-1:]))
        return tuple(found)

    @cached_property
    def turned_balls(self) -> tuple[int, ...]:
        """The numbers of the balls whose rotations are unknown or driven: those at which no loop is cut."""
        return tuple(sorted(set(range(len(self.balls))).difference(*self.cuts)))

    def _may_be_cut(self, columns: tuple[int, ...]) -> bool:
        """Tell whether a loop may be cut at the ball with these columns: not driven, and no line of centres."""
        return len(columns) == 3 and columns[0] not in self.driven

    @cached_property
    def spins(self) -> tuple[tuple[int, int, int, int], ...]:
        """`LoopClass.spins` with the numbers of `balls`, without rods that have a driven ball."""
        pairs = [
            (joint, frame)
            for joint, movements in enumerate(self.movements)
            for frame, name in enumerate(movements)
            if MOVEMENTS[name].ball
        ]
        undriven = {place: number for place, (number, columns) in self.places.items() if columns[0] not in self.driven}
        free = [undriven.get(place, -1) for place in pairs]
        numbered = [(free[one], free[other], side, end) for one, other, side, end in self.loop_class.spins]
        return tuple(spin for spin in numbered if min(spin[:2]) >= 0)

    @property
    def spinning(self) -> bool:
        """Whether least-norm steps decide the idle spin of any rod: of a rod at which no loop is cut at both balls."""
        return any(ball in self.turned_balls for one, other, *_ in self.spins for ball in (one, other))

    @property
    def uncut(self) -> LoopSystem:
        """The same system with no loop cut at a ball."""
        return replace(self, loop_class=self.loop_class._replace(cut_at_balls=False))

    @cached_property
    def sections(self) -> Sections:
        """The loops in space by their kinds of equations."""
        one, about_point = self.loop_class.schoenflies, self.loop_class.spherical
        uncut = [loop for loop, cut in enumerate(self.cuts) if not cut]
        spherical = tuple(loop for loop in uncut if loop in about_point)
        return Sections(
            rotation=tuple(loop for loop in uncut if loop not in one and loop not in about_point),
            spherical=spherical,
            one_rotation=tuple(loop for loop in uncut if loop in one),
            translation=tuple(loop for loop, cut in enumerate(self.cuts) if len(cut) < 2 and loop not in spherical),
            rod_length=tuple(loop for loop, cut in enumerate(self.cuts) if len(cut) > 1),
        )

    @cached_property
    def rows(self) -> tuple[tuple[int, ...], ...]:
        """For each loop, then for each coupling, the numbers of its rows of the Jacobian: see `Closure.residual`."""
        rows: list[tuple[int, ...]] = [()] * len(self.loops)
        every = tuple(range(len(self.loops)))
        sections = [(every, IN_SUBGROUP)] if self.planar else zip(self.sections, EQUATIONS_OF, strict=True)
        first = 0
        for loops, size in sections:
            for loop in loops:
                rows[loop] += tuple(range(first, first + size))
                first += size
        return (*rows, *((first + number,) for number in range(len(self.couplings))))

    @cached_property
    def loop_equations(self) -> int:
        """Number of rows of the Jacobian without those of the couplings, which come last."""
        return sum(map(len, self.rows[: len(self.loops)]))

    def columns_of(self, number: int) -> set[int]:
        """List the columns that a loop passes, or that a coupling ties, by the number that `order` gives it."""
        if number >= len(self.loops):
            return set(self.couplings[number - len(self.loops)])
        return {column for joint, _ in self.loops[number] for column in self.span(joint)}

    @cached_property
    def equations(self) -> int:
        """Number of rows of the Jacobian."""
        return sum(map(len, self.rows))

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Columns that are not driven."""
        return tuple(column for column in range(self.columns) if column not in self.driven)

    @cached_property
    def used(self) -> tuple[int, ...]:
        """Columns that the equations are solved for: all that are not driven, nor of a ball at which a loop is cut."""
        follows = {column for cut in self.cuts for ball in cut for column in self.balls[ball]}
        return tuple(column for column in self.free if column not in follows)

    @cached_property
    def periodic(self) -> bool:
        """Whether the only driven coordinate is the angle of a rotation: a full turn more is then the same input."""
        if len(self.driven) != 1 or self.couplings:  # behind a gear a full turn more is another pose
            return False
        (driven,) = self.driven
        for chain in self.chains:
            for name, _, column, _ in chain:
                for element in MOVEMENTS[name].elements:
                    if column + element.coordinate == driven:
                        return element.kind == "rotate" and element.law is None and not MOVEMENTS[name].ball
        return False
