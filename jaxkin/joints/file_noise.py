"""The noise of the file that faces come from, which their contacts share."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.fit_uncertainty import doubt
from jaxkin.geometry.part import Part
from jaxkin.joints.regularise import Noise


def noise_of(parts: Sequence[Part], contacts: Sequence[Contact]) -> Noise:
    """The noise of single precision; more where surfaces were fitted to few corners that are near to each other."""
    faces = {(part.name, face.name): (face, part.grain) for part in parts if part.grain for face in part.faces}
    touching = dict.fromkeys(key for contact in contacts for key in zip(contact.parts, contact.faces, strict=True))
    doubts = [doubt(*faces[key]) for key in touching if key in faces]
    return Noise.of(contacts).with_doubt(*np.max(doubts, axis=0, initial=0.0)) if doubts else Noise.of(contacts)
