"""The motion of a mechanism over a range: what a sweep gives back."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, NoReturn

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin._arguments import by_name, numbers
from jaxkin._guesses import Guided
from jaxkin._named import Named
from jaxkin._names import counted, listed, nearest
from jaxkin._runs import runs
from jaxkin._traced import traced
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.pose import is_rigid
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.joint_motion import moved_point, part_transforms
from jaxkin.linkage.point_path import point_path
from jaxkin.mechanism.joint_limits import Breach, breaches, excesses, first_within, limit_report
from jaxkin.mechanism.pose_error import check
from jaxkin.mobility.infeasible_drive import dead_point, undriven_freedoms
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status, is_closed_on_branch

if TYPE_CHECKING:
    from jaxkin.mechanism.lost_contacts import LostContact
    from jaxkin.mechanism.mechanism import Mechanism


_INTERVALS = 3
"""Intervals of the drive in which poses are closed that a text names, the longest ones: more are noise of a limit."""


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Guided):
    """The poses of a mechanism for a range of inputs. A pytree; every array has the poses as its first axis.

    Poses that did not close are there too: their displacements are those of least residual, `status` says what became
    of them, and their derivatives are zero.
    """

    mechanism: Mechanism
    inputs: dict[str, Float[Array, " poses"]]
    """Driven displacements by "joint.coordinate", in radians and in the unit of the mechanism."""
    displacements: tuple[Float[Array, "poses _"], ...]
    """Displacements of all joints, in the order of `mechanism.joints`."""
    status: Int[Array, " poses"]
    """Codes of `Status`."""
    residual: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length of the loops."""
    options: SolverOptions = field(default_factory=SolverOptions)
    """How the poses were found; effects of the motion use the same. Static data to JAX, without a traced tolerance."""
    swept: bool = True
    """Whether idle parts are where sweeps leave them: rods between balls without spin, and at rest what could leave the
    plane of its loops. False for poses found otherwise. Static data to JAX."""

    def __len__(self) -> int:
        return self.status.shape[0]

    @property
    def closed(self) -> Bool[Array, " poses"]:
        """Which poses are closed on the branch of the assembled pose: CLOSED, or LIMITED by the range of a joint."""
        return is_closed_on_branch(self.status)

    @property
    def on_branch(self) -> Bool[Array, " poses"]:
        """Which poses are on the branch of the assembled pose: closed, or as nearly closed as the joints agree."""
        return self.closed | (self.status == Status.MISFIT.value)

    def check(self) -> Motion:
        """Raise PoseError where a pose is not on the branch of the assembled pose, or is beyond the limits of a joint.

        The error names what is wrong with how many poses, the first one of each kind, and a remedy; else the motion is
        returned.

        Raises ValueError inside `jit`, `vmap` and `grad`, where the statuses are no numbers yet.
        """
        check(self)
        return self

    @cached_property
    def beyond_limits(self) -> Mapping[str, Float[np.ndarray, " poses"]]:
        """How far coordinates are beyond the limits of their joints, by "joint.coordinate": radians or lengths.

        Above 0 beyond the highest displacement, below 0 beyond the lowest, 0 within the limits and at poses off the
        branch. Only coordinates that are beyond at some pose are listed: empty where all poses are within all limits.
        Raises ValueError inside `jit`, `vmap` and `grad`: there read the status LIMITED.
        """
        if traced(self.displacements):
            raise ValueError(
                "beyond_limits looks at numbers, which JAX traces here: inside jit, vmap and grad read motion.status"
            )
        return excesses(self)

    @cached_property
    def sigma_min(self) -> Float[Array, " poses"]:
        """How near to singular each pose is: the smallest singular value of the closure Jacobian not always zero.

        Of the equations that are solved, for radians and characteristic lengths; of the worst loop group, infinite
        where no loop is driven. A pose is right to about its residual over this value, and derivatives grow as one over
        it: at a dead point or a change point, where it is zero, a closed loop is accurate to the square root of
        rounding only.
        """
        from jaxkin.mechanism.singularity import sigma_min

        return sigma_min(self)

    @cached_property
    def coordinates(self) -> Mapping[str, Float[Array, "poses _"]]:
        """Displacements of each joint, in the order of its `coordinates`; angles count full turns."""
        return Named("joint", zip(self.mechanism.joints, self.displacements, strict=True))

    @cached_property
    def transforms(self) -> Mapping[str, Float[Array, "poses 4 4"]]:
        """Displacement of each part from its assembled pose, in world coordinates (Section 5.2)."""
        return Named(
            "part", zip(self.mechanism.parts, part_transforms(self.mechanism.linkage, self.displacements), strict=True)
        )

    def poses(
        self, places: Mapping[str, Float[Array | np.ndarray, "4 4"]], relative_to: str | None = None
    ) -> dict[str, Float[Array, "poses 4 4"]]:
        """Compute the poses of parts in the world, or relative to one of them, from those of the assembled pose.

        `places` are the 4x4 poses of parts in the assembled pose, in the world, as files of robots have them; a pose
        follows as displacement times place. Raises ValueError for unknown parts, and for what is no rigid pose.
        """
        places = by_name(places, "places", "{'arm': np.eye(4)}")
        for part in (*places, *([relative_to] if relative_to is not None else [])):
            if part not in self.transforms:
                raise ValueError(f"there is no part {part!r}{nearest(part, self.mechanism.parts)}")
        if relative_to is not None and relative_to not in places:
            raise ValueError(f"poses relative to {relative_to!r} need its place, too")
        found = {part: self.transforms[part] @ _place(part, place) for part, place in places.items()}
        if relative_to is None:
            return found
        base = jnp.linalg.inv(found[relative_to])
        return {part: base @ pose for part, pose in found.items()}

    @cached_property
    def lost_contacts(self) -> tuple[LostContact, ...]:
        """The contacts of the solids whose faces are apart at some poses: found when it is asked for.

        A joint is read from faces that touch in the assembled pose, and stays what it is beyond their ends; the poses
        there are CLOSED. `loose` of a lost contact are the poses at which the contacts that are left do not make its
        joint. `print(motion)` tells them, and the pictures mark them. From the extents of the faces alone: what is told
        is surely lost. Empty for mechanisms without solids and for joints by hand.
        """
        from jaxkin.mechanism.lost_contacts import lost_contacts

        return lost_contacts(self)

    def points(self, part: str, point: Sequence[float | int] | np.ndarray | Array) -> Float[Array, "poses 3"]:
        """Compute the path of a point of a part, given where it is in the assembled pose (world coordinates)."""
        if part not in self.mechanism.parts:
            raise ValueError(f"there is no part {part!r}{nearest(part, self.mechanism.parts)}")
        if traced((self.mechanism.linkage, self.displacements, point)):
            return point_path(self.mechanism.linkage, self.displacements, part, as_point(point))
        return moved_point(self.transforms[part], as_point(point))

    def save(self, directory: str | os.PathLike[str], only: str | Collection[str] | None = None) -> tuple[Path, ...]:
        """Write tables, animation and pictures into a directory, or one file, as in "rocker.csv"; returns the paths.

        `only` chooses some of the files by name; see `jaxkin.io.writers.save`.
        """
        from jaxkin.io.writers import save

        return save(self, directory, only)

    def __getitem__(self, name: object) -> NoReturn:
        raise TypeError(
            "a motion has no items: write motion.transforms['part'] or motion.points('part', (x, y, z)) for a part, "
            f"motion.coordinates['joint'] for a joint, motion.inputs for the drive; got {name!r}"
        )

    def __iter__(self) -> NoReturn:
        raise TypeError("a motion is no sequence: each of its arrays has the poses as its first axis")

    def __repr__(self) -> str:
        return f"<{self._headline()}>"

    def _headline(self) -> str:
        shape = np.shape(self.status)  # what JAX puts in the place of arrays may have none
        poses = f" over {counted(shape[0], 'pose')}" if shape else ""
        return f"Motion of {len(self.mechanism.parts)} parts{poses}, driven by {', '.join(self.inputs)}"

    def __str__(self) -> str:
        if traced(self):
            return f"{self._headline()}: traced by JAX, its numbers are known outside of jit, vmap and grad"
        counts = np.bincount(np.asarray(self.status), minlength=len(Status))
        found = Tally(counts, largest_residuals(self), self.lost_contacts, breaches(self))
        found = found._replace(within=first_within(self), intervals=_closed_intervals(self))
        told = tell(found, self.mechanism, self.inputs)
        if not any(joint.curves for joint in self.mechanism.all_joints):
            return told
        from jaxkin.effects.curve_contacts import curve_contacts

        followed = curve_contacts(self)
        return told if followed.holds else "\n  ".join([told, *str(followed).splitlines()])


def as_point(point: Sequence[float | int] | np.ndarray | Array) -> Float[Array, "3"]:
    """Convert three finite numbers, in the unit of the mechanism, to an array; ValueError where they are none."""
    expected = "three finite numbers (x, y, z)"
    found = numbers(point, "a point", expected)
    if found.shape != (3,):
        raise ValueError(f"a point must be {expected}, got shape {found.shape}")
    if not traced(found) and not np.isfinite(found).all():
        raise ValueError(f"a point must be {expected}, got {point!r}")
    return jnp.asarray(found)


def _place(part: str, given: Float[Array | np.ndarray, "4 4"]) -> Float[Array, "4 4"]:
    """Convert the place of a part to an array; ValueError for what is no rigid pose, a traced one is not looked at."""
    expected = "a rigid 4x4 pose, as of motion.transforms"
    found = numbers(given, f"the place of {part!r}", expected)
    if found.shape != (4, 4) or not (traced(found) or is_rigid(np.asarray(found, float))):
        raise ValueError(f"the place of {part!r} must be {expected}, got {given!r}")
    return jnp.asarray(found)


def _closed_intervals(motion: Motion) -> str:
    """Tell between which values of the drive, degrees or lengths, poses are closed on the branch, or between which
    poses where there are several drives; empty where all or none are."""
    closed = np.asarray(motion.on_branch)
    if closed.all() or not closed.any():
        return ""
    order, said, at, of = np.arange(len(closed)), np.arange(len(closed)).astype(str), "pose ", ""
    if len(motion.inputs) == 1:
        ((name, given),) = motion.inputs.items()
        scale, unit = (1.0, motion.mechanism.unit) if is_length(name.rpartition(".")[2]) else (180.0 / np.pi, "deg")
        values, at, of = scale * np.asarray(given, float), "", f" {unit}".rstrip() + f" of {name}"
        order, said = np.argsort(values, kind="stable"), np.array([f"{value:.4g}" for value in values])
    found = runs(closed[order])
    longest = np.sort(np.argsort(found[:, 0] - found[:, 1], kind="stable")[:_INTERVALS])
    ends = said[order][np.stack([found[longest, 0], found[longest, 1] - 1], axis=1)]
    told = [f"at {at}{first}" if first == last else f"from {at}{first} to {last}" for first, last in ends]
    more = f", and in {len(found) - len(told)} shorter intervals" if len(told) < len(found) else ""
    return f"closed {' and '.join(told)}{of}{more}"


def largest_residuals(motion: Motion) -> Float[np.ndarray, " status"]:
    """Find the largest closure residual among the poses of each status."""
    status, residual = np.asarray(motion.status), np.nan_to_num(np.asarray(motion.residual, float))
    return np.array([residual[status == each].max(initial=0.0) for each in Status])


class Tally(NamedTuple):
    """What became of the poses of a motion, or of all chunks of a stream."""

    counts: Int[np.ndarray, " status"]
    """How many have each status."""
    largest: Float[np.ndarray, " status"]
    """The largest closure residual of those of each status."""
    lost: Sequence[LostContact]
    beyond: Sequence[Breach]
    """The limits of joints that they pass."""
    within: int | None = None
    """That of `limit_report`."""
    intervals: str = ""
    """Where poses are closed, in words; empty where all or none are."""


def tell(found: Tally, mechanism: Mechanism, inputs: Mapping[str, np.ndarray | Array]) -> str:
    """Tell in words what became of poses: how many of each status, the largest residual of closed ones, limits passed,
    faces left."""
    from jaxkin.mechanism.lost_contact_report import lost_contact_report

    counts = found.counts
    poses = counted(counts.sum(), "pose")
    lines = [f"Motion of {len(mechanism.parts)} parts over {poses}, driven by {', '.join(inputs)}"]
    lines += [f"  {counts[status]:>6}  {status.name}: {status.message}" for status in Status if counts[status]]
    lines += [f"  {found.intervals}"] if found.intervals else []
    driven = [coordinate(mechanism.linkage, name) for name in inputs]
    if counts[Status.STALLED] and (why := dead_point(mechanism.linkage, driven)):
        lines.append(f"  {why}")
    for status, which in ((Status.CLOSED, "closed"), (Status.MISFIT, "misfit")):
        if counts[status]:
            lines.append(f"  largest closure residual of the {which} poses: {found.largest[status]:.1e}")
    if free := undriven_freedoms(mechanism.linkage, driven):
        lines.append(f"  freedoms without a drive move as little as they can; it could be {listed(free)}")
    lines += [f"  {line}" for line in limit_report(found.beyond, mechanism, inputs, found.within)]
    lines += [f"  {line}" for line in lost_contact_report(found.lost, mechanism, inputs)]
    return "\n".join(lines)


jax.tree_util.register_dataclass(
    Motion, data_fields=["mechanism", "inputs", "displacements", "status", "residual"], meta_fields=["options", "swept"]
)
