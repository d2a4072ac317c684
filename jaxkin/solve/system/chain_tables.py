"""Write the loops of a system as tables of elementary motions, which the closure kernels run through row by row.

An elementary motion is a rotation about or a translation along the z axis of its own frame, or both (a screw), or the
rotation of a ball. The tables are host data, made once for a system. An uncut loop is one closed chain of elementary
motions; a loop that is cut at a ball is one chain from one side of the ball to the other; a loop that is cut at both
balls of a rod is two chains, from ball to ball. Shorter chains are padded with rows that do nothing.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple, get_args

import numpy as np

from jaxkin.geometry.elementary_motions import FollowedLaw
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.solve.system.loop_system import LoopSystem

AXES = np.stack([np.roll(np.eye(3), axis + 1, axis=0) for axis in range(3)])
"""For each axis a rotation matrix that carries z to it, a cyclic permutation of the axes: (3, 3, 3)."""

LAWS: tuple[FollowedLaw | None, ...] = (None, *get_args(FollowedLaw))
"""The functions of curves and surfaces that elementary motions follow (`ElementaryMotion.law`), by their numbers in the
tables."""

Z_AXIS = 2
"""Number of the z axis, which `AXES` does not move: for rows without an axis of their own."""


class ChainRow(NamedTuple):
    """One elementary motion of a chain: one entry of each table of the same name."""

    column: int
    """Column of the coordinate; if there is none, the number of columns, where a zero is appended."""
    joint: int
    """Number of the joint in the system."""
    sign: int
    """+1, or -1 where the joint is travelled from part 2 to part 1, or the motion is the inverse of its law; 0 for rows
    that do nothing."""
    turn: int
    """1 if the coordinate is an angle, else 0."""
    slide: int
    """1 if the coordinate is a length, else 0."""
    screw: int
    """1 if the coordinate is an angle that also advances by the pitch of the joint, else 0."""
    law: int
    """Number of the function (`LAWS`) of a curve or a surface that is the angle or length; 0 where it is the coordinate
    itself."""
    curve: int
    """Number of that curve in `LoopSystem.curves`; 0 for none."""
    ball: int
    """Number of the ball that rotates; the number of balls if none does."""
    side: int
    """+1 if the columns of the ball rotate it about axes of part 1, -1 about axes that rotate with it (line of
    centres)."""
    axis: int
    """Number of the axis of the frame that is the z axis of the elementary motion."""
    enter: int
    """Number of the frame in which the motion begins; all frames on parts 1 come first, then those on parts 2, then "no
    frame" (the identity)."""
    leave: int
    """Number of the frame in which the motion ends."""


class ChainEnds(NamedTuple):
    """Where a chain begins and ends."""

    begin: int
    """Number of the frame in which the chain begins: "no frame", or the frame behind the ball where the loop is cut."""
    end: int
    """Number of the frame in which the chain ends: "no frame", or the frame before a ball."""
    cut_ball: int
    """Number of the ball behind which the chain begins; the number of balls if the loop is uncut."""
    cut_sign: int
    """+1, or -1 if that ball is travelled from part 2 to part 1; 0 if the loop is uncut."""


class LoopChain(NamedTuple):
    """A chain of elementary motions, in order of travel."""

    rows: list[ChainRow]
    ends: ChainEnds


class ChainTables(NamedTuple):
    """The entries of `ChainRow` as tables (rows, chains), and those of `ChainEnds` as tables (chains,).

    The first chains of all loops come first, then the second chains of the loops that are cut at a rod.
    """

    column: np.ndarray
    joint: np.ndarray
    sign: np.ndarray
    turn: np.ndarray
    slide: np.ndarray
    screw: np.ndarray
    law: np.ndarray
    curve: np.ndarray
    ball: np.ndarray
    """Number of the quaternion of the ball in `State.turns`; if there is none, the number of quaternions, where the
    identity is appended."""
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
    """(used, chains): number of the twist that is the column of the Jacobian. Twists are numbered four a row (about
    or along z, then the three of a ball), or one a row if the system has no balls. If the chain does not hold the
    coordinate, it is the number of twists, where a zero twist is appended."""
    used: np.ndarray
    """(used,): columns of the coordinates that any chain holds; the others are zero in the Jacobian of the loops."""
    repeats: np.ndarray
    """(3, repeats): number of the twist that `source` names for a coordinate, number of the twist of another row with
    the same coordinate, which is to be added to it, and their chain."""
    rods: np.ndarray
    """(2, rods): numbers of both chains of each loop that is cut at a rod."""
    distinct: np.ndarray
    """(distinct,): numbers of the chains whose rows differ from those of all chains before. Chains with equal rows may
    begin and end in different frames: on a platform the chains from all rods but one pass through that one."""
    same_rows_as: np.ndarray
    """(chains,): for each chain the number, among `distinct`, of the one with the same rows."""


@lru_cache(maxsize=256)
def chain_tables(system: LoopSystem) -> ChainTables:
    """Make the tables of a system."""
    by_loop = [_chains(system, loop, cut) for loop, cut in zip(system.loops, system.cuts, strict=True)]
    of_rods = [number for number, chains in enumerate(by_loop) if len(chains) > 1]
    chains = [*(first for first, *_ in by_loop), *(by_loop[number][1] for number in of_rods)]
    length = max((len(chain.rows) for chain in chains), default=1)
    no_row = _no_row(system)
    filled = np.array([chain.rows + [no_row] * (length - len(chain.rows)) for chain in chains], np.int32)
    filled = filled.reshape(len(chains), length, len(ChainRow._fields))  # of couplings alone there are no chains
    rows = dict(zip(ChainRow._fields, np.moveaxis(filled, -1, 0).swapaxes(1, 2), strict=True))
    ended = np.array([chain.ends for chain in chains], np.int32).reshape(-1, len(ChainEnds._fields))
    ends = dict(zip(ChainEnds._fields, ended.T, strict=True))
    source, repeats = _sources(system, rows["column"], rows["ball"])
    used = np.flatnonzero((source < _twists_a_row(system) * length).any(axis=1))
    quaternion = np.full(len(system.balls) + 1, len(system.turned_balls), np.int32)
    quaternion[list(system.turned_balls)] = np.arange(len(system.turned_balls))
    rows["ball"] = quaternion[rows["ball"]]
    rods = np.array([of_rods, np.arange(len(by_loop), len(chains))], np.int32)
    first = {tuple(chain.rows): number for number, chain in reversed([*enumerate(chains)])}
    distinct = np.array(sorted(first.values()), np.int32)
    same_rows_as = np.array([list(distinct).index(first[tuple(chain.rows)]) for chain in chains], np.int32)
    sources = {"source": source[used], "used": used, "repeats": repeats}
    return ChainTables(**rows, **ends, **sources, rods=rods, distinct=distinct, same_rows_as=same_rows_as)


@lru_cache(maxsize=256)
def distinct_tables(system: LoopSystem) -> ChainTables:
    """Make the tables of a system with the entries of `ChainRow` of the distinct chains only, (rows, distinct)."""
    table = chain_tables(system)
    return table._replace(**{name: getattr(table, name)[:, table.distinct] for name in ChainRow._fields})


def _sources(system: LoopSystem, column: np.ndarray, ball: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find `ChainTables.source` of all columns, and `repeats`, from columns and balls of all rows (rows, chains)."""
    length, chains = column.shape
    twists_a_row = _twists_a_row(system)
    source = np.full((system.columns, chains), twists_a_row * length, np.int32)
    repeats = []
    for (row, chain), coordinate in np.ndenumerate(column):
        if coordinate == system.columns:
            continue
        if source[coordinate, chain] < twists_a_row * length:
            repeats.append((source[coordinate, chain], twists_a_row * row, chain))
        else:
            source[coordinate, chain] = twists_a_row * row
    for (row, chain), number in np.ndenumerate(ball):
        if number < len(system.balls):
            columns = system.balls[number]
            source[list(columns), chain] = 4 * row + 1 + np.arange(len(columns))
    return source, np.array(repeats, np.int32).reshape(-1, 3).T


def _twists_a_row(system: LoopSystem) -> int:
    """Count the twists of a row: one about or along z, and three more if the system has balls."""
    return 4 if system.turned_balls else 1


def _frames(system: LoopSystem) -> int:
    """Count the frames on parts 1 of all joints; there are as many on parts 2, and "no frame" is behind all of them."""
    return sum(map(len, system.movements))


def _no_row(system: LoopSystem) -> ChainRow:
    """Make a row that does nothing."""
    no_frame = 2 * _frames(system)
    return ChainRow(
        column=system.columns,
        joint=0,
        sign=0,
        turn=0,
        slide=0,
        screw=0,
        law=0,
        curve=0,
        ball=len(system.balls),
        side=1,
        axis=Z_AXIS,
        enter=no_frame,
        leave=no_frame,
    )


def _chains(system: LoopSystem, loop: tuple[tuple[int, int], ...], cut: tuple[int, ...]) -> list[LoopChain]:
    """Make the chains of a loop that is cut at the balls `cut`: each runs from behind one ball to before the next one.

    An uncut loop is one chain.
    """
    rows = [row for joint, sign in loop for row in _joint_rows(system, joint, sign)]
    if not cut:
        no_frame = 2 * _frames(system)
        return [LoopChain(rows, ChainEnds(no_frame, no_frame, len(system.balls), 0))]
    places = [number for number, row in enumerate(rows) if row.ball in cut]
    chains = []
    for place, following in zip(places, [*places[1:], places[0]], strict=True):
        ball = rows[place]
        between = rows[place + 1 : following] if place < following else rows[place + 1 :] + rows[:following]
        chains.append(LoopChain(between, ChainEnds(ball.leave, rows[following].enter, ball.ball, ball.sign)))
    return chains


def _joint_rows(system: LoopSystem, joint: int, sign: int) -> list[ChainRow]:
    """Make the rows of a joint that is travelled from part 1 to part 2 (sign +1) or from part 2 to part 1 (-1)."""
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
                    sign=sign * each.sense,
                    turn=int(each.kind != "translate"),
                    slide=int(each.kind == "translate"),
                    screw=int(each.kind == "screw"),
                    law=LAWS.index(each.law),
                    curve=0 if each.law is None else system.curves.index((joint, frame)),
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
