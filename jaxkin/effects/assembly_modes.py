"""All assembly modes of a mechanism for given inputs: the closed poses, whether or not a motion connects them.

`assembly_modes` checks the drive, and sweeps to the pose on the branch. `mode_search.find_modes` finds the closed poses
of each loop group; those of different loop groups are combined each with each. (`jaxkin.mobility.other_modes` only
asks, on the host, whether open loops may close in other ways near the assembled pose.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, check_known, check_mechanism, one_number, text, whole_number
from jaxkin._guesses import Result
from jaxkin._names import counted, listed
from jaxkin.effects.coupled_turns import coupled_turns
from jaxkin.effects.determined_drive import check_determined
from jaxkin.effects.mode_limits import wrap_angles
from jaxkin.effects.mode_plot import draw_modes
from jaxkin.effects.mode_search import FoundPoses, PoseFeatures, Starts, find_modes
from jaxkin.effects.pose_plot import save_displacements
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.coordinates import coordinate, resolve
from jaxkin.mechanism.drive_plan import DrivenLoopGroup, plan_drive
from jaxkin.mechanism.joint_limits import excesses, with_limited
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.mobility.open_loops import opening
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.solve.status import Status, default_tolerance

MAX_MODES = 4096
"""Most modes that are listed: loop groups that do not depend on each other multiply theirs."""
MAX_ROWS = 40
"""Modes that a printed result lists at most: as many as a general hexapod has."""


@dataclass(frozen=True, repr=False)
class AssemblyMode(Result):
    """One closed pose of a mechanism for the inputs of its `AssemblyModes`."""

    modes: AssemblyModes
    index: int
    """Its number in `modes`, from 0."""

    @property
    def name(self) -> str:
        """Name of the mode: "mode 1" and so on."""
        return self.modes.names[self.index]

    @property
    def signs(self) -> str:
        """A plus or minus for each group of loops with a formula, in the order of the plan: the sign of its root."""
        return self.modes.signs[self.index]

    @property
    def coordinates(self) -> Mapping[str, Float[Array, " _"]]:
        """Displacements of each joint from the assembled pose: radians, and lengths of the mechanism.

        An angle is between -pi and pi, or some full turns from there, where it is within the limits of its joint.
        """
        return {joint: rows[self.index] for joint, rows in self.modes.motion.coordinates.items()}

    @property
    def residual(self) -> float:
        """Square root of Eq. 12, lengths over the characteristic length of the loops."""
        return float(self.modes.motion.residual[self.index])

    def mechanism(self) -> Mechanism:
        """Assemble the mechanism in this mode: displacements, those of the drive too, count from there."""
        return self.modes.motion.mechanism.at(self.modes.motion, self.index)


@dataclass(frozen=True, eq=False, repr=False)
class AssemblyModes(Result):
    """The assembly modes of a mechanism for given inputs. Prints, draws and saves itself; `modes[0]` is the first."""

    inputs: Mapping[str, float]
    """The given displacements by "joint.coordinate", radians and lengths of the mechanism."""
    motion: Motion
    """One pose a mode: the first is CLOSED, or LIMITED, where it is that of the assembled pose; others are JUMPED."""
    signs: tuple[str, ...]
    """For each mode a plus or minus for each group of loops with a formula."""
    found: tuple[int, ...]
    """How many of the starts led to each mode; empty where `complete`. The motion from the assembled pose, which is no
    start, may find a mode that no start did: 0."""
    complete: bool
    """Whether all modes are there: all groups of loops have formulas, which give all their poses."""
    starts: int
    """How many starts were tried; 0 where `complete`."""

    def __len__(self) -> int:
        return len(self.motion)

    def __getitem__(self, index: int) -> AssemblyMode:
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} modes, numbered from 0, got {index}")
        return AssemblyMode(self, index % len(self))

    def __iter__(self) -> Iterator[AssemblyMode]:
        return (self[index] for index in range(len(self)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the modes: "mode 1" and so on."""
        return tuple(f"mode {number}" for number in range(1, len(self) + 1))

    @property
    def assembled(self) -> bool:
        """Whether "mode 1" is the one to which the drive moves the mechanism from its assembled pose."""
        return len(self) > 0 and bool(self.motion.closed[0])

    @cached_property
    def beyond_limits(self) -> Mapping[str, Float[np.ndarray, " modes"]]:
        """How far coordinates are beyond the limits of their joints, by "joint.coordinate": radians or lengths.

        As `motion.beyond_limits`, of all modes: above 0 beyond the highest displacement, below 0 beyond the lowest.
        """
        return excesses(self.motion, np.ones(len(self), bool))

    @property
    def chance_of_more(self) -> float:
        """An estimate of the chance that one more start that closes leads to a mode that is not here (Good, 1953).

        It is the number of modes that were found once over that of all starts that closed: 0 where `complete`.
        """
        if self.complete:
            return 0.0
        closed = sum(self.found)
        return self.found.count(1) / closed if closed else 1.0

    def __str__(self) -> str:
        inputs = listed([f"{name} = {value:.6g}" for name, value in self.inputs.items()])
        head = f"{counted(len(self), 'assembly mode')} for {inputs}: "
        if self.complete:
            head += "all there are, by formulas"
        else:
            head += f"from {self.starts} starts, of which {sum(self.found)} closed"
        lines = [head]
        if not len(self):
            return f"{head}; the loops cannot close there" if self.complete else head
        rows = [("", "signs", "found", "residual", "", "")]
        for number, (name, signs) in enumerate(zip(self.names, self.signs, strict=True)):
            said = "of the assembled pose" if number == 0 and self.assembled else ""
            found = str(self.found[number]) if self.found else ""
            over = listed([joint for joint, far in self.beyond_limits.items() if far[number]])
            limits = f"beyond the limits of {over}" if over else ""
            rows.append((name, signs, found, f"{float(self.motion.residual[number]):.1e}", said, limits))
        columns = [column for column in zip(*rows[: MAX_ROWS + 1], strict=True) if any(column[1:])]
        widths = [max(map(len, column)) for column in columns]
        for row in zip(*columns, strict=True):
            lines.append("  " + "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())
        if len(self) > MAX_ROWS:
            lines.append(f"  and {len(self) - MAX_ROWS} more: see .motion")
        if not self.complete:
            lines.append(f"  {self._doubt()}")
            if turns := coupled_turns(self.motion.mechanism.linkage, self.inputs):
                lines.append(f"  but for full turns of {listed(turns)}, which couplings tie: each is a mode of its own")
        return "\n".join(lines)

    def _doubt(self) -> str:
        """Say how sure it is that the modes from starts are all there are."""
        closed, once = sum(self.found), self.found.count(1)
        if not closed:
            return "no start closed: give more tries"
        if once:
            return (
                f"{once} of them found once: there may be more; one more start that closes leads to another with a "
                f"chance of about {self.chance_of_more:.2g}"
            )
        return f"each was found by two starts or more, of {closed}: it is likely that there are no others"

    def plot(self, path: str | Path) -> Path:
        """Draw the modes side by side as bars between joints into a picture file; returns its path."""
        titles = [f"{name}, as assembled" if self.assembled and name == "mode 1" else name for name in self.names]
        return draw_modes(self.motion, titles, Path(path))

    def save(self, path: str | Path) -> Path:
        """Write the displacements of all joints as comma-separated values, a row a mode; returns the path."""
        mechanism = self.motion.mechanism
        return save_displacements(mechanism.all_joints, self.motion.displacements, mechanism.unit, Path(path))


def assembly_modes(
    mechanism: Mechanism,
    drive: Mapping[str, float],
    *,
    tries: int = 512,
    seed: int = 0,
    options: SolverOptions | None = None,
) -> AssemblyModes:
    """Find the assembly modes of a mechanism: all closed poses for one displacement of each driven coordinate.

    `drive` maps "joint" or "joint.coordinate" to a number, radians or lengths of the mechanism from the assembled pose.
    Where each group of loops has a formula (see `mechanism.plan`), both of its poses are computed: the modes are
    complete. Elsewhere the loops are closed from `tries` random starts, the same ones for the same `seed`, and the
    result tells how many led to each mode: one that was found once suggests that there are more. Poses that differ by
    idle freedoms, such as the spin of a rod between two balls, are one mode. Modes beyond the limits of joints are
    there, too, and told (`beyond_limits`). Where a coupling ties an angle of a loop to what does not make whole turns
    with it, such as a rack, each full turn is a mode of its own: there is no end of them, and only some near the
    assembled pose are found. Loops that the drive does not move stay.
    A mode whose `motion.sigma_min` is zero is singular: it may stand for a continuum of poses.

    Raises ValueError for a drive that leaves freedoms (the modes would be infinitely many) or that the loops cannot
    follow, for loops that cannot be closed or agree only nearly, and inside `jit`, `vmap` and `grad`.
    """
    check_mechanism(mechanism, "assembly modes")
    check_known("assembly modes", "jk.assembly_modes", mechanism, drive)
    tries, seed = whole_number(tries, "tries", 1), whole_number(seed, "seed")
    options, linkage = options_with(options), mechanism.linkage
    ranges = _ranges(drive)
    driven = resolve(linkage, ranges)
    places = {name: (entry.joint, entry.coordinate) for name, entry in driven.items()}
    check_determined(mechanism, places, "assembly modes", "jk.assembly_modes({}, drive)", "give")
    plan = plan_drive(linkage.in_space, tuple(ranges))
    given = {name: float(np.asarray(entry.values)[0]) for name, entry in driven.items()}
    # the assembled pose itself needs no solver, which takes seconds to compile
    at_home = not any(given.values()) and opening(linkage) is None
    reached = None if at_home else mechanism.sweep(ranges, options=options)
    is_reached = reached is None or bool(reached.closed[0])
    max_residual = options.tolerance or default_tolerance(dtypes.canonicalize_dtype(float))
    starts, searched = Starts(tries, seed, options), []
    for loop_group in plan.loop_groups:
        number = linkage.structure.loop_groups.index(loop_group.members)
        loops = closed_loops(linkage, loop_group.members)
        features = PoseFeatures(loops, len(loop_freedoms(linkage)[number].motions) - len(loop_group.inputs))
        if reached is None:
            home = np.zeros(len(loop_group.columns)), loops.travel(np.zeros(len(loops.columns))).residual_norm
        else:
            there = [float(reached.displacements[joint][0, k]) for joint, k in loop_group.columns]
            home = np.array(there), float(reached.residual[0])
        inputs = np.array([list(given.values())[k] for k in loop_group.inputs])
        searched.append(find_modes(loop_group, features, inputs, home if is_reached else None, starts, max_residual))
    return _combined(mechanism, given, plan.loop_groups, searched, starts, is_reached)


def _ranges(drive: Mapping[str, float]) -> dict[str, np.ndarray]:
    """Make ranges of one pose of the numbers of a drive."""
    ranges = {}
    for name, value in by_name(drive, "inputs", "{'A': 0.3}").items():
        key = text(name, "the coordinate of an input")
        ranges[key] = one_number(value, f"the input {key!r}", "one finite number, as in {'A': 0.3}")[None]
    return ranges


def _combined(
    mechanism: Mechanism,
    given: Mapping[str, float],
    loop_groups: Sequence[DrivenLoopGroup],
    searched: Sequence[FoundPoses],
    starts: Starts,
    assembled: bool,
) -> AssemblyModes:
    """Combine the poses of all loop groups, which do not depend on each other, each with each.

    The first combination is on the branch of the assembled pose if `assembled`.
    """
    count = math.prod(len(found.displacements) for found in searched)
    if count > MAX_MODES:
        raise ValueError(f"{count} assembly modes are more than the {MAX_MODES} that are listed")
    which = list(product(*(range(len(found.displacements)) for found in searched)))
    joints = mechanism.all_joints
    rows = [np.zeros((len(which), joint.freedoms)) for joint in joints]
    for name, value in given.items():
        joint, k = coordinate(mechanism.linkage, name)
        rows[joint][:, k] = value
    residual, signs = np.zeros(len(which)), [""] * len(which)
    for number, (loop_group, found) in enumerate(zip(loop_groups, searched, strict=True)):
        chosen = [choice[number] for choice in which]
        for column, (joint, k) in enumerate(loop_group.columns):
            rows[joint][:, k] = found.displacements[chosen, column]
        residual = np.hypot(residual, found.residual[chosen])
        signs = [one + found.signs[k] for one, k in zip(signs, chosen, strict=True)]
    status = np.full(len(which), Status.JUMPED.value, np.int32)
    if assembled:
        status[:1] = Status.CLOSED.value
    wrap_angles(mechanism, rows, set(given), int(assembled))
    inputs = {name: jnp.full(len(which), value, float) for name, value in given.items()}
    poses = tuple(jnp.asarray(row, float) for row in rows), jnp.asarray(status), jnp.asarray(residual, float)
    motion = with_limited(Motion(mechanism, inputs, *poses, options=starts.options, swept=False))
    from_starts = [number for number, found in enumerate(searched) if not found.by_formulas]
    if not from_starts:
        return AssemblyModes(given, motion, tuple(signs), (), True, 0)
    # a combination was found as often as the one of its poses that was found least
    counts = (min(int(searched[number].counts[choice[number]]) for number in from_starts) for choice in which)
    return AssemblyModes(given, motion, tuple(signs), tuple(counts), False, starts.tries)
