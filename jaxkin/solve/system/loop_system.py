"""A system of closed loops as the solver sees it: static, hashable, without numbers.

The joints of one structure element (a single or multiple closed loop) and the loops that run through them, with the
coordinates that are driven. Coordinates of all joints stand one after another as columns of the Jacobian.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, product

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.screws import freedoms
from jaxkin.linkage.loop_class import LoopClass

EQUATIONS, IN_PLANE, CENTRE, LENGTH = 6, 3, 3, 1
"""Independent equations a loop at most: three of rotation, three of translation (of the twelve of Eq. 11); in a plane
one and two; cut at a ball the latter three, at both balls of a rod one. Of a loop that turns about one direction only,
one and three."""


@dataclass(frozen=True)
class LoopSystem:
    """Loops that share joints, and which of their coordinates are given."""

    movements: tuple[tuple[str, ...], ...]
    """For each joint the keys of `MOVEMENTS` of its frames."""
    loops: tuple[tuple[tuple[int, int], ...], ...]
    """For each loop its joints in order of travel with +1, or -1 where travelled from part 2 to part 1."""
    driven: tuple[int, ...]
    """Columns whose values are given."""
    loop_class: LoopClass
    """What is special about the loops, so that they need fewer equations."""
    order: tuple[tuple[int, ...], ...] = ()
    """Numbers of the loops that are solved together, in turn: each loop once. By default all loops are."""

    def __post_init__(self) -> None:
        if not self.order:
            object.__setattr__(self, "order", (tuple(range(len(self.loops))),))

    @cached_property
    def chains(self) -> tuple[tuple[tuple[str, int, int, int | None], ...], ...]:
        """For each joint its movements: key of `MOVEMENTS`, frame, first column, number of its ball if it is one."""
        chains = []
        for joint, movements in enumerate(self.movements):
            column, chain = self._first_columns[joint], []
            for frame, name in enumerate(movements):
                chain.append((name, frame, column, self.places.get((joint, frame), (None,))[0]))
                column += len(MOVEMENTS[name].coordinates)
            chains.append(tuple(chain))
        return tuple(chains)

    @cached_property
    def balls(self) -> tuple[tuple[int, ...], ...]:
        """The columns that turn each ball about the axes of its frame: three, or the first two of a line of centres.

        Ball pairs come first, then what would lock if it were solved by its angles.
        """
        return tuple(columns for _, columns in self.places.values())

    @cached_property
    def _first_columns(self) -> tuple[int, ...]:
        return tuple(accumulate(map(freedoms, self.movements), initial=0))

    @cached_property
    def places(self) -> dict[tuple[int, int], tuple[int, tuple[int, ...]]]:
        """Joint and frame of each ball -> its number and its columns, by rising number."""
        pairs, locking = {}, {}
        for joint, movements in enumerate(self.movements):
            column = self._first_columns[joint]
            given = not set(self.driven).isdisjoint(self.span(joint))
            for frame, name in enumerate(movements):
                if MOVEMENTS[name].ball:
                    pairs[joint, frame] = (column, column + 1, column + 2)
                lock = MOVEMENTS[name].lock
                follows = lock is not None and movements[frame + 1 : frame + 2] == (lock.follower,)
                if lock and follows and not given:  # a single angle can be driven only where it is one
                    locking[joint, frame + lock.ball] = tuple(column + k for k in lock.columns)
                column += len(MOVEMENTS[name].coordinates)
        return {place: (number, columns) for number, (place, columns) in enumerate((pairs | locking).items())}

    @cached_property
    def is_length(self) -> tuple[bool, ...]:
        """For each column whether it is a translation."""
        return tuple(
            name in ("x", "y", "z")
            for movements in self.movements
            for movement in movements
            for name in MOVEMENTS[movement].coordinates
        )

    def span(self, joint: int) -> range:
        """The columns of a joint."""
        first = self._first_columns[joint]
        return range(first, first + freedoms(self.movements[joint]))

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        return len(self.is_length)

    @property
    def planar(self) -> bool:
        """Whether all coordinates act in one plane; those of the joints along its normal are no columns then."""
        return self.loop_class.plane is not None

    @cached_property
    def cuts(self) -> tuple[tuple[int, ...], ...]:
        """For each loop the balls that it is cut at: one, both of a rod, or none.

        A ball that is in no other loop turns as the rest of the loop wants it: what remains of the loop is that its
        centre stays where it is, three equations in three coordinates less. What remains of a rod between two such
        balls is that it keeps their centres at its length: one equation in six coordinates less.
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
        """The numbers of the balls whose turns are unknowns, or given: those at which no loop is cut."""
        return tuple(sorted(set(range(len(self.balls))).difference(*self.cuts)))

    def _may_be_cut(self, columns: tuple[int, ...]) -> bool:
        return len(columns) == 3 and columns[0] not in self.driven

    @cached_property
    def spins(self) -> tuple[tuple[int, int, int, int], ...]:
        """See `LoopClass`; without those of balls that are driven."""
        free = [columns[0] not in self.driven for columns in self.balls]
        return tuple(spin for spin in self.loop_class.spins if free[spin[0]] and free[spin[1]])

    @property
    def spinning(self) -> bool:
        """Whether the spin of any rod is left to the solver."""
        return any(ball in self.turned_balls for one, other, *_ in self.spins for ball in (one, other))

    @property
    def uncut(self) -> LoopSystem:
        """The same with no loop cut."""
        return replace(self, loop_class=self.loop_class._replace(cut_at_balls=False))

    @cached_property
    def rotations(self) -> tuple[int, ...]:
        """For each loop in space the number of its equations of rotation."""
        one = self.loop_class.schoenflies
        return tuple(0 if cut else 1 if loop in one else 3 for loop, cut in enumerate(self.cuts))

    @cached_property
    def translations(self) -> tuple[int, ...]:
        """For each loop in space the number of its equations of translation, or of the length of a rod."""
        return tuple(CENTRE if len(cut) < 2 else LENGTH for cut in self.cuts)

    @cached_property
    def rows(self) -> tuple[tuple[int, ...], ...]:
        """For each loop its rows of the Jacobian: see `Closure.residual`."""
        if self.planar:
            return tuple(tuple(range(IN_PLANE * loop, IN_PLANE * (loop + 1))) for loop in range(len(self.loops)))
        rows: list[tuple[int, ...]] = [()] * len(self.loops)
        first = 0
        for counts, size in product((self.rotations, self.translations), (3, 1)):
            for loop, count in enumerate(counts):
                if count == size:
                    rows[loop] += tuple(range(first, first + size))
                    first += size
        return tuple(rows)

    @cached_property
    def equations(self) -> int:
        """Number of rows of the Jacobian."""
        return sum(map(len, self.rows))

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Columns to be solved for."""
        return tuple(column for column in range(self.columns) if column not in self.driven)

    @cached_property
    def used(self) -> tuple[int, ...]:
        """The columns that are solved for: no others of the Jacobian count."""
        follows = {column for cut in self.cuts for ball in cut for column in self.balls[ball]}
        return tuple(column for column in self.free if column not in follows)

    @cached_property
    def periodic(self) -> bool:
        """Whether a single coordinate is driven and it is an angle: a full turn more is the same input."""
        if len(self.driven) != 1:
            return False
        (driven,) = self.driven
        for chain in self.chains:
            for name, _, column, _ in chain:
                for element in MOVEMENTS[name].elements:
                    if column + element.coordinate == driven:
                        return element.kind == "rotate" and not MOVEMENTS[name].ball
        return False
