"""One inference: what a user could have written, and what it is known from."""

from __future__ import annotations

from dataclasses import dataclass, replace

from jaxkin._names import listed
from jaxkin.joints.evidence import Evidence
from jaxkin.joints.from_contacts import joint_forwards
from jaxkin.joints.joint import Joint

MIN_TOLD = 1e-6
"""Offset over the radius, up to which it is rounding of the file, and no size."""
INFERRED = "inferred from"
"""How notes on inferences begin."""


@dataclass(frozen=True, eq=False)
class Inference:
    """Parts that move as one, or a joint between two parts."""

    parts: tuple[str, ...]
    evidence: Evidence
    joint: Joint | None = None
    """None where the parts are one body."""

    @classmethod
    def of(cls, joint: Joint, evidence: Evidence) -> Inference:
        """Infer a joint, whose axis points forwards as those of exact contacts do; it carries its evidence, too."""
        return cls(joint.parts, evidence, replace(joint_forwards(joint), evidence=evidence))

    def __str__(self) -> str:
        parts = listed([repr(part) for part in self.parts])
        what = f"{self.joint.kind} joint {self.joint.name!r}" if self.joint else f"{parts} are one body"
        return f"{INFERRED} {self.evidence.kind}: {what}: {self.evidence.text}"


def offset_told(offset: float, radius: float) -> str:
    """Write by how much a pin or a ball of some radius is off, as the end of a text; nothing for what is rounding."""
    return f" and is {offset:.1g} off" if offset > MIN_TOLD * radius else ""
