"""Self-holding tapers: slender cones that stay in their sockets by friction, as the centre of a lathe does."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.geometry.surfaces import Cone
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_HALF_ANGLE = np.deg2rad(2.5)
"""Half the angle of a self-holding taper, at most: Morse tapers have 1.4 to 1.5 degrees, adapter sleeves of 1:12 have
2.4. The plugs of cocks, which turn, have 2.9 (1:10) and more, spindles of milling machines, which a bar draws in, 8."""


def self_holding_tapers(known: Known) -> list[Inference]:
    """Join parts of which one fits into the other with a slender cone: pressed in, it holds by friction."""
    result = []
    for contact in known.contacts:
        cones = [surface for surface in contact.surfaces if isinstance(surface, Cone)]
        if contact.contact_state.is_fit and len(cones) == 2 and cones[0].half_angle <= MAX_HALF_ANGLE:
            angle = cones[0].half_angle
            one, other = contact.parts
            text = f"{one!r} and {other!r} fit with a taper of {np.rad2deg(angle):.2g} degrees beside its axis, which "
            text += "holds by friction"
            evidence = Evidence(EvidenceKind.FASTENER, (("half angle", angle),), text)
            result.append(Inference(contact.parts, evidence))
    return result
