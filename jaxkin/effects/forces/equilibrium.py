"""Poses in which a mechanism stands without a drive: where the drive force vanishes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from jaxkin._arguments import by_name, check_known, check_mechanism, numbers
from jaxkin._guesses import Result
from jaxkin._names import listed
from jaxkin.effects.forces.acting import STANDARD_GRAVITY, all_applied, loads_and_frictions
from jaxkin.effects.forces.drive import drive_forces
from jaxkin.effects.forces.given import Applied, rows_per_pose
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.reactions import HELD, Reactions, reactions
from jaxkin.effects.forces.rounding import force_terms, weights_of_all
from jaxkin.effects.forces.vanishing import WITHIN, PerPose, vanishing
from jaxkin.effects.forces.wrenches import units_of
from jaxkin.effects.pose_axis import shown_input
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.headings import coordinate_with_unit
from jaxkin.geometry.movements import is_length
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.status import Status

MAX_NAMED = 4
"""Coordinates without a drive that a printed result names at most: one freedom shows in several."""
NO_FORCE = 16
"""Units of rounding of the terms of a drive force (`force_terms`) up to which it counts as none. A four-bar in a
horizontal plane that is drawn askew has forces of one or two."""


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Result):
    """Where a drive is not needed within its range: in single displacements, or everywhere in an interval.

    Prints, draws and saves itself.
    """

    name: str
    """The driven coordinate."""
    values: Float[np.ndarray, " equilibria"]
    """Its displacements in equilibrium, rising: radians, or the unit of the mechanism."""
    stable: Bool[np.ndarray, " equilibria"]
    """Whether the mechanism comes back from beside it: the drive force grows with the displacement."""
    unstable: Bool[np.ndarray, " equilibria"]
    """Whether it moves away from beside it: the drive force falls. Where neither is said, it is not known, as beside a
    limit of the motion."""
    indifferent: Float[np.ndarray, "intervals 2"]
    """Intervals from the first to the last of neighbouring poses of the range, none of which needs a drive."""
    motion: Motion
    """The poses in equilibrium."""
    out_of_balance: Mapping[str, float]
    """For each coordinate without a drive that would not stay in all these poses, the largest load that would hold it,
    newton metres or newtons. Such a pose is no equilibrium of the mechanism, and neither stable nor unstable."""
    inputs: PerPose
    """The range that was searched, rising."""
    forces: Float[np.ndarray, " poses"]
    """Drive forces there, newton metres or newtons; NaN at poses that are not closed (`motion.closed`)."""
    limited: Bool[np.ndarray, " poses"]
    """At which poses of the range a joint is beyond its limits; of equilibria `beyond_limits` tells."""

    @property
    def beyond_limits(self) -> Mapping[str, Float[np.ndarray, " equilibria"]]:
        """How far coordinates are beyond the limits of their joints in the equilibria: see `Motion.beyond_limits`.

        Empty where all are within. Equilibria beyond are found, too: the mechanism would rest on a stop before.
        """
        return self.motion.beyond_limits

    def __str__(self) -> str:
        unit = " rad" if not is_length(self.name.rpartition(".")[2]) else f" {self.motion.mechanism.unit}".rstrip()
        poses = f"{self.inputs[0]:.4g} to {self.inputs[-1]:.4g}{unit}"
        if unknown := int(np.isnan(self.forces).sum()):
            poses += f"; at {unknown} of its {len(self.inputs)} poses, which are not closed, nothing is known"
        lines = [
            f"  everywhere from {low:.9g} to {high:.9g}{unit}, indifferent{self._limited(low, high)}"
            for low, high in self.indifferent
        ]
        for number, (value, (words, _)) in enumerate(zip(self.values, self._told(), strict=True)):
            over = listed([each for each, far in self.beyond_limits.items() if far[number]])
            lines.append(f"  {value:.9g}{unit}, {words}{f', but beyond the limits of {over}' if over else ''}")
        if not lines:
            return f"No equilibrium of {self.name} from {poses}"
        count = "1 equilibrium" if len(lines) == 1 else f"{len(lines)} equilibria"
        return "\n".join([f"{count} of {self.name} from {poses}", *lines, *self._what_moves()])

    def _what_moves(self) -> list[str]:
        """Say which coordinates without a drive do not stay where they are."""
        if not self.out_of_balance:
            return []
        loads = [f"{load:.3g} {units_of(self.motion, name)[0]}" for name, load in self.out_of_balance.items()]
        some = [f"{name} (up to {load})" for name, load in zip(self.out_of_balance, loads, strict=True)][:MAX_NAMED]
        more = len(loads) - len(some)
        return [
            f"  but no equilibria of the mechanism: loads would have to hold {', '.join(some)}"
            f"{f' and {more} more' if more else ''}, without a drive; hold one of them, as in "
            f"{{{self.name!r}: ..., {next(iter(self.out_of_balance))!r}: 0.0}}, or balance it"
        ]

    def _limited(self, low: float, high: float) -> str:
        """Say at how many poses of an interval a joint is beyond its limits."""
        inside = (self.inputs >= low) & (self.inputs <= high)
        limited = int(np.sum(self.limited & inside))
        return f", but a joint is beyond its limits at {limited} of its {inside.sum()} poses" if limited else ""

    def _told(self) -> list[tuple[str, str]]:
        """Say of each single equilibrium whether it is stable, in words and by a marker."""
        known = {(True, False): ("stable", "o"), (False, True): ("unstable", "x")}
        both = zip(self.stable.tolist(), self.unstable.tolist(), strict=True)
        return [known.get(each, ("not known whether stable", "d")) for each in both]

    def plot(self, path: str | Path) -> Path:
        """Draw the drive force over the displacement, with the equilibria, into a picture file; returns its path."""
        label = f"drive force ({units_of(self.motion, self.name)[0]})"
        values = np.concatenate([self.values, self.indifferent.ravel()])
        markers = [marker for _, marker in self._told()] + ["|"] * self.indifferent.size
        marks = list(zip(shown_input(self.motion, self.name, values).values.tolist(), markers, strict=True))
        meant = {"o": "o stable", "x": "x unstable", "d": "diamond not known", "|": "indifferent from | to |"}
        told = ", ".join(words for marker, words in meant.items() if marker in {marker for _, marker in marks})
        title = f"equilibria: {told}" if marks else "no equilibrium"
        axis = shown_input(self.motion, self.name, self.inputs).axis()
        return draw_lines([self.name], self.forces[None], label, title, Path(path), axis=axis, marks=marks)

    def save(self, path: str | Path) -> Path:
        """Write the equilibria as comma-separated values, one row each; returns the path.

        Both ends of an interval have rows, in which, as where it is not known, "stable" is NaN.
        """
        stable = np.where(self.stable | self.unstable, self.stable, np.nan)
        values = np.concatenate([self.values, self.indifferent.ravel()])
        order = np.argsort(values, kind="stable")
        stable = np.concatenate([stable, np.full(self.indifferent.size, np.nan)])
        name = coordinate_with_unit(self.name, self.motion.mechanism.unit)
        return save_rows([name, "stable"], np.stack([values, stable])[:, order], Path(path))


def equilibrium(
    mechanism: Mechanism,
    drive: Mapping[Any, Any],
    masses: Masses | None = None,
    *,
    gravity: Any = STANDARD_GRAVITY,
    applied: Iterable[Applied] | Applied = (),
) -> Equilibrium:
    """Find the displacements of one driven coordinate at which its force vanishes at rest.

    `drive` gives the range to search, `{"A": np.linspace(0, 2 * np.pi, 73)}`, and single displacements at which other
    coordinates are held, by whatever force: `{"A": ..., "E": 0.2}`. Equilibria are told apart by the steps of the
    range, and refined to 1e-12 of it, in float32 to rounding; where neighbouring poses need no drive, as of a linkage
    in a horizontal plane, the mechanism is indifferent from the first to the last of them. Other arguments are those
    of `jk.drive_forces`, for all poses alike. Poses must follow each other on the branch of the assembled pose; no
    equilibrium is found between poses that are not closed (`motion.closed`). Freedoms that nothing drives or holds may
    be out of balance there: these are told (`out_of_balance`), and so are equilibria in which a joint is beyond its
    limits (`beyond_limits`).

    Raises ValueError for ranges of several coordinates, for fewer than two poses, inside `jit`, `vmap` and `grad`, and
    as `jk.drive_forces`.
    """
    check_mechanism(mechanism, "equilibria")
    drive = by_name(drive, "driven displacements", "{'A': np.linspace(0, 2 * np.pi, 73)}")
    given, frictions = loads_and_frictions(all_applied(applied))
    check_known("equilibria", "jk.equilibrium", mechanism, dict(drive), masses, given, frictions, gravity)
    if frictions:
        raise ValueError(
            f"friction in {frictions[0].joint!r} has no direction at rest, where the mechanism stays over a range of "
            "displacements: leave friction out, and see where the forces of jk.drive_forces with rates of 1e-6 and of "
            "-1e-6 along a sweep have opposite signs"
        )
    for load in given:
        if rows := rows_per_pose(load):
            raise ValueError(
                f"loads of an equilibrium are the same in all poses, and {type(load).__name__} has {', '.join(rows)} "
                "with one row a pose: give single numbers, or find where jk.drive_forces vanishes along a sweep"
            )
    key, inputs, held = _range_and_held(drive)
    name = next(iter(coordinates(mechanism.linkage, [key])))

    def posed(values: PerPose) -> Motion:
        return mechanism.sweep({key: values, **{each: np.full(len(values), *at) for each, at in held.items()}})

    def of_one_length(values: PerPose) -> Motion:
        # so that all share a compiled program
        return posed(np.pad(values, (0, max(0, len(inputs) - len(values))), mode="edge"))

    def force_along(poses: Motion) -> PerPose:
        return np.asarray(drive_forces(poses, masses, gravity=gravity, applied=given).forces[name], float)

    def force(values: PerPose) -> PerPose:
        return force_along(of_one_length(values))[: len(values)]

    def rounding_of(values: PerPose) -> PerPose:
        terms = force_terms(of_one_length(values), name, masses, gravity, given)
        return NO_FORCE * rounding * terms[: len(values)]

    def vanishes(values: PerPose) -> Bool[np.ndarray, " poses"]:
        return np.abs(force(values)) <= rounding_of(values)

    searched, rounding = posed(inputs), float(jnp.finfo(float).eps)
    forces = force_along(searched)
    least = rounding_of(inputs)
    forces = np.where(np.abs(forces) <= least, 0.0, forces)
    values, indifferent = vanishing(force, vanishes, inputs, forces, max(WITHIN, rounding))
    # of a central difference: the cube root of rounding
    step = rounding ** (1 / 3) * np.ptp(inputs)
    beside = force(np.concatenate([values - step, values + step])) if len(values) else np.zeros(0)
    growth = beside[len(values) :] - beside[: len(values)]
    if len(values):  # a force that grows by no more than rounding may fall
        growth = np.where(np.abs(growth) <= rounding_of(values), 0.0, growth)
    loads: dict[str, PerPose] = {}
    if (len(values) or len(indifferent)) and _has_others(mechanism, len(drive)):
        poses = posed(np.concatenate([values, inputs[indifferent].ravel()]))
        most = HELD * max(float(np.nanmax(np.abs(forces))), weights_of_all(poses, name, masses, gravity))
        loads = _out_of_balance(reactions(poses, masses, gravity=gravity, applied=given), most)
    still = ~np.any([np.zeros(len(values), bool), *(load[: len(values)] != 0 for load in loads.values())], axis=0)
    return Equilibrium(
        name,
        values,
        (growth > 0) & still,
        (growth < 0) & still,
        inputs[indifferent],
        posed(values),
        {each: float(load.max()) for each, load in loads.items()},
        inputs,
        forces,
        np.asarray(searched.status) == Status.LIMITED.value,
    )


def _range_and_held(drive: Mapping[Any, Any]) -> tuple[str, PerPose, dict[str, PerPose]]:
    """Check a drive: the coordinate that has a range, this range, rising, and the one displacement of each other."""
    given = {key: np.unique(numbers(some, f"the range of {key!r}").ravel()) for key, some in drive.items()}
    if not given:
        raise ValueError("an equilibrium is found along a driven coordinate: give {'A': np.linspace(0, 2 * np.pi, 73)}")
    key, *more = [key for key, some in given.items() if len(some) > 1] or [*given][:1]
    if more:
        raise ValueError(
            f"an equilibrium is found along one driven coordinate, got ranges of {1 + len(more)}; hold the others with "
            f"one displacement each, as in {{{key!r}: np.linspace(0, 2 * np.pi, 73), {more[0]!r}: 0.0}}"
        )
    inputs = given.pop(key)
    if len(inputs) < 2 or not np.isfinite(inputs).all():
        got = f"{len(inputs)}" if np.isfinite(inputs).all() else "some that are not finite"
        raise ValueError(
            f"the range of {key!r} must be two displacements or more, all finite, as np.linspace(0, 2 * np.pi, 73), "
            f"got {got}"
        )
    if empty := [name for name, some in given.items() if not len(some)]:
        raise ValueError(f"the displacement at which {empty[0]!r} is held must be one number, got none")
    return key, inputs, given


def _has_others(mechanism: Mechanism, driven: int) -> bool:
    """Tell whether a mechanism has more freedoms that are not idle than are driven or held."""
    found = mechanism.mobility()
    return found.freedoms - found.idle_freedoms > driven


def _out_of_balance(found: Reactions, most: float) -> dict[str, PerPose]:
    """Find the loads that hold coordinates without a drive, zero where they are at most `most`; none where all are."""
    loads = {
        full_name: np.abs(np.nan_to_num(np.asarray(found.held[name], float)[:, k]))
        for name, joint in found.motion.mechanism.joints.items()
        for k, full_name in enumerate(joint.full_names)
    }
    return {name: np.where(load > most, load, 0.0) for name, load in loads.items() if np.any(load > most)}
