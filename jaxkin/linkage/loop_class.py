"""Find the class of the loops of each loop group, on the host, from joint frames that are known numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import jax
import numpy as np

from jaxkin._traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.linkage.decoupled_plane import decoupled_plane
from jaxkin.linkage.planes import plane_columns, turn_about_one_direction, turn_about_one_point
from jaxkin.linkage.rods import idle_spins
from jaxkin.topology.graph import Circuit
from jaxkin.topology.structure import Structure


class LoopClass(NamedTuple):
    """Properties of the loops of a loop group by which they need fewer equations, or other ones, than six a loop."""

    plane: tuple[int, ...] | None = None
    """Columns of the coordinates that act in the plane, of loops whose joints all move in parallel planes; else None.
    They are numbered through all coordinates of the loop group."""
    decoupled_plane: tuple[int, ...] | None = None
    """The same of loops whose joints could leave the plane, by coordinates that rest while the others keep to it; else
    None. See `jaxkin.linkage.decoupled_plane`."""
    spins: tuple[tuple[int, int, int, int], ...] = ()
    """Rods that spin idly about the line through their two balls: the numbers of both balls, and for each ball +1, or
    -1 where the rod is part 1 of the ball's joint."""
    schoenflies: tuple[int, ...] = ()
    """Numbers of the loops that turn about one direction only, wherever they slide (the subgroup of Schoenflies)."""
    spherical: tuple[int, ...] = ()
    """Numbers of the loops that turn about axes through one point only."""
    cut_at_balls: bool = False
    """Whether the solver may cut loops at balls: see `LoopSystem.cuts`. False for a general class and in
    `Linkage.whole`."""


def loop_classes(joints: Sequence[Joint], structure: Structure) -> tuple[LoopClass, ...] | None:
    """Find the class of each loop group; None where frames are traced, or their arrays hold many mechanisms."""
    if not all(isinstance(joint.frames_1, np.ndarray | jax.Array) for joint in joints):
        return None
    if traced(joints):  # under `grad` alone the numbers are known; inside `jit` this would trace numbers that are not
        joints = jax.lax.stop_gradient(tuple(joints))
    if any(traced(joint) or joint.frames_1.ndim != 3 for joint in joints):
        return None
    row_of = structure.row_of
    fixed = row_of[structure.fixed[0]]
    bodies = {part: fixed if part in structure.fixed else row for part, row in row_of.items()}
    found = []
    for loop_group in structure.loop_groups:
        inside = [joints[joint] for joint in loop_group.joints]
        chains = [[joints[joint] for joint, _ in loop] for loop in loop_group.loops]
        schoenflies = tuple(number for number, chain in enumerate(chains) if turn_about_one_direction(chain))
        spherical = tuple(number for number, chain in enumerate(chains) if turn_about_one_point(chain))
        plane = plane_columns(inside)
        decoupled = None if plane is not None else decoupled_plane(joints, structure, loop_group)
        spins = idle_spins(inside, bodies)
        found.append(LoopClass(plane, decoupled, spins, schoenflies, spherical, cut_at_balls=True))
    return tuple(found)


def renumbered(
    loop_class: LoopClass, loops: Sequence[Circuit], chosen: Sequence[Circuit], joints: Sequence[Joint]
) -> LoopClass:
    """Renumber a class for the loops `chosen` in place of the loops `loops`, which pass the same joints.

    A chosen loop that is not among `loops` is classified from the frames of its joints.
    """
    if tuple(chosen) == tuple(loops):
        return loop_class

    def numbers(known: Sequence[int], holds: Callable[[Sequence[Joint]], bool]) -> tuple[int, ...]:
        return tuple(
            number
            for number, loop in enumerate(chosen)
            if (loops.index(loop) in known if loop in loops else holds([joints[joint] for joint, _ in loop]))
        )

    return loop_class._replace(
        schoenflies=numbers(loop_class.schoenflies, turn_about_one_direction),
        spherical=numbers(loop_class.spherical, turn_about_one_point),
    )
