"""Parts that only spin stay at rest on one neighbour: their other contacts constrain nothing and are left out."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from jaxkin._names import listed
from jaxkin.assembly.needless import SpinningParts, found_spinning
from jaxkin.assembly.spinning import Spin
from jaxkin.contacts.contact import Contact
from jaxkin.joints.evidence import BY_HAND
from jaxkin.joints.joint import Joint, joint
from jaxkin.linkage.linkage import Linkage
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def left_at_rest(mechanism: Mechanism) -> Mechanism:
    """Join each part that only spins to its carrier alone, by the lower pair of its own freedoms (`Spin`).

    Its other contacts constrain no other part: they only close loops in which the part idles. Of parts of which some
    are needed to hold others (`needless`), those are kept with all contacts, and a note says so. Parts with a joint by
    hand are kept too.
    """
    by_hand = [part for each in mechanism.all_joints if each.name not in mechanism.contacts for part in each.parts]
    found = found_spinning(mechanism, kept=by_hand)
    resting = {part: spin for part, spin in found.spins.items() if len(_neighbours(mechanism, part)) > 1}
    joints: list[Joint] = []
    contacts: dict[str, tuple[Contact, ...]] = {}
    named: dict[frozenset[str], str] = {}
    dropped: list[Contact] = []
    for each in mechanism.all_joints:
        if not resting.keys() & set(each.parts):
            joints.append(each)
            contacts |= {each.name: mechanism.contacts[each.name]} if each.name in mechanism.contacts else {}
        elif (spin := _carried_by(resting, each)) is not None:
            name = named.setdefault(frozenset(each.parts), "-".join(each.parts))
            if name not in contacts:
                joints.append(
                    joint(
                        name, each.parts, spin.kind, (spin.movement,), [spin.frame], evidence=each.evidence or BY_HAND
                    )
                )
            contacts[name] = (*contacts.get(name, ()), *mechanism.contacts[each.name])
        else:
            dropped += mechanism.contacts[each.name]
    history = (*mechanism.history, *_notes(mechanism, resting, found))
    if not resting:
        return replace(mechanism, history=history)
    described = [(each.name, *each.parts) for each in joints]
    linkage = Linkage.of(joints, structure(mechanism.parts, described, mechanism.fixed))
    return replace(mechanism, linkage=linkage, history=history, contacts=contacts, contacts_at_rest=tuple(dropped))


def _carried_by(resting: dict[str, Spin], between: Joint) -> Spin | None:
    """Find the spin of a part whose carrier is the other part of the joint; None if there is none."""
    for part, other in (between.parts, between.parts[::-1]):
        if part in resting and resting[part].carrier == other:
            return resting[part]
    return None


def _neighbours(mechanism: Mechanism, part: str) -> list[str]:
    """List the parts that share a joint with a part."""
    return list(
        dict.fromkeys(p for each in mechanism.all_joints if part in each.parts for p in each.parts if p != part)
    )


def _notes(mechanism: Mechanism, resting: dict[str, Spin], found: SpinningParts) -> list[str]:
    """Say which parts are left at rest, and which are kept since others need them."""
    notes = []
    for part, spin in resting.items():
        others = [repr(other) for other in _neighbours(mechanism, part) if other != spin.carrier]
        notes.append(
            f"part {part!r} only spins: it is left at rest on {spin.carrier!r}, its contacts with "
            f"{', '.join(others)} are not needed; connect it for good with rigid=[[{spin.carrier!r}, {part!r}]]"
        )
    if needed := [repr(part) for group in found.needed for part in group]:
        one = len(needed) == 1
        notes.append(
            f"{listed(needed)} only {'spins' if one else 'spin'} too, but {'holds' if one else 'hold'} other parts "
            "together where more parts that spin are left at rest: kept with all contacts"
        )
    return notes
