"""What fits one other body exactly, and that no loop needs: such joints are in doubt.

Designers draw an exact fit where a part is pressed, glued or screwed on, and play where it moves. Where no joint of a
drawing has play, an exact fit tells nothing.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin.assembly.guides import is_guide
from jaxkin.geometry.part import size
from jaxkin.joints.evidence import Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.mobility import outside_loops

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MAX_FIT = 1e-4
"""Clearance of what fits, over the radius of its hole, or over the size of the smaller part for faces, at most."""
_KINDS = (JointKind.REVOLUTE, JointKind.CYLINDRICAL, JointKind.PRISMATIC, JointKind.PLANAR)
"""Kinds of joints that may be none; a ball that fits its socket is one all the same."""
_MAY_BE_ONE_BODY = Doubt(JointKind.FIXED, "it fits exactly where others have play, and no loop needs it", Certainty.FIT)


def with_doubts(mechanism: Mechanism, bearings: Collection[str]) -> Mechanism:
    """Say of joints that fit exactly outside of loops, in a drawing where others have play, that they may be none."""
    if not any_has_play(mechanism):
        return mechanism
    outside = {*outside_loops(mechanism.linkage)}
    joints = tuple(
        replace(joint, evidence=replace(joint.evidence, doubt=_MAY_BE_ONE_BODY))
        if joint.evidence and {*joint.full_names} <= outside and _may_be_none(mechanism, joint, bearings)
        else joint
        for joint in mechanism.all_joints
    )
    if joints == mechanism.all_joints:
        return mechanism
    return replace(mechanism, linkage=replace(mechanism.linkage, joints=joints))


def any_has_play(mechanism: Mechanism) -> bool:
    """Tell whether some joint of a drawing has play: its author draws play where parts move."""
    return any(has_play(joint.evidence) for joint in mechanism.all_joints)


def _may_be_none(mechanism: Mechanism, joint: Joint, bearings: Collection[str]) -> bool:
    """Tell whether a joint is one of contacts without play, or of a pin without play, and no bearing or guide."""
    evidence = joint.evidence
    if evidence is None or joint.kind not in _KINDS or {*joint.parts} & {*bearings} or is_guide(mechanism, joint):
        return False
    if evidence.kind is EvidenceKind.CONTACT:
        solids = {part.name: part for part in mechanism.solids}
        contacts = mechanism.contacts.get(joint.name, ())
        fits = (each.misfit <= MAX_FIT * min(size((solids[part],)) for part in each.parts) for each in contacts)
        return bool(contacts) and all(fits)
    return fits_its_hole(evidence)


def has_play(evidence: Evidence | None) -> bool:
    """Tell whether the evidence of a joint is a pin in a wider hole."""
    clearance = None if evidence is None else evidence.relative_clearance
    return clearance is not None and clearance > MAX_FIT


def fits_its_hole(evidence: Evidence) -> bool:
    """Tell whether the evidence of a joint is a pin in a hole that is no wider."""
    clearance = evidence.relative_clearance
    return clearance is not None and clearance <= MAX_FIT
