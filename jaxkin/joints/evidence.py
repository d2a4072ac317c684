"""What a joint is known from: contacts that fit exactly, an inference and its sizes, a file, or the user."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

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
    TIGHT_FIT = "tight fit"
    """A part that fits another one exactly, where others of the drawing have play, and that no face keeps there."""
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


class Seen(NamedTuple):
    """How often a kind of evidence told the joint that was meant."""

    right: int
    """Joints that were as they were taken, or differed by what moves nothing else."""
    of: int

    @property
    def share(self) -> float:
        return self.right / self.of


class Certainty:
    """What was seen of each kind of evidence that is in doubt, in 113 drawings of machines with known joints, each of
    them read by rules that were made before anybody had seen it: benchmarks/drawings/README.md.

    Hinges of pins with play that faces stop were right in 246 of 266 cases, welds in 1740 of 1864.
    """

    UNKEPT_FIT = Seen(14, 14)
    """What fits one pin exactly, with no faces on both sides that keep it there, in a drawing where other joints have
    play, outside of loops: it was one body with the pin."""
    NO_STOP = Seen(9, 47)
    """A pin with play that nothing stops along its axis, taken to slide, where that slide is of use."""
    FIT = Seen(24, 144)
    """What fits exactly in a drawing where other joints have play, outside of loops and bearings: of parts of at most
    3 % of the volume 7 of 87, of larger ones 17 of 57."""
    CENTRED = Seen(4, 12)
    """A pin that nothing stops, taken to turn only: it is in the middle of its holes, or about as long as they are."""
    ONE_FACE = Seen(10, 17)
    """A face stops the slide on one side, a fastener on the other one."""
    SHORT = Seen(7, 11)
    """Faces are far, and the hole is short."""
    NEAR_LIMIT = Seen(9, 12)
    """Faces leave a play that is near to the largest one that counts as none."""
    NAMED_MOTOR = Seen(9, 10)
    """What is on a pin of a part that only its name makes a motor: it turned. These are of five other drawings, which
    had been seen."""


@dataclass(frozen=True)
class Doubt:
    """Another reading of the solids of a joint, about as likely."""

    kind: JointKind
    """The kind that the joint would be of, about the same axis; fixed where its parts would be one body."""
    why: str
    seen: Seen
    """How often joints in this doubt were as they are taken."""

    def __str__(self) -> str:
        other = "one body" if self.kind is JointKind.FIXED else self.kind
        return f"may be {other}: {self.why}"


@dataclass(frozen=True)
class Evidence:
    """What a joint is known from."""

    kind: EvidenceKind
    sizes: tuple[tuple[str, float], ...] = ()
    """What was measured, by name, such as ("clearance", 0.05): lengths in the unit of the file, angles in radians."""
    text: str = ""
    """The same in one line, for reports."""
    doubt: Doubt | None = None

    @property
    def relative_clearance(self) -> float | None:
        """Clearance of the pin of a joint, over the radius of its hole; None where the evidence is no such pin.

        Slides between walls have a play, and what a pin across holds a clearance, and no radius to compare either with.
        """
        sizes = dict(self.sizes)
        if self.kind is not EvidenceKind.CLEARANCE or not sizes.keys() >= {"clearance", "radius"}:
            return None
        return sizes["clearance"] / sizes["radius"]

    def __str__(self) -> str:
        return f"{self.kind}: {self.text}" if self.text else str(self.kind)


BY_HAND = Evidence(EvidenceKind.USER)
"""Of joints that users write."""


@dataclass(frozen=True)
class Bond:
    """Parts that move as one, and what that is known from."""

    parts: tuple[str, ...]
    evidence: Evidence = BY_HAND
