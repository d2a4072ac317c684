"""Find rods between two balls, which spin idly about the line of the centres (host code, numbers only)."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from itertools import chain

import numpy as np

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint
from jaxkin.topology.components import connected

ALONG_ROD = 1e-5
"""Sine of the largest angle between a line of centres and the axis of a joint that slides along it: what rounding to
six digits leaves. The spin about the line is free whatever the angle, because only the two balls hold the rod."""


def idle_spins(joints: Sequence[Joint], body_of: Mapping[str, Hashable]) -> tuple[tuple[int, int, int, int], ...]:
    """Find the rods that spin idly, as `LoopClass.spins`. `body_of` gives the body of a part, one for all fixed parts.

    A rod is one part, or several parts in a row that slide along the line of centres only, such as the halves of a leg.
    It is held by two balls and nothing else. The balls are on two different bodies: a part between two balls on one and
    the same body is a hinge, and its rotation is no idle one.
    """
    ball_of, balls = {}, 0
    for index, joint in enumerate(joints):
        count = sum(MOVEMENTS[name].ball for name in joint.movements)
        if count == 1 and len(joint.movements) == 1:
            ball_of[index] = balls
        balls += count
    if len(ball_of) < 2:
        return ()
    ends_of = [tuple(body_of[part] for part in joint.parts) for joint in joints]
    slides = [
        index
        for index, joint in enumerate(joints)
        if len(joint.movements) == 1 and MOVEMENTS[joint.movements[0]].only_slides
    ]
    found = []
    for bodies in connected(chain.from_iterable(ends_of), [ends_of[index] for index in slides]):
        held = [index for index, (a, b) in enumerate(ends_of) if (a in bodies) != (b in bodies)]
        if len(held) != 2 or not all(index in ball_of for index in held):
            continue
        one, other = held
        ends = [{body_of[part] for part in joints[index].parts} - bodies for index in (one, other)]
        line = np.asarray(joints[other].frames_1[0], float)[:3, 3] - np.asarray(joints[one].frames_1[0], float)[:3, 3]
        along = [index for index in slides if ends_of[index][0] in bodies]
        if ends[0] == ends[1] or not _all_along(line, [joints[index] for index in along]):
            continue
        sides = (1 if body_of[joints[index].parts[1]] in bodies else -1 for index in (one, other))
        found.append((ball_of[one], ball_of[other], *sides))
    return tuple(sorted(found))


def _all_along(line: np.ndarray, slides: Sequence[Joint]) -> bool:
    """Tell whether the line is longer than zero and the axes of all sliding joints are parallel to it."""
    length = float(np.linalg.norm(line))
    axes = [np.asarray(joint.frames_1[0], float)[:3, 2] for joint in slides]
    return length > 0 and all(np.linalg.norm(np.cross(axis, line)) <= ALONG_ROD * length for axis in axes)
