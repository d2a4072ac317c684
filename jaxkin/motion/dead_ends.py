"""Drives that a mechanism cannot follow, or that leave it free, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from jaxkin.motion.freedoms import LoopFreedoms
from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.mobility import drivable, largest, moving_columns, names
from jaxkin.motion.needless import spinning
from jaxkin.topology.names import listed
from jaxkin.topology.rates import independent

Coordinate = tuple[int, int]
"""(joint, coordinate)."""


def dead_end(mechanism: Mechanism, driven: Sequence[Coordinate]) -> str | None:
    """Why the loops cannot follow a drive of these coordinates; None where they can, or where it is not sure.

    It is sure where the rates cannot be given at the assembled pose nor at a pose beside it: at a singular pose, where
    the motion may branch, the drive is left to the solver.
    """
    for found, columns in _driven_blocks(mechanism, driven):
        if independent(found.at_rest, columns, found.noise) == len(columns):
            continue
        if independent(found.motions, columns, found.noise) == len(columns):
            continue
        given = names(mechanism, found, columns)
        movable = moving_columns(found, found.motions)
        others = names(mechanism, found, movable)
        if not others:
            return f"{listed(given)} cannot be driven: {_mechanism_of(found)} has no freedom; look for a joint too many"
        if stuck := names(mechanism, found, [column for column in columns if column not in movable]):
            what = "has no freedom left to it" if len(stuck) == 1 else "have no freedom left to them"
            return f"{listed(stuck)} {what} by the loops; what can be driven is {listed(others)}"
        kept = largest(found, columns)
        freedoms = f"{len(found.motions)} freedom{'' if len(found.motions) == 1 else 's'}"
        if len(kept) < len(found.motions):
            freedoms += f", {len(kept)} of them for these"
        instead = f"drive only {listed(names(mechanism, found, kept))}"
        if len(kept) == 1:
            instead += f", or one of {listed(names(mechanism, found, [c for c in movable if c not in kept]))}"
        return f"driven {listed(given)}, but {_mechanism_of(found)} has {freedoms}: {instead}"
    return None


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
    """The loops that hold a driven coordinate, with its columns."""
    for found in mechanism.loop_freedoms:
        if columns := [column for column, owner in enumerate(found.columns) if owner in driven]:
            yield found, columns
