"""The bodies of a mechanism as a study says them: the parts to fix, and groups of parts that move as one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from jaxkin.joints.evidence import Evidence
from jaxkin.joints.kinds import JointKind

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


@dataclass(frozen=True)
class BodyChoices:
    """What makes the bodies of a mechanism."""

    fixed: tuple[str, ...]
    """Those of the fixed parts that no group holds to others of them."""
    groups: tuple[tuple[tuple[str, ...], Evidence | None], ...]
    """Parts that move as one, and what that is known from; none that follows from those before it."""

    @staticmethod
    def of(mechanism: Mechanism) -> BodyChoices:
        """Find the bonds and the joints without freedoms that make the bodies; without solids only what is fixed."""
        if not mechanism.solids:
            return BodyChoices(mechanism.fixed, ())
        welds = [joint for joint in mechanism.all_joints if joint.kind is JointKind.FIXED]
        known = [(bond.parts, bond.evidence) for bond in mechanism.bonds]
        known += [(joint.parts, joint.evidence) for joint in welds]
        order = {part: number for number, part in enumerate(mechanism.parts)}
        owner, groups = {part: part for part in mechanism.parts}, []
        for parts, evidence in known:
            owners = {owner[part] for part in parts}
            if len(owners) > 1:
                first = min(owners, key=order.__getitem__)
                owner = {part: first if one in owners else one for part, one in owner.items()}
                groups.append((parts, evidence))
        fixed = {owner[part]: part for part in reversed(mechanism.fixed)}
        needed = tuple(part for part in mechanism.fixed if part in fixed.values())
        return BodyChoices(needed, tuple(groups))
