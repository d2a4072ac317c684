"""Tabs of plates in slots of others, up to a shoulder: too short to guide, they hold the plates to each other."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.slides import slide_between
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.walls import facing, walls
from jaxkin.joints.evidence import Evidence, EvidenceKind

SHORTEST_GUIDE = 0.25
"""Length of a guide over its width, at least: a shorter one jams. A force on its edge is balanced by a couple on its
ends, and their friction holds it where the length is below the width times the coefficient of friction, some 0.25."""
MAX_PLATE, MIN_BEYOND = 1.5, 2.0
"""Thickness of the plate, at most, and length of the part with the tab, at least, over the depth of the tab: what lies
in the other part with its whole length is a block or a pad, which is pushed in the middle and may slide."""
MAX_LIFT = 0.1
"""Distance of the shoulder from the plate, over the depth of the tab, at most."""


def tabs_in_slots(known: Known) -> list[Inference]:
    """Join parts with a tab that is in a slot of another part, with play on all sides, as deep as a shoulder lets it.

    Walls all round the tab leave a slide only. A guide that is much shorter than wide would jam, so that nobody makes
    one; plates that are cut by a laser are put together so, and glued.
    """
    body, result = known.body, []
    for part in known.parts:
        for other in known.measured.beside(part):
            pair = frozenset((part.name, other.name))
            if body[part.name] == body[other.name] or pair in known.touching:
                continue
            found = slide_between(part, [other])
            if found is None:
                continue
            axis, play = found
            spans = [np.sort(each.outermost @ axis)[[0, -1]] for each in (part, other)]
            deep = float(min(span[1] for span in spans) - max(span[0] for span in spans))
            thin, long = sorted(float(np.ptp(span)) for span in spans)
            if not (thin <= MAX_PLATE * deep and long > MIN_BEYOND * deep):
                continue
            looking = facing(part, [other])
            width = max((width for *_, width in walls(looking)), default=0.0)
            along = np.sqrt(1 - ACROSS**2)
            shoulder = any(abs(normal @ axis) > along and gap <= MAX_LIFT * deep for normal, gap, _ in looking)
            if shoulder and deep < SHORTEST_GUIDE * width:
                text = (
                    f"a tab of {part.name!r} is {deep:.3g} deep in a slot of {other.name!r}, up to its shoulder, and "
                )
                text += f"{width:.3g} wide: too short to guide"
                sizes = (("play", play), ("depth", deep), ("width", width))
                parts = known.in_order(pair)
                result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result
