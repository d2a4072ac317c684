"""An assembly: the parts of a mechanism as solids in their assembled pose, and the way from there to a mechanism."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.part import Part
from jaxkin.joints.from_contacts import FoundJoints, joints_from_contacts
from jaxkin.motion.mechanism import Mechanism
from jaxkin.topology.checks import check_names
from jaxkin.topology.structure import structure

_LISTED = 8
"""Names, or near misses, that a message lists at most."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Solids in their assembled pose, as they were read."""

    parts: tuple[Part, ...]
    unit: str
    """Unit of all lengths, such as "mm"."""
    source: str
    """The file that it was read from."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts."""
        return tuple(part.name for part in self.parts)

    def contacts(self, *, length: float | None = None, angle: float = 1e-4, fit: float = 0.02) -> Contacts:
        """The contacts between the parts, and what is nearly one; found once for each choice of tolerances.

        `length` (in the unit of the assembly; 1e-5 of its diagonal by default), `angle` (radians) and `fit` (clearance
        over radius) say what still counts as touching: see `jaxkin.contacts.detect.find_contacts`.
        """
        tolerances = (length, angle, fit)
        if tolerances not in self._found:
            self._found[tolerances] = find_contacts(self.parts, *tolerances)
        return self._found[tolerances]

    def mechanism(
        self, *, fixed: Sequence[str], combine: bool = True, contacts: Sequence[Contact] | None = None
    ) -> Mechanism:
        """The mechanism that the contacts make, with the parts named in `fixed` at rest.

        `contacts` may be those found with other tolerances, or a selection; by default `self.contacts()`.

        With `combine` the contacts of two parts become the one joint that they amount to, where there is one; without
        it every contact is a joint, as in the paper. Contacts between fixed parts are left out. Raises ValueError where
        no part or an unknown one is fixed, and where a part touches nothing or hangs on nothing.
        """
        check_names(self.names, [], fixed)
        contacts = self.contacts() if contacts is None else contacts
        self._refuse_loose(fixed, contacts)
        moving = [contact for contact in contacts if not set(contact.parts) <= set(fixed)]
        found = joints_from_contacts(moving, self.names, combine=combine)
        described = [(joint.name, *joint.parts) for joint in found.joints]
        return Mechanism(
            found.joints, structure(self.names, described, fixed), self.unit, self.parts, self._notes(found)
        )

    @cached_property
    def _found(self) -> dict[tuple[float | None, float, float], Contacts]:
        return {}

    def _refuse_loose(self, fixed: Sequence[str], contacts: Sequence[Contact]) -> None:
        """Refuse parts that no chain of contacts ties to the fixed ones, with what is nearly a contact there."""
        held, before = set(fixed), 0
        while len(held) > before:
            before = len(held)
            held.update(part for contact in contacts if held & set(contact.parts) for part in contact.parts)
        loose = [name for name in self.names if name not in held]
        if not loose:
            return
        touching = {part for contact in contacts for part in contact.parts}
        alone = [name for name in loose if name not in touching]
        if alone:
            problem = f"{_listed(alone)} touch{'es' if len(alone) == 1 else ''} no other part"
        else:
            problem = f"no chain of contacts ties {_listed(loose)} to the fixed {_listed(fixed)}"
        misses = [miss for miss in self.contacts().near_misses if set(miss.parts) & set(alone or loose)]
        said = [note for note in self.contacts().notes if any(name in note for name in alone or loose)]
        nearly = [f"  {miss}" for miss in [*misses, *said][:_LISTED]] or ["  and nothing there is nearly in contact"]
        raise ValueError(
            "\n".join([f"{self.source}: {problem}; correct the model, or fix or leave out the part:", *nearly])
        )

    def _notes(self, found: FoundJoints) -> tuple[str, ...]:
        noise = (
            f"for the noise of the file, directions were aligned by at most {found.angle:.1g} rad "
            f"and axes by {found.length:.1g} {self.unit}"
        )
        return (*found.notes, *map(str, self.contacts().near_misses), *self.contacts().notes, noise)

    def __str__(self) -> str:
        lines = [f"Assembly of {len(self.parts)} parts from {self.source}, lengths in {self.unit}"]
        width = max(len(name) for name in self.names)
        for part in self.parts:
            kinds = Counter(face.surface.kind for face in part.faces)
            faces = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in sorted(kinds.items()))
            lines.append(f"  {part.name.ljust(width)}  {faces or 'no face that was understood'}")
            lines += [f"  {' ' * width}    {note}" for note in part.notes]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Assembly {self.source!r}: {', '.join(self.names)}; {self.unit}>"


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join(map(repr, names[:_LISTED])) + more
