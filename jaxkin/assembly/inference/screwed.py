"""Screws in holes drilled for their threads, and screws that end in nothing that is drawn: they point at the part that
they are screwed into."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.fasteners import Stack, beside
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind

MAX_SHORTFALL = 2.0
"""Distance from the end of a screw to the part that it points at, over its radius: a thread drawn a little short."""
_EDGE = 1e-9
"""Share of a triangle by which a line may miss it at an edge and meets it all the same, and sine of the angle to its
plane below which the line is along it: a line through an edge that two triangles share meets both, and not by chance
neither."""


def screwed_in(known: Known, fastening: Collection[str]) -> list[Inference]:
    """Join screws with the parts in which they are in a hole drilled for their thread, nuts among them."""
    result = []
    for pair in known.axes:
        if pair.threaded and pair.one.part in fastening:
            screw, host = pair.parts
            radii = f"{pair.one.radius:.4g} is screwed into a hole of {pair.other.radius:.4g}"
            result.append(known.fastened(pair, f"{screw!r} of radius {radii} of {host!r}"))
    return result


def screwed_bodies(known: Known, every: Sequence[Stack]) -> list[Inference]:
    """Find bodies with two or more parallel screws, beside each other, that go through nothing else and point at one
    other body. Rings on a pin that are in no hole, as nuts and rollers, point at nothing."""
    body = known.body
    pins = {pair.one.part for pair in known.axes if not pair.virtual}
    rings = {pair.other.part for pair in known.axes if not pair.virtual} - pins
    pointing: dict[frozenset[str], list[tuple[Stack, float]]] = {}
    for stack in every:
        if len(stack.held) != 1 or len(stack.fasteners) != 1 or stack.guides or {*stack.fasteners} & rings:
            continue
        own = {body[part] for part in (*stack.held, *stack.fasteners)}
        found = _pointed_at(known, stack, {part for part in known.names if body[part] in own})
        if len(own) == 1 and found is not None:
            pointing.setdefault(frozenset((*own, body[found[1]])), []).append((stack, found[0]))
    result = []
    for pair, found in pointing.items():
        first = found[0]
        aligned = [first, *(each for each in found[1:] if beside(each[0].axis, first[0].axis))]
        if len(aligned) > 1:
            gap = max(distance for _, distance in aligned)
            one, other = parts = known.in_order(pair)
            text = f"{len(aligned)} parallel screws of {one!r} or {other!r} point at the other one, which has no holes"
            sizes = (("screws", float(len(aligned))), ("gap", gap))
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, sizes, text)))
    return result


def _pointed_at(known: Known, stack: Stack, own: Collection[str]) -> tuple[float, str] | None:
    """Find the first part that the axis of a screw meets beyond its own body, and how far from the end of the screw."""
    reach = stack.axis.half + MAX_SHORTFALL * stack.axis.radius
    ends = stack.axis.point - reach * stack.axis.axis, stack.axis.point + reach * stack.axis.axis
    low, high = np.minimum(*ends), np.maximum(*ends)
    hits = []
    for part in known.parts:
        if part.name in own or np.any(part.box[0] > high) or np.any(part.box[1] < low):
            continue
        distances = np.abs(crossings(stack.axis.point, stack.axis.axis, part.triangles))
        if len(distances) and distances.min() <= reach:
            hits.append((float(max(distances.min() - stack.axis.half, 0.0)), part.name))
    return min(hits, default=None)


def crossings(
    point: Vector, axis: Vector, triangles: Float[np.ndarray, "triangles 3 3"]
) -> Float[np.ndarray, " crossings"]:
    """Find where a line along a unit vector goes through triangles or their edges, as lengths along the line (Moeller
    and Trumbore 1997)."""
    first, second = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(axis, second)
    scale = np.einsum("ij,ij->i", first, normal)
    steep = np.abs(scale) > _EDGE * np.linalg.norm(np.cross(first, second), axis=1)
    scale = np.where(steep, scale, 1.0)
    offset = point - triangles[:, 0]
    u = np.einsum("ij,ij->i", offset, normal) / scale
    turned = np.cross(offset, first)
    v = turned @ axis / scale
    inside = steep & (u >= -_EDGE) & (v >= -_EDGE) & (u + v <= 1 + _EDGE)
    return (np.einsum("ij,ij->i", second, turned) / scale)[inside]
