"""Contacts between the faces of parts, and the report on what was found, nearly found and refused."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from jaxtyping import Float

from jaxkin._grouped import SCREEN, grouped, kind_of, products, shortened
from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.contacts.states import ContactState, find_state
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Surface


@dataclass(frozen=True, eq=False)
class Contact:
    """Two faces of two parts in one of the sixteen contact states."""

    parts: tuple[str, str]
    """Names of the parts; surface 1 of Table 1, such as the plane of (b) or the cylinder of (h), is on the first."""
    faces: tuple[str, str]
    """Name of the face of each part."""
    state: str
    """Letter of the state, "a" to "p"."""
    region: str
    """"surface", "line", "point" or "circle"."""
    frames: Float[np.ndarray, "frames 4 4"]
    """Local frames as Table 1 prescribes, in world coordinates of the assembled pose."""
    surfaces: tuple[Surface, Surface]
    """The unbounded surfaces of the two faces, in world coordinates of the assembled pose."""
    centre: Vector
    """Centroid of the contact region; where the region surrounds an axis, the point of the axis at its height."""
    misfit: float
    """Length by which the faces miss the ideal contact: noise of the file, or the clearance of a fit."""

    @property
    def contact_state(self) -> ContactState:
        """The row of Tables 1 and 2 that the contact is an instance of."""
        return find_state(self.state, self.region)

    def __str__(self) -> str:
        return (
            f"({self.state}) {self.parts[0]} {self.faces[0]} - {self.parts[1]} {self.faces[1]}: "
            f"{self.contact_state.name}, {self.region}, misfit {self.misfit:.2g}"
        )


@dataclass(frozen=True, eq=False)
class NearMiss:
    """Two faces that miss a contact state by little more than the tolerances; reported, but no contact."""

    parts: tuple[str, str]
    """Names of the parts, in the order of `Contact.parts`."""
    faces: tuple[str, str]
    """Name of the face of each part."""
    state: str
    """Letter of the state that the faces are nearly in, "a" to "p"."""
    region: str
    """"surface", "line", "point" or "circle"."""
    gap: float
    """Length between the surfaces where they should touch: positive apart, negative overlapping."""
    tilt: float
    """Angle between directions that should be parallel, radians."""
    rim: bool
    """True where the faces meet only along an edge of one of them."""
    reason: str
    """Why the faces are not in contact, and what to do about it, in words."""

    def __str__(self) -> str:
        return (
            f"nearly ({self.state}) {self.parts[0]} {self.faces[0]} - {self.parts[1]} {self.faces[1]}: "
            f"{find_state(self.state, self.region).name}: {self.reason}"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Contacts(Result, Sequence[Contact]):
    """The contacts of an assembly, in the order of its parts and their faces; `print` shows them with all reports."""

    contacts: tuple[Contact, ...]
    """The contacts."""
    near_misses: tuple[NearMiss, ...] = ()
    """Pairs of faces that are nearly in contact."""
    notes: tuple[str, ...] = ()
    """Messages on faces that are none of the four surfaces, and on parts that meet at an edge or a corner only."""

    @overload
    def __getitem__(self, index: int) -> Contact: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Contact, ...]: ...
    def __getitem__(self, index: int | slice) -> Contact | tuple[Contact, ...]:
        return self.contacts[index]

    def __len__(self) -> int:
        return len(self.contacts)

    def __iter__(self) -> Iterator[Contact]:
        return iter(self.contacts)

    def __str__(self) -> str:
        return self.describe()

    def describe(self, verbose: bool = False) -> str:
        """Write contacts, near misses and notes as text; many of one kind are summarised, unless `verbose`."""
        lines = [counted(len(self), "contact", "no")]
        lines += [f"  {line}" for line in (self._table() if verbose or len(self) <= SCREEN else self._counts())]
        nearly = [((miss.state, kind_of(miss.reason)), str(miss)) for miss in self.near_misses]
        notes = [(kind_of(note.rpartition(": ")[2]), note) for note in self.notes]
        for noun, entries in (("near miss", nearly), ("note", notes)):
            if entries:
                lines += [counted(len(entries), noun, "no"), *(f"  {line}" for line in grouped(entries, verbose))]
        return "\n".join(lines)

    def _table(self) -> list[str]:
        """Write one line for each contact, below a line of headings."""
        rows = [("parts", "faces", "state", "region", "misfit")] if self.contacts else []
        for contact in self.contacts:
            name = f"({contact.state}) {contact.contact_state.name}"
            between = " - ".join(contact.parts)
            rows.append((between, " - ".join(contact.faces), name, contact.region, f"{contact.misfit:.2g}"))
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]

    def _counts(self) -> list[str]:
        """Write how many contacts there are of each state, and of each pair of products (parts of one design)."""
        states = Counter(f"({each.state}) {each.contact_state.name}" for each in self.contacts)
        product = products(part for each in self for part in each.parts)
        pairs: dict[tuple[str, ...], Counter[str]] = defaultdict(Counter)
        for each in self.contacts:
            pairs[tuple(sorted(map(product.__getitem__, each.parts)))][f"({each.state})"] += 1
        most = sorted(pairs.items(), key=lambda item: item[1].total(), reverse=True)
        rows = [f"{' - '.join(pair)}: {', '.join(_counted(found))}" for pair, found in most]
        return [", ".join(_counted(states)), *shortened(rows)]


def _counted(found: Counter[str]) -> list[str]:
    """Write each name with its number, the most frequent first."""
    return [f"{count} {name}" for name, count in found.most_common()]
