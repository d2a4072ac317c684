"""Bodies that only lie on another one, as a bearing block does on its base, and need not move there."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.walls import slot_normals
from jaxkin.assembly.seats import locks_slide
from jaxkin.contacts.contact import Contact
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.mobility import moving_coordinates
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def resting(mechanism: Mechanism) -> list[Inference]:
    """Find the bodies that faces hold to another one across one direction: they lie there, and nothing that is drawn
    keeps them in their place; but for those in a slot, and those that slide in a third one on which the other turns."""
    found = []
    owner = body_of_parts(mechanism.bodies)
    for joint in mechanism.all_joints:
        contacts = mechanism.contacts.get(joint.name, ())
        lies = joint.kind is JointKind.PLANAR and contacts and not _slides_in_a_slot(contacts)
        if lies and not locks_slide(mechanism, joint, owner):
            one, other = map(repr, joint.parts)
            text = f"{one} lies on {other}, with no screw drawn, and nothing else needs it to move there"
            found.append(Inference(joint.parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
    return found


def _slides_in_a_slot(contacts: Sequence[Contact]) -> bool:
    """Tell whether some part is between the walls of another one: where walls of two parts clamp it, as a bolt and what
    it is in do, it stays all the same."""
    pairs: dict[frozenset[str], list[Contact]] = {}
    for each in contacts:
        pairs.setdefault(frozenset(each.parts), []).append(each)
    return any(len(slot_normals(some, part)) for pair, some in pairs.items() for part in pair)


def leaves_all_moving(
    mechanism: Mechanism, other: Mechanism, held: Collection[Inference], *, but_slides: bool = False
) -> bool:
    """Tell whether all bodies that move on each other by a joint still do so in another mechanism, in the same
    coordinates, but for those that are held to each other there; with `but_slides` also but for slides of bodies that
    still turn on each other. Those that are one body then had nothing but empty bores in common."""
    owner = body_of_parts(other.bodies)
    gone = {frozenset(each.parts) for each in held}

    def seen(found: Mechanism, wanted: Callable[[Joint], bool]) -> set[tuple[frozenset[str], str]]:
        """Find which bodies of the other mechanism move on each other, by which coordinates."""
        moving, joints = moving_coordinates(found.linkage), filter(wanted, found.all_joints)
        return {
            (frozenset(owner[part] for part in joint.parts), name)
            for joint in joints
            for name in joint.coordinates
            if f"{joint.name}.{name}" in moving
        }

    def stays(joint: Joint) -> bool:
        empty = joint.evidence is not None and joint.evidence.kind is EvidenceKind.VIRTUAL_PIN
        return not empty and frozenset(joint.parts) not in gone

    left = seen(other, lambda _: True)
    gone_by = seen(mechanism, stays) - left
    return not gone_by or (but_slides and all(name == "z" and (pair, "phi") in left for pair, name in gone_by))
