"""Search the closed poses of the loops of one loop group for given inputs: by formulas, or from many starts.

Where each group of loops has a formula (`jaxkin.solve.closed_form`), its two signs are tried in all combinations: these
are all poses. Elsewhere damped least-norm steps (`levenberg_marquardt`) go from random coordinates to closed poses.
"""

from __future__ import annotations

from functools import partial
from itertools import product
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates
from jaxkin.linkage.start_ranges import start_ranges
from jaxkin.mechanism.drive_plan import DrivenLoopGroup
from jaxkin.solve.closed_form.assembled_axes import assembled_axes
from jaxkin.solve.closed_form.formula_displacements import joint_displacements
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.closed_form.solve_groups import residual_norm, solve_groups
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.closure.joint_coordinates import ball_rotations, joint_coordinates
from jaxkin.solve.correctors.levenberg_marquardt import levenberg_marquardt
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import CLOSED_ROUNDINGS, rounding_residual
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, drive

MAX_FORMULAS = 12
"""Most groups whose signs are tried in all combinations, 4096 of them; of more, poses are searched from many starts."""
STARTS_AT_ONCE = 1024
"""Starts that are followed together: the Jacobians of so many stay within some megabytes."""
FARTHEST_SLIDES = (2.0, 2.0, 4.0, 8.0)
"""Most a slide is moved at a start, characteristic lengths, for starts in turn: a mechanism is some two wide to each
side of its middle, but its links in a row, the perimeter of a loop, are eight to ten. From two alone no start found 3
to 9 of the 12 to 26 modes of random loops with a screw (5 of 6 loops), most of which were said to have no others."""
SAME_POSE = 1e-6
"""Largest difference of two poses that are one, radians or characteristic lengths: closed poses are right to 1e-9
where their Jacobian has singular values down to 1e-5."""
SAME_POSE_SINGLE = 1e-3
"""`SAME_POSE` in float32, in which closed poses are right to 1e-6."""
_SPIN = 1e-4
"""Displacement along idle freedoms, radians, that shows what they move: their curvature shows as its square."""


class FoundPoses(NamedTuple):
    """Closed poses of the loops of a loop group, each once: that of the assembled branch first, nearest next."""

    displacements: Float[np.ndarray, "poses columns"]
    """Radians and lengths of the mechanism."""
    residual: Float[np.ndarray, " poses"]
    signs: tuple[str, ...]
    """A plus or minus for each group of loops that has a formula; empty for poses from starts."""
    counts: Int[np.ndarray, " poses"]
    """How many starts led to each pose; one for poses by formulas."""
    by_formulas: bool
    """Whether these are all poses, by formulas."""


class Starts(NamedTuple):
    """From where closed poses are searched."""

    tries: int
    """How many random starts."""
    seed: int
    """Of their random numbers."""
    options: SolverOptions
    """With the largest number of steps from a start, `rescue_steps`."""


class PoseFeatures:
    """Numbers that tell the poses of a loop group apart: where its joint frames are, on both of their parts.

    Entries that an idle freedom moves, such as the directions on a rod that may spin between two balls, are left out.
    """

    def __init__(self, loops: ClosedLoops, idle: int) -> None:
        """Take the loops, with how many idle freedoms they have."""
        self.loops, self.idle = loops, idle

    def at(self, q: LoopCoordinates) -> Float[np.ndarray, " entries"]:
        """Compute the entries at scaled coordinates: twelve a frame, lengths over the characteristic length."""
        places, rows = self.loops.travel(q).places, []
        for index, each in self.loops.chains.items():
            for part, frame in zip(self.loops.ends[index], (each.frames_1[0], each.frames_2[-1]), strict=True):
                rows.append((places[part] @ frame)[:3].ravel())
        return np.concatenate(rows)

    def of(self, poses: Float[np.ndarray, "poses columns"], free: list[int]) -> Float[np.ndarray, "poses entries"]:
        """Compute the entries at several poses, zero in place of those that an idle freedom moves in any of them.

        `free` are the columns that are not driven.
        """
        rows = [self.at(q) for q in poses]
        if not rows or not self.idle:
            return np.array(rows).reshape(len(poses), -1)
        moved = np.zeros(len(rows[0]), bool)
        for q in poses:
            jacobian = self.loops.travel(q).jacobian[:, free]
            for direction in np.linalg.svd(jacobian)[2][len(free) - self.idle :]:
                step = np.zeros(len(q))
                step[free] = _SPIN * direction
                moved |= np.abs(self.at(q + step) - self.at(q - step)) > 0.01 * _SPIN
        return np.where(moved, 0.0, rows)


def find_modes(
    loop_group: DrivenLoopGroup,
    features: PoseFeatures,
    inputs: Float[np.ndarray, " driven"],
    reached: tuple[LoopCoordinates, float] | None,
    starts: Starts,
    max_residual: float,
) -> FoundPoses:
    """Find the closed poses of a loop group for one displacement of each of its driven columns.

    Complete where all groups of loops have formulas; elsewhere from random starts. `reached` is the pose to which the
    motion leads from the assembled pose, with its residual: None where it does not close.
    """
    system, loops = loop_group.system, features.loops
    by_formulas = _has_formulas(system)
    if by_formulas:
        poses, residual, names = _by_formulas(loop_group, inputs)
    else:
        farthest = np.stack([_start_ranges(loop_group, loops, slide) for slide in FARTHEST_SLIDES], axis=1)
        poses, residual = _from_starts(loop_group, inputs, starts, farthest)
        names = [""] * len(poses)
    (closed,) = np.nonzero(np.isfinite(residual) & (residual <= max_residual))
    poses, residual, names = poses[closed], residual[closed], [names[k] for k in closed]
    weights = np.ones(len(poses), int)
    if reached is not None:
        poses, residual = np.vstack([reached[0], poses]), np.append(reached[1], residual)
        weights, names = np.append(0, weights), ["", *names]
    if not len(poses):
        return FoundPoses(poses, residual, (), weights, by_formulas)

    same = SAME_POSE if poses.dtype == np.float64 else SAME_POSE_SINGLE
    # equal coordinates first, which are many; then equal features, which take longer and count idle freedoms as nothing
    labels = group_rows(_without_full_turns(loop_group, loops, poses), same)
    rows = _scaled_rows(loop_group, loops, poses[_first_of(labels)])
    home = rows[:1] if reached is not None else np.zeros((1, rows.shape[1]))
    driven = [loop_group.columns[column] for column in system.driven]
    free = [column for column, place in enumerate(loops.columns) if place not in driven]
    at_home, *entries = features.of(np.vstack([home, rows]), free)
    of_features = group_rows(np.array(entries), same)
    order = np.argsort([np.linalg.norm(entries[k] - at_home) for k in _first_of(of_features)])
    labels = of_features[labels]
    representatives = _first_of(labels)[order]
    return FoundPoses(
        poses[representatives],
        residual[representatives],
        tuple(max(name for name, one in zip(names, labels, strict=True) if one == label) for label in order),
        np.bincount(labels, weights).astype(int)[order],
        by_formulas,
    )


def group_rows(rows: Float[np.ndarray, "rows entries"], same: float) -> Int[np.ndarray, " rows"]:
    """Label each row with the number of its set of equal rows, which are numbered in the order of their first rows."""
    first: list[int] = []
    labels = np.zeros(len(rows), int)
    for number, row in enumerate(rows):
        near = np.flatnonzero(np.abs(rows[first] - row).max(axis=1, initial=0.0) <= same)
        labels[number] = near[0] if len(near) else len(first)
        if not len(near):
            first.append(number)
    return labels


def _first_of(labels: Int[np.ndarray, " rows"]) -> Int[np.ndarray, " found"]:
    """List the first row of each set of rows, by its number."""
    return np.unique(labels, return_index=True)[1]


def _scaled_rows(
    loop_group: DrivenLoopGroup, loops: ClosedLoops, poses: Float[np.ndarray, "poses columns"]
) -> Float[np.ndarray, "poses every"]:
    """Put displacements of the columns of a loop group among all coordinates of its loops, scaled; others rest."""
    rows = np.zeros((len(poses), len(loops.columns)))
    rows[:, [loops.columns.index(place) for place in loop_group.columns]] = poses
    return rows / loops.units


def _has_formulas(system: LoopSystem) -> bool:
    """Tell whether each group has a formula, so that all poses are found by trying the signs of all roots."""
    formulas = group_formulas(system)
    known = all(isinstance(formula, GroupFormula) for formula in formulas)
    return known and 0 < len(formulas) <= MAX_FORMULAS and not system.turned_balls


def _by_formulas(
    loop_group: DrivenLoopGroup, inputs: Float[np.ndarray, " driven"]
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, " poses"], list[str]]:
    """Solve the groups in order with all combinations of signs; a group of two slides has one pose, whose sign is
    written +."""
    found = [formula for formula in group_formulas(loop_group.system) if isinstance(formula, GroupFormula)]
    choices = list(product(*[(1.0,) if formula.letters.count("P") == 2 else (1.0, -1.0) for formula in found]))
    signs = jnp.asarray(choices, float).T
    given = jnp.asarray(np.repeat(inputs[:, None], len(choices), axis=1), float)
    rows, residual = _formula_poses(loop_group.system, loop_group.joints, signs, given)
    names = ["".join("+" if sign > 0 else "-" for sign in choice) for choice in choices]
    return np.asarray(rows).T, np.broadcast_to(residual, len(choices)), names


@partial(whole_program, static=(0,))
def _formula_poses(
    system: LoopSystem, joints: Joints, signs: Float[Array, "groups poses"], inputs: Float[Array, "driven poses"]
) -> tuple[Float[Array, "columns poses"], Float[Array, " poses"]]:
    """Compute displacements and residual norms by formulas, for inputs in radians and lengths of the mechanism."""
    axes = assembled_axes(system, joints)
    lengths = jnp.where(jnp.array([system.is_length[column] for column in system.driven]), axes.length, 1.0)
    solved = solve_groups(system, axes, list(signs), inputs / lengths[:, None])
    residual = jnp.asarray(residual_norm(system, axes, solved.coordinates))
    return joint_displacements(system, joints, axes, jnp.asarray(solved.x)), residual


def _from_starts(
    loop_group: DrivenLoopGroup,
    inputs: Float[np.ndarray, " driven"],
    starts: Starts,
    farthest: Float[np.ndarray, "columns ranges"],
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, " poses"]]:
    """Close the loops from random starts: columns moved by up to `farthest`, in turn, and balls turned at random."""
    system, rows, residuals, rng = loop_group.system, [], [], np.random.default_rng(starts.seed)
    size = min(starts.tries, STARTS_AT_ONCE)
    most = farthest[:, np.arange(size) % farthest.shape[1]]
    for _ in range(-(-starts.tries // size)):
        angles, slides = rng.uniform(-1.0, 1.0, (2, system.columns, size))
        x = most * np.where(np.array(system.is_length)[:, None], slides, angles)
        turns = rng.normal(size=(len(system.turned_balls), 4, size))
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        begun = State(jnp.asarray(x, float), jnp.asarray(turns, float))
        given = jnp.asarray(np.repeat(inputs[:, None], size, axis=1), float)
        found = _closed(system, starts.options.of_program, loop_group.joints, begun, given)
        rows.append(np.asarray(found[0]).T)
        residuals.append(np.asarray(found[1]))
    return np.concatenate(rows)[: starts.tries], np.concatenate(residuals)[: starts.tries]


def _start_ranges(loop_group: DrivenLoopGroup, loops: ClosedLoops, slide: float) -> Float[np.ndarray, " columns"]:
    """Say how far each column of a loop group is moved at a start at most, radians and characteristic lengths.

    `slide` is how far slides are.
    """
    columns = list(loop_group.columns)
    chains = [loops.chains[joint] for joint, _ in columns]
    pitched = [any(MOVEMENTS[movement].has_pitch for movement in chain.movements) for chain in chains]
    pitch = np.array([chain.pitch if screws else 0.0 for chain, screws in zip(chains, pitched, strict=True)])
    in_loops = {joint for loop in loop_group.members.loops for joint, _ in loop}
    couplings = []
    for numbers, factors, _ in loops.couplings:
        tied = [loops.columns[number] for number in numbers]
        if len(tied) == 2 and not np.any(factors[:, 1:]) and all(place in columns for place in tied):
            couplings.append(([columns.index(place) for place in tied], factors[:, 0]))
    carried = np.array([joint not in in_loops for joint, _ in columns])
    return start_ranges(np.array(loop_group.system.is_length), pitch, slide, couplings, carried)


@partial(whole_program, static=(0, 1))
def _closed(
    system: LoopSystem, options: SolverOptions, joints: Joints, state: State, inputs: Float[Array, "driven starts"]
) -> tuple[Float[Array, "columns starts"], Float[Array, " starts"]]:
    """Close the loops from states whose driven columns are replaced by inputs, lengths of the mechanism."""
    geometry, lengths = scaled_geometry(system, joints)
    given = lengths[jnp.array(system.driven, int)]
    problem = ClosureProblem(system, geometry, options)
    target = rounding_residual(state.x.dtype, CLOSED_ROUNDINGS)
    begun = drive(system, state, inputs / given)
    found = levenberg_marquardt(problem, begun, options.rescue_steps, target)
    rotations = ball_rotations(system, geometry, found.state)
    x = joint_coordinates(system, joints.frames_1, joints.frames_2, found.state.x * lengths, rotations)
    return x, found.residual_norm


def _without_full_turns(
    loop_group: DrivenLoopGroup, loops: ClosedLoops, poses: Float[np.ndarray, "poses columns"]
) -> Float[np.ndarray, "poses entries"]:
    """Compute cosines and sines of angles, and scaled lengths: equal where coordinates are, but for full turns."""
    lengths = np.array(loop_group.system.is_length)
    units = loops.units[[loops.columns.index(place) for place in loop_group.columns]]
    return np.concatenate(
        [np.cos(poses[:, ~lengths]), np.sin(poses[:, ~lengths]), poses[:, lengths] / units[lengths]], axis=1
    )
