"""Contacts that joints by hand keep: where joints were written down, solids still say which faces hold them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.contacts.detect import find_contacts
from jaxkin.contacts.tolerance import ContactTolerance
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.part import size
from jaxkin.joints.joint import Joint
from jaxkin.joints.regularise import movements
from jaxkin.joints.screws import displacements, inverses, misfit
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_TRIED = 2
"""Displacements of a joint that a contact has to allow: one might be special by chance, such as one half a turn on."""
_FAR = 0.5
"""Radians, and lengths over the size of the assembly, by which a joint is displaced at most: `misfit` converges."""
_ALLOWED = 4 * ContactTolerance.angle
"""What a displacement may miss, radians and lengths over the size of the assembly: entries of matrices are sums of a
few numbers, each within the tolerance of the detection."""


def kept_contacts(mechanism: Mechanism) -> dict[str, tuple[Contact, ...]]:
    """Find, for each joint with freedoms, the exact contacts of its two bodies that it keeps, by its name.

    A joint keeps a contact where the surfaces, without their ends, stay in the state in which they are, wherever the
    joint goes. Joints without such contacts are left out. Contacts are looked for anew in the solids, which takes
    seconds where there are many.
    """
    contacts = find_contacts(mechanism.solids)
    body = body_of_parts(mechanism.bodies)
    between: dict[frozenset[str], list[Contact]] = {}
    for contact in contacts:
        between.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact)
    length, kept = size(mechanism.solids), {}
    for joint in (each for each in mechanism.all_joints if each.freedoms and not each.curves):
        some = between.get(frozenset(body[part] for part in joint.parts), ())
        first = body[joint.parts[0]]
        found = tuple(each for each in some if _is_kept(joint, each, body[each.parts[0]] == first, length))
        kept |= {joint.name: found} if found else {}
    return kept


def _is_kept(joint: Joint, contact: Contact, forwards: bool, length: float) -> bool:
    """Tell whether a contact allows the displacements of a joint, whose bodies it names in the same order if it is
    `forwards`; `length` is the size of the assembly."""
    spans = np.array([length if is_length(name) else 1.0 for name in joint.coordinates])
    centre = np.asarray(contact.frames, float)[0, :3, 3]
    frames = np.array(contact.frames, float)
    frames[:, :3, 3] = (frames[:, :3, 3] - centre) / length
    tried = displacements(joint, np.random.default_rng(0).uniform(-_FAR, _FAR, (_TRIED, joint.freedoms)) * spans)
    tried = tried if forwards else inverses(tried)
    for moved in np.moveaxis(tried, -1, 0):
        about = np.eye(4)  # lengths from `centre` over `length`, so that one tolerance serves angles and lengths
        about[:3, :3] = moved[:, :3]
        about[:3, 3] = (moved[:, :3] @ centre + moved[:, 3] - centre) / length
        if misfit(movements(contact), frames, about) > _ALLOWED:
            return False
    return True
