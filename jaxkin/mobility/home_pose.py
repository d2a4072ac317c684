"""Close the loops of a mechanism at its assembled pose, where new lengths have opened them there (host code).

A sweep closes its loops from the assembled pose on, wherever that is open: after a change of lengths, by a gap in a
file. What looks at freedoms, and what searches for poses, begins at the same pose, with displacements that count alike.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates, Travel
from jaxkin.linkage.linkage import Linkage

HomeRows = tuple[Float[np.ndarray, " _"], ...]
"""Displacements of all joints from the assembled pose to the home pose, radians and lengths of the mechanism."""


class HomePose(NamedTuple):
    """The pose of the loops of one loop group from which their motion is followed."""

    q: LoopCoordinates
    """Scaled coordinates from the assembled pose: all zero where the loops close there."""
    travel: Travel
    """What is found by travelling around the loops there."""
    closed: bool
    """Whether the loops close there; if not, this is where they are the least open."""


def home_pose(loops: ClosedLoops, held: Iterable[int] = ()) -> HomePose:
    """Find the home pose of loops: the assembled pose, or where steps from there close the loops.

    Columns `held`, such as driven ones, stay zero.
    """
    rest = np.zeros(len(loops.columns))
    there = loops.travel(rest)
    if loops.coincide or there.residual_norm <= loops.thresholds.residual:
        return HomePose(rest, there, True)
    q, found = loops.closed(rest, list(held))
    return HomePose(q, found, found.residual_norm <= loops.thresholds.residual)


class HomeOfMechanism(NamedTuple):
    """The home pose of all loop groups of a linkage."""

    rows: HomeRows
    loops: ClosedLoops | None
    """The loops that are the most open there; None where all close."""
    q: LoopCoordinates
    """Scaled coordinates of these loops; none where all close."""


def home_of_mechanism(linkage: Linkage, held: Container[JointCoordinate]) -> HomeOfMechanism:
    """Find the home pose of all loop groups of a linkage, with the coordinates `held` at zero."""
    rows = tuple(np.zeros(joint.freedoms) for joint in linkage.joints)
    worst, loops_left, q_left = 0.0, None, np.zeros(0)
    for loop_group in linkage.structure.loop_groups:
        loops = closed_loops(linkage, loop_group)
        home = home_pose(loops, [k for k, place in enumerate(loops.columns) if place in held])
        if not home.closed and home.travel.residual_norm > worst:
            worst, loops_left, q_left = home.travel.residual_norm, loops, home.q
        for (joint, k), value in zip(loops.columns, home.q * loops.units, strict=True):
            rows[joint][k] = value
    return HomeOfMechanism(rows, loops_left, q_left)
