"""The loops of a system as tables of elementary steps: what the closure kernel runs through, joint by joint.

A step turns about and slides along the z axis of its own frame, or turns as a ball does. The tables are host data,
made once. A loop is one chain of steps, closed in itself or between the two sides of the ball at which it is cut; one
that is cut at both balls of a rod is two chains, from ball to ball. Those of unequal length are filled up with steps
that do nothing.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.solve.system.loop_system import LoopSystem

AXES = np.stack([np.roll(np.eye(3), axis + 1, axis=0) for axis in range(3)])
"""Rotations that carry z to x, y, z (and keep the order of the axes), by the number of the axis."""


class Steps(NamedTuple):
    """Tables of shape (steps, chains): the first chain of every loop, then the second ones of those cut at a rod."""

    column: np.ndarray
    """Column of the coordinate; the number of columns, which holds zero, where there is none."""
    joint: np.ndarray
    sign: np.ndarray
    """+1, or -1 where the joint is travelled from part 2 to part 1; 0 for steps that do nothing."""
    turn: np.ndarray
    """1 where the coordinate turns, else 0."""
    slide: np.ndarray
    """1 where the coordinate slides, else 0."""
    screw: np.ndarray
    """1 where the coordinate slides by the pitch of the joint as well, else 0."""
    ball: np.ndarray
    """Index of the quaternion of a ball in the `State`; the number of quaternions, which holds no turn, where there is
    none."""
    side: np.ndarray
    """+1, or -1 where the axes that its columns turn a ball about turn with it: a line of centres."""
    axis: np.ndarray
    enter: np.ndarray
    """Index of the frame in which the step begins: frames before, frames after, no frame."""
    leave: np.ndarray
    """Index of the frame in which it ends."""
    begin: np.ndarray
    """(chains,): frame in which the chain begins; no frame, or that behind the ball at which the loop is cut."""
    end: np.ndarray
    """(chains,): frame in which it ends; no frame, or that before a ball."""
    cut_ball: np.ndarray
    """(chains,): number of the ball behind which it begins; the number of balls where the loop is whole."""
    cut_sign: np.ndarray
    """(chains,): +1, or -1 where that is travelled from part 2 to part 1; 0 where the loop is whole."""
    source: np.ndarray
    """(columns, chains): the twist that is the column of the Jacobian, counted four a step (z, then the three of a
    ball), or one where there is no ball; the one behind the last, which is zero, where the chain does not hold the
    coordinate."""
    rods: np.ndarray
    """(2, rods): both chains of each loop that is cut at a rod."""


@lru_cache(maxsize=256)
def steps(system: LoopSystem) -> Steps:
    """The tables of a system."""
    frames = sum(map(len, system.movements))
    opened = [
        _opened(_loop(system, loop), cut, (2 * frames, 2 * frames, len(system.balls), 0))
        for loop, cut in zip(system.loops, system.cuts, strict=True)
    ]
    of_rods = [number for number, chains in enumerate(opened) if len(chains) > 1]
    chains, ends = zip(*(chains[0] for chains in opened), *(opened[number][1] for number in of_rods), strict=True)
    length = max(map(len, chains))
    idle = (system.columns, 0, 0, 0, 0, 0, len(system.balls), 1, 2, 2 * frames, 2 * frames)
    filled = np.array([rows + [idle] * (length - len(rows)) for rows in chains], np.int32)
    tables = [filled[..., entry].T for entry in range(filled.shape[-1])]
    each = 4 if system.turned_balls else 1
    source = np.full((system.columns, len(chains)), each * length, np.int32)
    for (step, chain), column in np.ndenumerate(tables[0]):
        if column < system.columns:
            source[column, chain] = each * step
    for (step, chain), ball in np.ndenumerate(tables[6]):
        if ball < len(system.balls):
            columns = system.balls[ball]
            source[list(columns), chain] = 4 * step + 1 + np.arange(len(columns))
    place = np.full(len(system.balls) + 1, len(system.turned_balls), np.int32)
    place[list(system.turned_balls)] = np.arange(len(system.turned_balls))
    tables[6] = place[tables[6]]
    rods = np.array([of_rods, np.arange(len(opened), len(chains))], np.int32)
    return Steps._make([*tables, *np.array(ends, np.int32).T, source, rods])


def _opened(
    rows: list[tuple[int, ...]], cut: tuple[int, ...], whole: tuple[int, ...]
) -> list[tuple[list[tuple[int, ...]], tuple[int, ...]]]:
    """The chains of a loop that is cut at some balls, each from behind one to before the next: its rows; the frames in
    which it begins and ends, and number and sign of the ball that it begins behind, or those of a `whole` loop."""
    if not cut:
        return [(rows, whole)]
    places = [number for number, row in enumerate(rows) if row[6] in cut]
    chains = []
    for place, other in zip(places, [*places[1:], places[0]], strict=True):
        (*_, leave), (*_, enter, _) = rows[place], rows[other]
        between = rows[place + 1 : other] if place < other else rows[place + 1 :] + rows[:other]
        chains.append((between, (leave, enter, rows[place][6], rows[place][2])))
    return chains


def _loop(system: LoopSystem, loop: tuple[tuple[int, int], ...]) -> list[tuple[int, ...]]:
    """The rows of one loop, entries in the order of `Steps`."""
    frames = sum(map(len, system.movements))
    first_frame = np.cumsum([0, *map(len, system.movements)])
    turning = {column for columns in system.balls for column in columns}
    rows = []
    for joint, sign in loop:
        chain = system.chains[joint]
        for name, frame, column, ball in chain if sign > 0 else reversed(chain):
            before = int(first_frame[joint]) + frame
            enter, leave = (before, frames + before) if sign > 0 else (frames + before, before)
            movement = MOVEMENTS[name]
            elements = [element for element in movement.elements if column + element.coordinate not in turning]
            if ball is not None or not elements:
                elements = [None]
            for number, element in enumerate(elements if sign > 0 else elements[::-1]):
                at = enter if number == 0 else 2 * frames, leave if number == len(elements) - 1 else 2 * frames
                if element is None:
                    which = len(system.balls) if ball is None else ball
                    side = -1 if ball is not None and len(system.balls[ball]) == 2 else 1
                    rows.append((system.columns, joint, sign, 0, 0, 0, which, side, 2, *at))
                else:
                    kind = (element.kind != "translate", element.kind == "translate", element.kind == "screw")
                    index = column + element.coordinate
                    rows.append((index, joint, sign, *map(int, kind), len(system.balls), 1, element.axis, *at))
    return rows
