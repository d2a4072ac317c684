"""The mechanism that users hold: a facade of its linkage, with solids, contacts and notes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jax

from jaxkin._guesses import Guided
from jaxkin._named import Named
from jaxkin._names import nearest
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.part import Part
from jaxkin.geometry.units import check_unit
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.evidence import Bond
from jaxkin.joints.joint import Joint, check_joints
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.closure_equations import ClosureEquations, closure_equations
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.alignment import aligned, asked_noise
from jaxkin.mobility.mobility import Mobility, mobility
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.topology.bodies import bodies, members
from jaxkin.topology.structure import Structure, structure

if TYPE_CHECKING:
    from jaxkin.assembly.blocking_contacts import BlockingContacts
    from jaxkin.mechanism.motion import Motion
    from jaxkin.mechanism.plan import Plan
    from jaxkin.mechanism.pose import Pose
    from jaxkin.mechanism.reassembly import Reassembly
    from jaxkin.mechanism.stream import Stream
    from jaxkin.mechanism.targets import DriveKey


@dataclass(frozen=True, eq=False, repr=False)
class Mechanism(Guided):
    """Parts held together by joints, in their assembled pose: what users hold.

    A pytree of its linkage, whose names and structure are static, so that a new geometry compiles nothing anew. Solids,
    notes and contacts are left behind where JAX takes a mechanism apart (`jit`, `grad`, `vmap`).
    """

    linkage: Linkage
    unit: str = ""
    """Unit of all lengths, such as "mm"; empty where it was not said."""
    solids: tuple[Part, ...] = field(default=())
    history: tuple[str, ...] = field(default=())
    """What was found, combined or refused on the way from solids to joints, in words."""
    alignment: tuple[str, ...] = field(default=())
    """By how much frames were moved for the rounding of their numbers, in words."""
    contacts: Mapping[str, tuple[Contact, ...]] = field(default_factory=dict)
    """The contacts that a joint stands for, by its name; none for joints by hand."""
    contacts_at_rest: tuple[Contact, ...] = field(default=())
    """Contacts of parts that only spin and are left at rest, which no joint stands for."""
    bonds: tuple[Bond, ...] = field(default=())
    """Which parts were taken as one, those of the fixed body too, each with what that is known from."""
    motors: tuple[str, ...] = field(default=())
    """What a robot file says is actuated, as `sweep` takes it: joints, or "joint.phi"."""

    @staticmethod
    def build(
        *,
        fixed: Sequence[str],
        joints: Iterable[Joint],
        couplings: Sequence[Coupling] = (),
        unit: str = "",
        align: float | int | None = None,
    ) -> Mechanism:
        """Make a mechanism of joints written by hand, in world coordinates of its assembled pose, and of couplings.

        Rounded numbers let the loops of many mechanisms close at the assembled pose only: their frames are moved by at
        most `align`, in radians and over the size of the mechanism, so that they close throughout (by default six
        digits, 0 moves nothing); and of loops that move, four-bars that lie flat to seven digits, as parallelograms do.

        Raises ValueError for names that repeat or are not there, parts that hang on nothing, and a wrong `align`.
        """
        joints = check_joints(joints)
        parts = list(dict.fromkeys(part for joint in joints for part in joint.parts))
        found = structure(parts, [(joint.name, *joint.parts) for joint in joints], fixed)
        linkage, notes = aligned(coupled(Linkage.of(joints, found), couplings), asked_noise(align), check_unit(unit))
        return Mechanism(linkage, unit, alignment=notes)

    @property
    def all_joints(self) -> tuple[Joint, ...]:
        """All joints, in the order of the columns of the incidence matrix."""
        return self.linkage.joints

    @property
    def structure(self) -> Structure:
        """Incidence, loops and structure elements."""
        return self.linkage.structure

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should look at, in words: of the way from solids, and of the alignment of frames."""
        return (*self.history, *self.alignment)

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of all parts, the fixed ones too."""
        return self.structure.part_names

    @property
    def fixed(self) -> tuple[str, ...]:
        """Names of the parts that do not move."""
        return self.structure.fixed

    @cached_property
    def bodies(self) -> dict[str, tuple[str, ...]]:
        """Parts that move as one, by the first of each body: the fixed ones, and those of joints without freedoms."""
        welds = [joint.parts for joint in self.all_joints if joint.kind is JointKind.FIXED]
        return members(bodies(self.parts, self.fixed, welds))

    @cached_property
    def joints(self) -> Mapping[str, Joint]:
        """Joints by name."""
        return Named("joint", ((joint.name, joint) for joint in self.all_joints))

    def joints_between(self, part1: str, part2: str) -> tuple[str, ...]:
        """List the names of the joints between two parts, in whichever order. ValueError for an unknown part."""
        if unknown := [part for part in (part1, part2) if part not in self.parts]:
            raise ValueError(f"there is no part {unknown[0]!r}{nearest(unknown[0], self.parts)}")
        return tuple(joint.name for joint in self.all_joints if set(joint.parts) == {part1, part2})

    def sweep(
        self,
        drive: Mapping[Any, object],
        *,
        options: SolverOptions | None = None,
        tolerance: float | jax.Array | None = None,
        method: str | None = None,
        throw: bool = False,
    ) -> Motion:
        """Compute the motion for given displacements of some joints: see `jaxkin.mechanism.sweep.sweep`."""
        from jaxkin.mechanism.sweep import sweep

        return sweep(self, drive, options=options, tolerance=tolerance, method=method, throw=throw)

    def solve(
        self,
        drive: Mapping[Any, object],
        *,
        options: SolverOptions | None = None,
        tolerance: float | jax.Array | None = None,
        throw: bool = True,
    ) -> Pose:
        """Solve one pose: `drive` gives one displacement for each driven coordinate, all else is as in `sweep`.

        Raises PoseError off the branch of the assembled pose, unless `throw=False`, which `jit` and `grad` need.
        """
        from jaxkin.mechanism.pose import Pose, one_pose

        return Pose(self.sweep(one_pose(drive), options=options, tolerance=tolerance, throw=throw))

    def stream(
        self,
        drive: Mapping[Any, object],
        chunk: int = 100_000,
        *,
        options: SolverOptions | None = None,
        tolerance: float | jax.Array | None = None,
        method: str | None = None,
    ) -> Stream:
        """Compute the motion for a range of any length in bounded memory: iterate over motions of `chunk` poses each.

        Together they are what `sweep` gives, by one program, anew whenever the result is gone through; its `len` is the
        number of chunks. Raises ValueError as `sweep`, for a chunk of no pose, and inside `jit`, `vmap` and `grad`.
        """
        from jaxkin.mechanism.stream import Stream

        return Stream(self, drive, chunk, options_with(options, tolerance, method))

    def closure(self, coordinates: Mapping[str, object]) -> ClosureEquations:
        """Evaluate the closure equations of all loops and their Jacobian, for optimisers of your own.

        `coordinates` gives for a joint, by name, one number for each of its coordinates, as a row of
        `motion.coordinates` has them; others rest. Twelve equations a loop (Eq. 11), none of couplings. A ball has its
        three angles, which are singular where phi is a quarter turn.

        Raises ValueError for a joint that is not there, and where its numbers are not as many as its coordinates.
        """
        return closure_equations(self.linkage, coordinates)

    @cached_property
    def lengths(self) -> dict[tuple[str, ...], float | jax.Array]:
        """All distances and angles between the joints of each part, and the radii of contact surfaces, by name.

        `(part, joint, joint)` is the distance: of two balls, of a ball and an axis, of two axes along their common
        normal; from a plane it is counted along its normal. `(part, joint, joint, "angle")` is the angle between two
        axes (a plane has its normal), in radians. `(part, joint, other, "offset")` is how far along the axis of the
        first joint the other one stands: the foot of a ball, or of the common normal of the two axes. `(joint,
        "radius")` is that of a round surface on a plane, `(joint, "distance")` that of two round surfaces (the sum of
        their radii, or the difference where one is in the other), `(joint, "pitch")` that of a screw. All fixed parts
        are one part. Each is measured on its own part: the same in closed and open poses, but for slides and screws.
        """
        from jaxkin.dimensions.lengths import lengths

        return lengths(self.linkage)

    def with_lengths(self, changes: Mapping[Any, Any]) -> Mechanism:
        """Make the mechanism with some of its `lengths` changed and all others as they are.

        Of the two joints that a key names the first stays where it is on its part, and the second moves with all that
        coincide with it; others stay too, and keep their distances and angles to the moved one (of three axes or more
        that are not parallel, offsets follow). Axes that coincide move apart along x of the first one's frame. A sweep
        closes the loops again; solids are left behind. Raises ValueError for a length that does not exist, is negative,
        or does not fit those kept; traced ones that do not fit make poses NONFINITE, negative ones go the other way."""
        from jaxkin.dimensions.lengths import with_lengths

        return self.with_linkage(with_lengths(self.linkage, changes))

    def with_frames(self, frames: Mapping[Any, Any], *, align: float | int | None = None) -> Mechanism:
        """Make the mechanism with some joint frames given anew, 4x4 poses in world coordinates of the assembled pose.

        A key is a joint, to move its frame on both of its parts, or `(part, joint)`, to move it on this part only.
        Numbers are aligned as by `build` unless traced. ValueError for unknown names and for what is no rigid pose."""
        from jaxkin.dimensions.frames import with_frames

        return self._aligned_with(with_frames(self.linkage, frames), align)

    def with_points(self, points: Mapping[Any, Any], *, align: float | int | None = None) -> Mechanism:
        """Make the mechanism with origins of joint frames moved to given points; all else as in `with_frames`.

        (joint, "profile"), or "profile2", replaces the points (x, y) of a profile in the axes of the profile."""
        from jaxkin.dimensions.frames import with_points

        return self._aligned_with(with_points(self.linkage, points), align)

    def at(self, motion: Motion | Pose, index: int = 0) -> Mechanism:
        """Assemble the mechanism as in pose `index` of its motion: see `jaxkin.mechanism.placed_at.mechanism_at`."""
        from jaxkin.mechanism.placed_at import mechanism_at

        return mechanism_at(self, motion, index)

    def with_couplings(self, couplings: Sequence[Coupling]) -> Mechanism:
        """Make the mechanism with coordinates tied by further couplings, as of `jk.gear`; ValueError as by `build`."""
        return replace(self, linkage=coupled(self.linkage, couplings))

    def with_linkage(self, linkage: Linkage) -> Mechanism:
        """Make the mechanism of a linkage with the same joints in other places; solids are left behind."""
        return replace(self, linkage=linkage, solids=())

    def _aligned_with(self, linkage: Linkage, align: float | int | None) -> Mechanism:
        found, notes = aligned(linkage, asked_noise(align), self.unit)
        return replace(self, linkage=found, alignment=notes, solids=())

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the mechanism into one file (.json), without solids; `jk.load(path).mechanism()` reads it back."""
        from jaxkin.io.mechanism_file import save_mechanism

        return save_mechanism(self, path)

    def plan(self, drive: Iterable[DriveKey]) -> Plan:
        """Tell what a drive of these coordinates moves, and in which order: see `jaxkin.mechanism.plan.plan`."""
        from jaxkin.mechanism.plan import plan

        return plan(self, drive)

    def mobility(self) -> Mobility:
        """Count freedoms, idle ones and redundant constraints: see `jaxkin.mobility.mobility.mobility`."""
        return mobility(self.linkage, self.unit)

    def blocking_contacts(self) -> tuple[BlockingContacts, ...]:
        """Find the contacts, or joints by hand, without which what cannot move could; the likeliest first."""
        from jaxkin.assembly.blocking_contacts import blocking_contacts

        return blocking_contacts(self)

    def close(self, *, hold: Iterable[str] = (), align: float | int | None = None) -> Reassembly:
        """Close loops, and joints in none, without a drive where the given pose is open; joints stand anew there.

        The result tells how far each part has been moved, of other assembly modes, and which loops cannot be closed;
        its `mechanism` is the re-assembled one, all lengths as they were. Coordinates in `hold` stay as they are given.
        """
        from jaxkin.mechanism.reassembly import close

        return close(self, hold, align)

    def describe(self, verbose: bool = False) -> str:
        """Tell joints, loops, mobility and notes; of many of a kind only the first one, unless `verbose`."""
        from jaxkin.mechanism.describe import describe_mechanism

        return describe_mechanism(self, verbose)

    __str__ = describe


jax.tree_util.register_pytree_node(
    Mechanism,
    lambda mechanism: ((mechanism.linkage,), (mechanism.unit, mechanism.motors)),
    lambda static, leaves: Mechanism(*leaves, static[0], motors=static[1]),
)
