"""Guide rods that are not drawn: bushes of one body in line with holes of another one, on axes beside each other."""

from __future__ import annotations

from jaxkin.assembly.inference.axes import CommonAxis
from jaxkin.assembly.inference.fasteners import beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind


def on_undrawn_rods(known: Known) -> list[Inference]:
    """Infer that bodies slide on rods that are not drawn: two or more parallel axes of empty bushes of one, such as
    linear bearings, are those of holes of the other one, and the two touch nowhere.

    A bush is there for what moves in it. Screws would draw the bodies together, as those in threaded inserts do.
    """
    body, common = known.body, dict[BodyPair, list[CommonAxis]]()
    touching = {frozenset(body[part] for part in pair) for pair in known.touching}
    for pair in known.axes:
        owners = frozenset(body[part] for part in pair.parts)
        if pair.virtual and len(owners) == 2 and owners not in touching and known.sleeves & {*pair.parts}:
            common.setdefault(owners, []).append(pair)
    result = []
    for found in common.values():
        first = found[0]
        apart = [each for each in found if beside(each.one, first.one)]
        if not apart:
            continue
        parts = known.in_order(first.parts)
        joint = pairs.prismatic("-".join(parts), *parts, point=first.other.point, axis=first.one.axis)
        bushes = ", ".join(repr(part) for part in known.in_order({*known.sleeves} & {*first.parts, *apart[0].parts}))
        text = f"empty bushes {bushes} are in line with holes on parallel axes, as on rods that are not drawn"
        sizes = (("radius", first.other.radius), ("clearance", first.clearance))
        result.append(Inference.of(joint, Evidence(EvidenceKind.VIRTUAL_PIN, sizes, text)))
    return result
