"""The loops of a system as tables of elementary steps: what the closure kernel runs through, joint by joint.

A step turns about and slides along the z axis of its own frame, or turns as a ball does. The tables are host data,
made once; loops of unequal length are filled up with steps that do nothing.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from jaxkin.geometry.motions import MOVEMENTS
from jaxkin.solve.system import LoopSystem

AXES = np.stack([np.roll(np.eye(3), axis + 1, axis=0) for axis in range(3)])
"""Rotations that carry z to x, y, z (and keep the order of the axes), by the number of the axis."""


class Steps(NamedTuple):
    """Tables of shape (steps, loops)."""

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
    """Index of the quaternion of a ball; the number of balls, which holds no turn, where there is none."""
    side: np.ndarray
    """+1, or -1 where the axes that its columns turn a ball about turn with it: a line of centres."""
    axis: np.ndarray
    enter: np.ndarray
    """Index of the frame in which the step begins: frames before, frames after, no frame."""
    leave: np.ndarray
    """Index of the frame in which it ends."""
    begin: np.ndarray
    """(loops,): frame in which the loop begins; no frame, or that behind the ball at which it is cut."""
    end: np.ndarray
    """(loops,): frame in which it ends; no frame, or that before the ball."""
    cut_sign: np.ndarray
    """(loops,): +1, or -1 where the ball at which it is cut is travelled from part 2 to part 1; 0 for whole loops."""
    source: np.ndarray
    """(columns, loops): the twist that is the column of the Jacobian, counted four a step (z, then the three of a
    ball), or one where there is no ball; the one behind the last, which is zero, where the loop does not hold the
    coordinate."""


@lru_cache(maxsize=256)
def steps(system: LoopSystem) -> Steps:
    """The tables of a system."""
    frames = sum(map(len, system.movements))
    loops, ends = zip(
        *(_opened(_loop(system, loop), cut, 2 * frames) for loop, cut in zip(system.loops, system.cuts, strict=True)),
        strict=True,
    )
    length = max(map(len, loops))
    idle = (system.columns, 0, 0, 0, 0, 0, len(system.balls), 1, 2, 2 * frames, 2 * frames)
    filled = np.array([rows + [idle] * (length - len(rows)) for rows in loops], np.int32)
    tables = [filled[..., entry].T for entry in range(filled.shape[-1])]
    each = 4 if system.balls else 1
    source = np.full((system.columns, len(loops)), each * length, np.int32)
    for (step, loop), column in np.ndenumerate(tables[0]):
        if column < system.columns:
            source[column, loop] = each * step
    for (step, loop), ball in np.ndenumerate(tables[6]):
        if ball < len(system.balls):
            columns = system.balls[ball]
            source[list(columns), loop] = 4 * step + 1 + np.arange(len(columns))
    return Steps._make([*tables, *np.array(ends, np.int32).T, source])


def _opened(
    rows: list[tuple[int, ...]], cut: int | None, no_frame: int
) -> tuple[list[tuple[int, ...]], tuple[int, int, int]]:
    """The rows of a loop from behind the ball at which it is cut to before it; where it begins and ends; its sign."""
    if cut is None:
        return rows, (no_frame, no_frame, 0)
    place = next(number for number, row in enumerate(rows) if row[6] == cut)
    *_, enter, leave = ball = rows[place]
    return rows[place + 1 :] + rows[:place], (leave, enter, ball[2])


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
