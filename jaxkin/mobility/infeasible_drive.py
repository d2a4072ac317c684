"""Drives that a mechanism cannot follow, or that leave it free, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from jaxkin._names import listed
from jaxkin.linkage.first_order import independent
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.blocking_contacts import freeing
from jaxkin.mobility.loop_freedoms import LoopFreedoms
from jaxkin.mobility.mobility import drivable, largest, names
from jaxkin.mobility.needless import spinning

Coordinate = tuple[int, int]
"""(joint, coordinate)."""


def dead_end(mechanism: Mechanism, driven: Sequence[Coordinate]) -> str | None:
    """Why the loops cannot follow a drive of these coordinates; None where they can, or where it is not sure.

    It is sure where the rates cannot be given at the assembled pose nor at a pose beside it: at a singular pose, where
    the motion may branch, the drive is left to the solver. What is to be driven instead can be given at both poses,
    where there is such.
    """
    for found, columns in _driven_blocks(mechanism, driven):
        if _follows(found, columns):
            continue
        given = names(mechanism, found, columns)
        if not len(found.motions):
            said = f"{listed(given)} cannot be driven: {_mechanism_of(found)} has no freedom"
            return f"{said}; {_what_holds(mechanism, found)}"
        choices = _choices(found)
        movable = {column for group in choices for column in group}
        if stuck := names(mechanism, found, [column for column in columns if column not in movable]):
            what = "has no freedom left to it" if len(stuck) == 1 else "have no freedom left to them"
            others = _or(mechanism, found, _surest(found, choices))
            return f"{listed(stuck)} {what} by the loops" + (f"; what can be driven is {others}" if others else "")
        kept = largest(found, sorted(columns, key=[c for group in choices for c in group].index))
        freedoms = f"{len(found.motions)} freedom{'' if len(found.motions) == 1 else 's'}"
        if len(kept) < len(found.motions):
            freedoms += f", {len(kept)} of them for these"
        instead = f"drive only {listed(names(mechanism, found, sorted(kept)))}"
        others = [group for group in _surest(found, choices) if not set(group) & set(kept)]
        if len(kept) == 1 and others:
            instead += f", or one of {_or(mechanism, found, others)}"
        return f"driven {listed(given)}, but {_mechanism_of(found)} has {freedoms}: {instead}"
    return None


def _follows(found: LoopFreedoms, columns: Sequence[int]) -> bool:
    """Whether the rates of these columns can be given, at the assembled pose or beside it."""
    return any(independent(motions, columns, found.noise) == len(columns) for motions in (found.at_rest, found.motions))


def _choices(found: LoopFreedoms) -> list[tuple[int, ...]]:
    """The columns that can be driven, alone or as the angles of a ball: first those that can at the assembled pose."""
    groups = dict.fromkeys(found.driven_together.values())
    movable = [group for group in groups if independent(found.motions, group, found.noise) == len(group)]
    surest = _surest(found, movable)
    return [*surest, *(group for group in movable if group not in surest)]


def _surest(found: LoopFreedoms, choices: Sequence[tuple[int, ...]]) -> Sequence[tuple[int, ...]]:
    """Those that can be driven at the assembled pose too, if there are such: not a slide at its dead centre."""
    at_rest = [group for group in choices if independent(found.at_rest, group, found.noise) == len(group)]
    return at_rest or choices


def _or(mechanism: Mechanism, found: LoopFreedoms, groups: Sequence[Sequence[int]]) -> str:
    """The names of columns to choose from, the angles of a ball together."""
    return listed([" with ".join(names(mechanism, found, group)) for group in groups])


def _what_holds(mechanism: Mechanism, found: LoopFreedoms) -> str:
    """The contacts or joints without which the loops could move."""
    rows = {row for pair in found.ends.values() for row in pair}
    row_of = mechanism.structure.row_of
    ways = [way for way in freeing(mechanism) if rows & {row_of[part] for part in way.parts}]
    if not ways:
        return "no single contact or joint is the reason"
    return f"without one of these it would have some: {'; '.join(map(str, ways))}"


def left_free(mechanism: Mechanism, driven: Sequence[Coordinate]) -> tuple[str, ...]:
    """Coordinates that could be driven as well in the loops that a drive moves; idle ones are not among them."""
    return tuple(
        name
        for found, columns in _driven_blocks(mechanism, driven)
        for name in names(mechanism, found, drivable(mechanism, found, columns, spinning(mechanism)))
    )


def _mechanism_of(found: LoopFreedoms) -> str:
    """The loops of a structure element by some of its parts."""
    parts = dict.fromkeys(part for pair in found.ends.values() for part in pair)
    return f"the mechanism of {listed([part for part in parts if part != found.fixed])}"


def _driven_blocks(mechanism: Mechanism, driven: Sequence[Coordinate]) -> Iterator[tuple[LoopFreedoms, list[int]]]:
    """The loops that hold a driven coordinate, with its columns; of loops that cannot be closed nothing is known."""
    for found in mechanism.loop_freedoms:
        columns = [column for column, owner in enumerate(found.columns) if owner in driven]
        if columns and found.closes:
            yield found, columns
