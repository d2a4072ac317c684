"""What a joint is known from: contacts that fit exactly, an inference and its sizes, a file, or the user."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from jaxkin.joints.kinds import JointKind


class EvidenceKind(StrEnum):
    """Where the knowledge of a joint comes from; it prints as, and is equal to, its text."""

    CONTACT = "contact"
    """Faces that touch within the tolerances of the detection, as in the paper."""
    CLEARANCE = "clearance"
    """A pin in a hole that is wider, or narrower, than itself."""
    VIRTUAL_PIN = "virtual pin"
    """Coaxial equal bores of two parts, with no pin drawn in them."""
    BOLT_PATTERN = "bolt pattern"
    """Two or more parallel common axes."""
    FASTENER = "fastener"
    """A screw, nut, washer, rivet or dowel, which belongs to what it holds."""
    BEARING = "bearing"
    """Rings and balls or rollers between two coaxial rings."""
    ENCLOSED = "enclosed"
    """A part that only one other part encloses or touches."""
    SUBASSEMBLY = "subassembly"
    """Parts of one sub-assembly of the file's product structure."""
    NEAREST = "nearest"
    """A part that touches nothing, held to the part nearest to it."""
    EXPORT = "export"
    """A joint, a mate or a rigid group that the CAD system exported."""
    TARGET = "target"
    """What a drive prescribes of a part: the joint holds nothing by itself."""
    USER = "user"
    """Written by hand."""


@dataclass(frozen=True)
class Doubt:
    """Another reading of the solids of a joint, about as likely."""

    kind: JointKind
    """The kind that the joint would be of, about the same axis."""
    why: str

    def __str__(self) -> str:
        return f"may be {self.kind}: {self.why}"


@dataclass(frozen=True)
class Evidence:
    """What a joint is known from."""

    kind: EvidenceKind
    sizes: tuple[tuple[str, float], ...] = ()
    """What was measured, by name, such as ("clearance", 0.05): lengths in the unit of the file, angles in radians."""
    text: str = ""
    """The same in one line, for reports."""
    doubt: Doubt | None = None

    def __str__(self) -> str:
        return f"{self.kind}: {self.text}" if self.text else str(self.kind)


BY_HAND = Evidence(EvidenceKind.USER)
"""Of joints that users write."""


@dataclass(frozen=True)
class Bond:
    """Parts that move as one, and what that is known from."""

    parts: tuple[str, ...]
    evidence: Evidence = BY_HAND
