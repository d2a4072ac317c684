"""Covers: rings with play on a shaft that lie on what the shaft is in, and that nothing else holds."""

from __future__ import annotations

from collections.abc import Mapping

from jaxkin.assembly.inference.fasteners import Stack
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT


def covered_by(known: Known, stack: Stack, body: Mapping[str, str]) -> str | None:
    """Find the part that a ring covers; None where it is no cover.

    All that goes through the ring has play, is also in a hole of the body that the ring lies on, and has no face on the
    ring; nothing lies on its other side. The shaft slips through, and what lies on its bearing is fastened there.
    """
    ring = stack.fasteners[0]
    pairs = [pair for pair in known.axes if ring in pair.parts]
    if len(stack.fasteners) > 1 or not pairs:
        return None
    loose = (pair.other.part == ring and pair.clearance > SAME_FIT * pair.other.radius for pair in pairs)
    if not all(loose) or any(pair.virtual for pair in pairs):
        return None
    flat, pins = known.parts_flat_on(ring, stack.axis.axis), {pair.one.part for pair in pairs}
    touching = {part for pair in known.touching if ring in pair for part in pair} - {ring}
    hosts, shafts = {body[part] for part in flat}, {body[part] for part in pins}
    if touching - pins != {*flat} or len(hosts) != 1 or hosts & shafts:
        return None
    borne = {body[each.one.part] for each in known.axes if not each.virtual and body[each.other.part] in hosts}
    return flat[0] if shafts <= borne else None
