"""An assembly: the parts of a mechanism as solids in their assembled pose, and the way from there to a mechanism."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from jaxkin._arguments import several, text
from jaxkin._grouped import SCREEN, grouped, kind_of, products, shortened
from jaxkin._guesses import Guided
from jaxkin._names import counted, match_parts, may_be_pattern, nearest
from jaxkin.assembly.exported import Exported
from jaxkin.assembly.from_export import from_export
from jaxkin.assembly.ignored_contacts import check_ignored, ignored_in_full
from jaxkin.assembly.inference.measured import Measured
from jaxkin.assembly.left_loose import left_loose
from jaxkin.assembly.proposals import Proposal, proposals
from jaxkin.assembly.to_mechanism import MechanismOptions, check_options, make_mechanism, without_rigid_joints
from jaxkin.assembly.with_inferences import with_inferences
from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.contacts.detect import find_contacts, is_about
from jaxkin.contacts.tolerance import ContactTolerance, check_tolerances
from jaxkin.geometry.part import Part
from jaxkin.geometry.units import METRES, unit_name
from jaxkin.joints.joint import Joint, check_joints

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_DEFAULT_TOLERANCES = (None, ContactTolerance.angle, ContactTolerance.fit)
"""Those of `Assembly.contacts`."""


@dataclass(frozen=True, eq=False)
class Assembly(Guided):
    """Solids in their assembled pose, as they were read."""

    parts: tuple[Part, ...]
    unit: str
    """Unit of all lengths, such as "mm"; "" where the files have none and none was said."""
    source: str
    """The file that it was read from."""
    exported: Exported | None = None
    """What the file itself says of joints and bodies: the export of a CAD system, a robot; None where it is solids."""
    saved: Mechanism | None = None
    """The mechanism that the file holds, where `Mechanism.save` wrote it."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts."""
        return tuple(part.name for part in self.parts)

    def contacts(
        self,
        *,
        length: float | None = None,
        angle: float = ContactTolerance.angle,
        fit: float = ContactTolerance.fit,
        progress: Callable[[int, int], None] | None = None,
    ) -> Contacts:
        """Find the contacts between the parts, and what is nearly one; found once for each choice of tolerances.

        `length` (in the unit of the assembly; by default 1e-5 of its diagonal, or what its file is rounded by), `angle`
        (radians; 1e-4) and `fit` (clearance over radius; 0.02) say what still counts as touching: see
        `jaxkin.contacts.detect.find_contacts`.
        `progress(done, total)` is called after each pair of parts whose boxes meet. Raises ValueError for a `length` or
        an `angle` that is not positive, and for a negative `fit`.
        """
        check_tolerances(length, angle, fit)
        tolerances = (length, angle, fit)
        if tolerances not in self._found:
            self._found[tolerances] = find_contacts(self.parts, *tolerances, progress)
        return self._found[tolerances]

    def mechanism(
        self,
        *,
        fixed: Sequence[str] = (),
        rigid: Sequence[Sequence[str]] = (),
        ignore: Sequence[Sequence[str]] = (),
        joints: Iterable[Joint] = (),
        combine: bool = True,
        contacts: Sequence[Contact] | None = None,
        align: float | int | None = None,
        exclude: Sequence[str] = (),
        infer: bool = True,
        clearance: float | int | None = None,
    ) -> Mechanism:
        """Make the mechanism that the contacts make, with the parts named in `fixed` at rest.

        A file that `Mechanism.save` wrote holds the whole mechanism, which nothing need be said about. Where the file
        is the export of a CAD system, its joints, mates and rigid groups make the mechanism instead, and `fixed` may be
        left out; contacts do where `contacts` are given, or with `infer=False`. Without contacts there is nothing that
        `combine` and `clearance` are about: they are refused then.

        Beside exact contacts it takes what solids imply: pins with clearance or interference, bores without a pin,
        bolts and what they hold, parts that only one other holds (`jaxkin.assembly.inference`). Each inference is told
        by `notes`, and by the `evidence` of its joint. Parts are named in full or by patterns, `fixed=["Base*"]`, also
        with the sub-assemblies that they are in, `fixed=["Arm/Base*"]`.

        - `rigid`: groups of parts that do not move relative to each other, `[["bolt", "plate"]]`. A group is one body;
          its first part in the order of the assembly holds each of the others by a joint without freedoms.
        - `ignore`: contacts to leave out, by their two parts, `[["slider", "stop"]]`, between which nothing is inferred
          either, or by their faces as reports print them, `[["slider face 3", "stop face 7"]]`. Of the pairs that
          patterns stand for some need not touch.
        - `joints`: joints by hand. They replace all contacts between their two bodies, or join what does not touch.
        - `combine`: the contacts of two bodies become the one joint that they amount to, where there is one; without
          it every contact is a joint, as in the paper. All fixed parts are one body (Section 4.1).
        - `contacts`: those found with other tolerances, or a selection; by default `self.contacts()`.
        - `exclude`: parts to leave out.
        - `infer`: without it contacts that are exact are all, as in the paper; parts that they tie to nothing are
          refused. Neither is anything inferred with `combine=False`.
        - `clearance`: the largest radial clearance of a pin that is inferred to be in its hole, in the unit of the
          assembly; by default 0.29 of the radius.
        - `align`: the largest misalignment, in radians or over the size, that is taken for rounding: see
          `Mechanism.build`. What files in single precision leave is taken out in any case.

        Contacts within a body are left out. Raises ValueError for names that do not exist, entries that are no such
        groups or pairs, words that say nothing about what makes the mechanism, no fixed part, and where a part touches
        nothing or hangs on nothing.
        """
        if self.saved is not None:
            nothing = contacts is None and align is None and clearance is None
            if fixed or rigid or ignore or joints or exclude or not (nothing and combine and infer):
                raise ValueError(f"{self.source} holds a whole mechanism: write .mechanism() without other words")
            return self.saved
        if left := _in_full(exclude, self.parts, "exclude"):
            if contacts is None and not (infer and self.exported):
                contacts = self.contacts()
            return self.without(left).mechanism(
                fixed=fixed,
                rigid=rigid,
                ignore=ignore,
                joints=joints,
                combine=combine,
                contacts=None if contacts is None else self._contacts_without(contacts, left),
                align=align,
                infer=infer,
                clearance=clearance,
            )
        options = MechanismOptions(
            _in_full(fixed, self.parts, "fixed"),
            _groups(rigid, self.parts),
            ignored_in_full(ignore, self.parts),
            check_joints(joints),
            combine,
            align,
            clearance,
        )
        if infer and contacts is None and self.exported is not None:
            return from_export(self, self.exported, options)
        contacts = self.contacts() if contacts is None else contacts
        check_options(self.names, options)
        if not (infer and combine):
            check_ignored(contacts, options.ignore)
        plain = not (rigid or ignore or options.joints) and combine and infer and align is None and clearance is None
        made = self._made if plain and contacts is self._found.get(_DEFAULT_TOLERANCES) else {}
        if options.fixed not in made:
            made[options.fixed] = (with_inferences if infer and combine else make_mechanism)(self, contacts, options)
        return made[options.fixed]

    def of_joints(
        self,
        *,
        fixed: Sequence[str],
        rigid: Sequence[Sequence[str]] = (),
        joints: Iterable[Joint] = (),
        align: float | int | None = None,
        exclude: Sequence[str] = (),
    ) -> Mechanism:
        """Make the mechanism that rigid groups and joints by hand make alone, without contacts and inferences.

        What they tie to nothing is left at rest, and a note names it. With the parts in `exclude` goes all that is said
        of them. Joints of two parts that `rigid` or `fixed` make one body are left out, and notes name them. Otherwise
        as `mechanism`.
        """
        left = {*_in_full(exclude, self.parts, "exclude")}
        groups = [[part for part in group if part not in left] for group in _groups(rigid, self.parts)]
        options = MechanismOptions(
            [part for part in _in_full(fixed, self.parts, "fixed") if part not in left],
            [group for group in groups if len(group) > 1],
            joints=[each for each in check_joints(joints) if left.isdisjoint(each.parts)],
            align=align,
        )
        kept = self.without(left)
        check_options(kept.names, options)
        options, notes = without_rigid_joints(kept.names, options)
        made = make_mechanism(kept, Contacts(()), options, left_loose(kept.names, options))
        return replace(made, history=(*notes, *made.history))

    def proposals(
        self,
        fixed: Sequence[str] | None = None,
        drive: Sequence[str] | None = None,
        *,
        progress: Callable[[int, int], None] | None = None,
    ) -> tuple[Proposal, ...]:
        """Try which parts to fix and what to drive, the best first: see `jaxkin.assembly.proposals.proposals`."""
        return proposals(self, None if fixed is None else _in_full(fixed, self.parts, "fixed"), drive, progress)

    def without(self, names: Collection[str]) -> Assembly:
        """Make the assembly without some parts, by names or patterns. ValueError for names that are not there."""
        if not names:
            return self
        names = _in_full([*names], self.parts, "exclude")
        for name in names:
            if name not in self.names:
                raise ValueError(f"exclude names the unknown part {name!r}{nearest(name, self.names)}")
        parts = tuple(part for part in self.parts if part.name not in names)
        return replace(self, parts=parts, exported=self.exported and self.exported.without(names))

    def _contacts_without(self, contacts: Sequence[Contact], names: Collection[str]) -> Contacts:
        """Find the contacts, near misses and notes that none of some parts takes part in."""
        kept = tuple(each for each in contacts if not {*each.parts} & {*names})
        if not isinstance(contacts, Contacts):
            return Contacts(kept)
        nearly = tuple(miss for miss in contacts.near_misses if not {*miss.parts} & {*names})
        left = [part for part in self.parts if part.name in names]
        notes = tuple(note for note in contacts.notes if not any(is_about(note, part) for part in left))
        return Contacts(kept, nearly, notes)

    @property
    def found(self) -> tuple[Contacts, ...]:
        """What was detected so far, with whichever tolerances."""
        return tuple(self._found.values())

    @cached_property
    def _found(self) -> dict[tuple[float | None, float, float], Contacts]:
        return {}

    @cached_property
    def _made(self) -> dict[Sequence[str], Mechanism]:
        """Mechanisms for which nothing was said but their fixed parts, by these: proposals make several."""
        return {}

    @cached_property
    def _measured(self) -> Measured:
        """What is measured of the solids for inferences."""
        return Measured(self.parts, METRES[self.unit])

    def __str__(self) -> str:
        return self.describe()

    def describe(self, verbose: bool = False) -> str:
        """Tell the parts, their faces and what was noted of them; of many parts one a product, unless `verbose`."""
        unit = unit_name(self.unit) or "a unit that the file does not say"
        count = "1 part" if len(self.parts) == 1 else f"{len(self.parts)} parts"
        lines = [f"Assembly of {count} from {self.source}, lengths in {unit}"]
        notes = sum(len(part.notes) for part in self.parts)
        if verbose or len(self.parts) + notes <= SCREEN:
            width = max(map(len, self.names), default=0)
            for part in self.parts:
                lines.append(f"  {part.name.ljust(width)}  {_faces(part)}")
                lines += [f"  {' ' * width}    {note}" for note in part.notes]
            return "\n".join(lines)
        product = products(self.names)
        alike: dict[tuple[str, str], list[str]] = {}
        for part in self.parts:
            alike.setdefault((product[part.name], _faces(part)), []).append(part.name)
        rows = [
            f"{names[0]}: {faces}" if len(names) == 1 else f"{name} ({len(names)} times): {faces}"
            for (name, faces), names in alike.items()
        ]
        lines += [f"  {row}" for row in shortened(rows)]
        told = [(kind_of(note), f"{part.name}: {note}") for part in self.parts for note in part.notes]
        return "\n".join([*lines, *(f"  {line}" for line in grouped(told))])

    def __repr__(self) -> str:
        return f"<Assembly {self.source!r}: {', '.join(self.names)}; {self.unit}>"


def _in_full(names: Sequence[str], parts: Sequence[Part], what: str) -> Sequence[str]:
    """Replace patterns with "*", "?" or "/" by names in full; other names are checked where they are used."""
    known = {part.name for part in parts}
    found: dict[str, None] = {}
    for name in several(names, what, "part names"):
        pattern = text(name, f"an entry of {what}") not in known and may_be_pattern(name)
        found |= dict.fromkeys(match_parts(name, parts, what) if pattern else [name])
    return tuple(found)


def _groups(rigid: Sequence[Sequence[str]], parts: Sequence[Part]) -> Sequence[Sequence[str]]:
    groups = several(rigid, "rigid", "groups of parts", '[["bolt", "plate"]]')
    return [group if isinstance(group, str) else _in_full(group, parts, "rigid") for group in groups]


def _faces(part: Part) -> str:
    """Tell what a part is made of: its faces by kind, or else its triangles."""
    if not part.is_solid:
        return "no solid: drawn as a small box"
    kinds = Counter(face.surface.kind for face in part.faces)
    faces = ", ".join(counted(count, kind) for kind, count in sorted(kinds.items()))
    return faces or f"{len(part.triangles):,} triangles, no face known"
