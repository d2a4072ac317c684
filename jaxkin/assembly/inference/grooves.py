"""Round parts in grooves that are open by half: axles in the floor of a car, wheels in their arches."""

from __future__ import annotations

from collections.abc import Collection

from jaxkin.assembly.inference.known import Known


def in_grooves(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts of the form of a fastener that are in nothing but grooves of one body, which are open by half.

    No fastener is held there, since it would fall out: what lies in such a groove turns.
    """
    body, result = known.body, set[str]()
    for name in fastening:
        pairs = [pair for pair in known.axes if name in pair.parts and not pair.virtual]
        holes = [pair.other for pair in pairs if pair.one.part == name]
        if not holes or len(holes) < len(pairs) or len({body[hole.part] for hole in holes}) > 1:
            continue
        if all(hole.is_half_open for hole in holes):
            result.add(name)
    return result
