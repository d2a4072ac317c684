"""The loops of a system as tables of elementary motions: what the closure kernel runs through, joint by joint.

An elementary motion turns about and slides along the z axis of its own frame, or turns as a ball does. The tables are
host data, made once for a system. An uncut loop is one chain of elementary motions, closed in itself; a loop that is
cut at a ball is one chain from one side of the ball to the other; a loop that is cut at both balls of a rod is two
chains, from ball to ball. Shorter chains are filled up with rows that do nothing.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.solve.system.loop_system import LoopSystem

AXES = np.stack([np.roll(np.eye(3), axis + 1, axis=0) for axis in range(3)])
"""Rotations that carry z to x, y, z (and keep the order of the axes), by the number of the axis."""

Z_AXIS = 2
"""Number of the axis that `AXES` leaves where it is: for rows without an axis of their own."""


class ChainRow(NamedTuple):
    """One elementary motion of a chain; one entry of each of the tables of the same names."""

    column: int
    """Column of the coordinate; the number of columns, which holds zero, where there is none."""
    joint: int
    sign: int
    """+1, or -1 where the joint is travelled from part 2 to part 1; 0 for rows that do nothing."""
    turn: int
    """1 where the coordinate turns, else 0."""
    slide: int
    """1 where the coordinate slides, else 0."""
    screw: int
    """1 where the coordinate slides by the pitch of the joint as well, else 0."""
    ball: int
    """Number of the ball that turns; the number of balls where none does."""
    side: int
    """+1, or -1 where the axes that its columns turn a ball about turn with it: a line of centres."""
    axis: int
    """Number of the axis of the frame that is the z axis of the elementary motion."""
    enter: int
    """Number of the frame in which it begins: frames on parts 1, frames on parts 2, then "no frame"."""
    leave: int
    """Number of the frame in which it ends."""


class ChainEnds(NamedTuple):
    """Where a chain begins and ends."""

    begin: int
    """Number of the frame in which the chain begins: "no frame", or the frame behind the ball where the loop is cut."""
    end: int
    """Number of the frame in which it ends: "no frame", or the frame before a ball."""
    cut_ball: int
    """Number of the ball behind which it begins; the number of balls where the loop is uncut."""
    cut_sign: int
    """+1, or -1 where that ball is travelled from part 2 to part 1; 0 where the loop is uncut."""


class Chain(NamedTuple):
    """A chain of elementary motions."""

    rows: list[ChainRow]
    ends: ChainEnds


class ChainTables(NamedTuple):
    """Tables of shape (rows, chains), of `ChainRow` and `ChainEnds`; the first chain of every loop comes first, then
    the second chains of the loops that are cut at a rod."""

    column: np.ndarray
    joint: np.ndarray
    sign: np.ndarray
    turn: np.ndarray
    slide: np.ndarray
    screw: np.ndarray
    ball: np.ndarray
    """Index of the quaternion of a ball in the `State`; the number of quaternions, which holds no turn, where there is
    none."""
    side: np.ndarray
    axis: np.ndarray
    enter: np.ndarray
    leave: np.ndarray
    begin: np.ndarray
    """(chains,), as `end`, `cut_ball` and `cut_sign`."""
    end: np.ndarray
    cut_ball: np.ndarray
    cut_sign: np.ndarray
    source: np.ndarray
    """(columns, chains): number of the twist that is the column of the Jacobian, counted four a row (z, then the three
    of a ball), or one a row where there is no ball; the number of twists, which holds zero, where the chain does not
    hold the coordinate."""
    rods: np.ndarray
    """(2, rods): numbers of both chains of each loop that is cut at a rod."""


@lru_cache(maxsize=256)
def chain_tables(system: LoopSystem) -> ChainTables:
    """The tables of a system."""
    by_loop = [_chains(system, loop, cut) for loop, cut in zip(system.loops, system.cuts, strict=True)]
    of_rods = [number for number, chains in enumerate(by_loop) if len(chains) > 1]
    chains = [*(first for first, *_ in by_loop), *(by_loop[number][1] for number in of_rods)]
    length = max(len(chain.rows) for chain in chains)
    no_row = _no_row(system)
    filled = np.array([chain.rows + [no_row] * (length - len(chain.rows)) for chain in chains], np.int32)
    rows = dict(zip(ChainRow._fields, np.moveaxis(filled, -1, 0).swapaxes(1, 2), strict=True))
    ends = dict(zip(ChainEnds._fields, np.array([chain.ends for chain in chains], np.int32).T, strict=True))
    source = _sources(system, rows["column"], rows["ball"])
    quaternion = np.full(len(system.balls) + 1, len(system.turned_balls), np.int32)
    quaternion[list(system.turned_balls)] = np.arange(len(system.turned_balls))
    rows["ball"] = quaternion[rows["ball"]]
    rods = np.array([of_rods, np.arange(len(by_loop), len(chains))], np.int32)
    return ChainTables(**rows, **ends, source=source, rods=rods)


def _sources(system: LoopSystem, column: np.ndarray, ball: np.ndarray) -> np.ndarray:
    """`ChainTables.source` from the columns and the numbers of balls of all rows, each (rows, chains)."""
    length, chains = column.shape
    twists_a_row = 4 if system.turned_balls else 1
    source = np.full((system.columns, chains), twists_a_row * length, np.int32)
    for (row, chain), coordinate in np.ndenumerate(column):
        if coordinate < system.columns:
            source[coordinate, chain] = twists_a_row * row
    for (row, chain), number in np.ndenumerate(ball):
        if number < len(system.balls):
            columns = system.balls[number]
            source[list(columns), chain] = 4 * row + 1 + np.arange(len(columns))
    return source


def _frames(system: LoopSystem) -> int:
    """Number of frames on the first parts of all joints: as many on the second parts, and behind those "no frame"."""
    return sum(map(len, system.movements))


def _no_row(system: LoopSystem) -> ChainRow:
    """A row that does nothing."""
    no_frame = 2 * _frames(system)
    return ChainRow(
        column=system.columns,
        joint=0,
        sign=0,
        turn=0,
        slide=0,
        screw=0,
        ball=len(system.balls),
        side=1,
        axis=Z_AXIS,
        enter=no_frame,
        leave=no_frame,
    )


def _chains(system: LoopSystem, loop: tuple[tuple[int, int], ...], cut: tuple[int, ...]) -> list[Chain]:
    """The chains of a loop that is cut at some balls, each from behind one ball to before the next; of an uncut loop
    one chain."""
    rows = [row for joint, sign in loop for row in _joint_rows(system, joint, sign)]
    if not cut:
        no_frame = 2 * _frames(system)
        return [Chain(rows, ChainEnds(no_frame, no_frame, len(system.balls), 0))]
    places = [number for number, row in enumerate(rows) if row.ball in cut]
    chains = []
    for place, following in zip(places, [*places[1:], places[0]], strict=True):
        ball = rows[place]
        between = rows[place + 1 : following] if place < following else rows[place + 1 :] + rows[:following]
        chains.append(Chain(between, ChainEnds(ball.leave, rows[following].enter, ball.ball, ball.sign)))
    return chains


def _joint_rows(system: LoopSystem, joint: int, sign: int) -> list[ChainRow]:
    """The rows of a joint that is travelled from part 1 to part 2 (sign +1) or back (-1)."""
    turned_as_ball = {column for columns in system.balls for column in columns}
    first_frame = tuple(accumulate(map(len, system.movements), initial=0))[joint]
    frames, no_row = _frames(system), _no_row(system)
    rows: list[ChainRow] = []
    for name, frame, column, ball in system.chains[joint][::sign]:
        on_part1 = first_frame + frame
        on_part2 = frames + on_part1
        motions = [each for each in MOVEMENTS[name].elements if column + each.coordinate not in turned_as_ball]
        if ball is not None or not motions:
            of_ball = {} if ball is None else {"ball": ball, "side": -1 if len(system.balls[ball]) == 2 else 1}
            here = [no_row._replace(joint=joint, sign=sign, **of_ball)]
        else:
            here = [
                no_row._replace(
                    column=column + each.coordinate,
                    joint=joint,
                    sign=sign,
                    turn=int(each.kind != "translate"),
                    slide=int(each.kind == "translate"),
                    screw=int(each.kind == "screw"),
                    axis=each.axis,
                )
                for each in motions[::sign]
            ]
        # all motions of one movement share its frame: only the first one enters it, and only the last one leaves it
        enter, leave = (on_part1, on_part2)[::sign]
        here[0] = here[0]._replace(enter=enter)
        here[-1] = here[-1]._replace(leave=leave)
        rows += here
    return rows
