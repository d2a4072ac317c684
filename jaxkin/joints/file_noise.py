"""The noise that all contacts of an assembly share, since its faces come from one file."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.fit_uncertainty import fit_uncertainty
from jaxkin.geometry.part import Part
from jaxkin.joints.regularise import Noise


def noise_of(parts: Sequence[Part], contacts: Sequence[Contact]) -> Noise:
    """Estimate the noise of contacts: that of single precision, more where surfaces were fitted to few near vertices.

    See `fit_uncertainty`: parts whose file holds the surfaces themselves have a `surface_resolution`.
    """
    faces = {
        (part.name, face.name): (face, part.vertex_resolution)
        for part in parts
        if part.vertex_resolution and part.surface_resolution is None
        for face in part.faces
    }
    touching = dict.fromkeys(key for contact in contacts for key in zip(contact.parts, contact.faces, strict=True))
    uncertainties = [fit_uncertainty(*faces[key]) for key in touching if key in faces]
    return (
        Noise.of(contacts).with_uncertainty(*np.max(uncertainties, axis=0, initial=0.0))
        if uncertainties
        else Noise.of(contacts)
    )
