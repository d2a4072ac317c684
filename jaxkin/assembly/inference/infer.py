"""What a set of solids implies beside its exact contacts, step by step, the surest first."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, common_axes
from jaxkin.assembly.inference.bores import Bore, bores
from jaxkin.assembly.inference.embedded import boxes_meet, embedded
from jaxkin.assembly.inference.fasteners import Stack, bolted, fasteners, patterns, stacks
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.trapped import ACROSS, MAX_PLAY, play, stops
from jaxkin.contacts.contact import Contacts
from jaxkin.geometry.part import Part, size
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.topology.bodies import bodies
from jaxkin.topology.components import connected

NEAR = 0.02
"""Distance to the nearest part, over the size of the assembly, up to which a part that touches nothing goes with it."""

Pair = frozenset[str]


class Inferring:
    """The solids and what is known of them so far: each step adds inferences, and the bodies follow."""

    def __init__(
        self,
        parts: Sequence[Part],
        contacts: Contacts,
        fixed: Sequence[str],
        rigid: Sequence[Sequence[str]],
        joints: Sequence[Joint],
    ):
        self.parts, self.contacts, self.fixed = parts, contacts, tuple(fixed)
        self.solids = {part.name: part for part in parts}
        self.names = tuple(self.solids)
        self.order = {name: place for place, name in enumerate(self.names)}
        self.rigid = [tuple(group) for group in rigid]
        self.by_hand = {frozenset(joint.parts) for joint in joints}
        self.touching = {frozenset(contact.parts) for contact in contacts}
        self.pinned = {frozenset(contact.parts) for contact in contacts if contact.state == "e"}
        self.found: list[Inference] = []
        self.axes = common_axes([bore for part in parts for bore in bores(part)])

    @property
    def body(self) -> Mapping[str, str]:
        """The first part of the body that each part belongs to."""
        groups = [each.parts for each in self.found if each.joint is None]
        return bodies(self.names, self.fixed, [*self.rigid, *groups])

    def add(self, inferences: Sequence[Inference]) -> None:
        """Take inferences of parts that are not one body already, one after another."""
        for each in inferences:
            body = self.body
            if len({body[part] for part in each.parts}) > 1:
                self.found.append(each)


def infer(
    parts: Sequence[Part],
    contacts: Contacts,
    fixed: Sequence[str],
    rigid: Sequence[Sequence[str]] = (),
    joints: Sequence[Joint] = (),
) -> tuple[list[Inference], list[Inference]]:
    """Infer bodies and joints from solids, in the order in which they are the surest.

    Pins in the material of others, bolt patterns, fasteners and the bodies that hold them, pins with clearance or
    interference, bores without a pin, parts that lie on one other only, and parts that touch nothing. Apart from these
    comes what would stop slides that exact contacts allow: for those slides that are of no use.
    """
    known = Inferring(parts, contacts, fixed, rigid, joints)
    fastening = fasteners(parts, [bore for pair in known.axes for bore in (pair.one, pair.other)])
    fastening -= {*fixed, *(part for contact in contacts if contact.state not in "ae" for part in contact.parts)}
    known.add(_embedded(known, fastening))
    known.add(_butting(known, fastening))
    every = [_with_hosts(stack, known) for stack in stacks(known.axes, fastening, known.touching, known.order)]
    while added := _patterns(known, every):
        known.add(added)
    known.add(_attached(known, every))
    hinges = _hinges(known)
    known.found += [joint for joint, exact in hinges if not exact]
    known.add(_lying(known))
    known.add(_alone(known))
    return known.found, [joint for joint, exact in hinges if exact]


def _embedded(known: Inferring, fastening: Collection[str]) -> list[Inference]:
    """Pins that stand in the material of parts that have no hole for them."""
    related = known.touching | {frozenset(pair.parts) for pair in known.axes}
    result = []
    for part in (known.solids[name] for name in known.names if name in fastening):
        others = [each for each in known.parts if each is not part and frozenset((each.name, part.name)) not in related]
        for share, host in embedded(part, others)[:1]:
            text = f"{part.name!r} stands in the material of {host!r}, {share:.0%} of its corners"
            evidence = Evidence(EvidenceKind.ENCLOSED, (("share inside", share),), text)
            result.append(Inference(tuple(sorted((host, part.name), key=known.order.__getitem__)), evidence))
    return result


def _butting(known: Inferring, fastening: Collection[str]) -> list[Inference]:
    """Pins whose ends stand on the faces of a part that has no hole for them: on two opposite ones, or on a coaxial end."""
    axis_of = {bore.part: bore for pair in known.axes for bore in (pair.one, pair.other) if bore.part in fastening}
    directions: dict[tuple[str, str], set[bool]] = {}
    for contact in known.contacts:
        for pin, other in (contact.parts, contact.parts[::-1]):
            surface = contact.surfaces[contact.parts.index(pin)]
            if contact.state != "a" or pin not in axis_of or frozenset(contact.parts) in known.pinned:
                continue
            if isinstance(surface, Plane) and np.linalg.norm(np.cross(surface.normal, axis_of[pin].axis)) < ACROSS:
                directions.setdefault((pin, other), set()).add(bool(surface.normal @ axis_of[pin].axis > 0))
    result = []
    for (pin, other), ways in directions.items():
        coaxial = any(_on(axis_of[pin], bore) for bore in bores(known.solids[other]) if not bore.hole)
        if len(ways) == 2 or coaxial:
            where = "between two faces" if len(ways) == 2 else "on the coaxial end"
            evidence = Evidence(EvidenceKind.ENCLOSED, (), f"{pin!r} stands {where} of {other!r}")
            result.append(Inference(tuple(sorted((pin, other), key=known.order.__getitem__)), evidence))
    return result


def _on(one: Bore, other: Bore) -> bool:
    """Whether two bores have one axis."""
    offset = other.point - one.point
    apart = np.linalg.norm(offset - (offset @ one.axis) * one.axis)
    return bool(np.linalg.norm(np.cross(one.axis, other.axis)) < ACROSS and apart < 0.01 * one.radius)


def _with_hosts(stack: Stack, known: Inferring) -> Stack:
    """The stack with the parts that its fasteners are one body with already: they hold it, too."""
    body = known.body
    hosts = {p for p in known.names for f in stack.fasteners if p not in stack.fasteners and body[p] == body[f]}
    held = sorted({*stack.held, *hosts}, key=known.order.__getitem__)
    return Stack(stack.fasteners, tuple(held), stack.axis, stack.guides)


def _patterns(known: Inferring, every: Sequence[Stack]) -> list[Inference]:
    """Bodies that have two or more parallel axes in common."""
    body = known.body

    def of_bodies(stack: Stack) -> Stack:
        held = tuple(dict.fromkeys(body[part] for part in stack.held))
        return Stack(stack.fasteners, held, stack.axis, stack.guides)

    shared = patterns(known.axes, list(map(of_bodies, every)), known.order)
    return [each for each in bolted(shared, known.order) if len({body[part] for part in each.parts}) > 1]


def _attached(known: Inferring, every: Sequence[Stack]) -> list[Inference]:
    """Fasteners with the body that holds them: the only one, or that which holds them farthest out, as a fork does."""
    body, result = known.body, []
    for stack in every:
        loose = [part for part in stack.fasteners if body[part] not in {body[held] for held in stack.held}]
        holder = _holder(known, stack, body)
        if stack.guides and len({body[part] for part in (*stack.held, *stack.fasteners)}) > 2:
            continue  # a rod that something slides on, not a pin that belongs to what holds it
        parts = (*([holder] if holder and loose else []), *stack.fasteners)
        if len({body[part] for part in parts}) > 1:
            several = len({body[part] for part in stack.held}) > 1
            where = (
                f"held by {holder!r}{' farthest out' if several else ' only'}" if holder and loose else "on one axis"
            )
            text = f"{', '.join(map(repr, stack.fasteners))} {where}"
            result.append(Inference(parts, Evidence(EvidenceKind.FASTENER, (("radius", stack.axis.radius),), text)))
    return result


def _holder(known: Inferring, stack: Stack, body: Mapping[str, str]) -> str | None:
    """The part that holds a stack: of the body whose bores reach farthest along the axis."""
    along, reach = stack.axis.axis, {}
    for pair in known.axes:
        for pin, hole in ((pair.one, pair.other), (pair.other, pair.one)):
            if pin.part in stack.fasteners and hole.part in stack.held:
                reach.setdefault(body[hole.part], []).append((*hole.reach(along), hole.part))
    if not reach:
        return stack.held[0] if stack.held else None
    widest = max(reach.values(), key=lambda ends: max(end[1] for end in ends) - min(end[0] for end in ends))
    return widest[0][2]


def _hinges(known: Inferring) -> list[tuple[Inference, bool]]:
    """Joints of two bodies about their common axis, and whether exact contacts say so but for the slide."""
    body, between = known.body, {}
    by_hand = {frozenset(body[part] for part in pair) for pair in known.by_hand}
    for pair in known.axes:
        owners = frozenset(body[part] for part in pair.parts)
        if len(owners) == 2 and owners not in by_hand:
            between.setdefault(owners, []).append(pair)
    exact: dict[Pair, list[str]] = {}
    for contact in known.contacts:
        exact.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact.state)
    result = []
    for owners, found in between.items():
        states = {*exact.get(owners, ())}
        pair = min(found, key=lambda pair: (pair.virtual, abs(pair.clearance)))
        if "e" not in states or (states == {"e"} and all(_on(pair.other, each.other) for each in found)):
            result += [(joint, "e" in states) for joint in _hinge(known, pair, owners, "e" in states)]
    return result


def _hinge(known: Inferring, pair: CommonAxis, owners: Pair, exact: bool) -> list[Inference]:
    """A revolute joint where faces stop the slide, otherwise a cylindrical one unless contacts say that exactly."""
    body, hole = known.body, pair.other
    members = [[known.solids[name] for name in known.names if body[name] == owner] for owner in owners]
    free = play(stops(members[0], hole), stops(members[1], hole), hole.radius)
    trapped = free is not None and free <= MAX_PLAY * hole.radius
    if exact and not trapped:
        return []
    parts = tuple(sorted(pair.parts, key=known.order.__getitem__))
    make = pairs.revolute if trapped else pairs.cylindrical
    joint = make("-".join(parts), *parts, point=hole.point, axis=hole.axis)
    sizes = [("radius", hole.radius), ("clearance", pair.clearance), ("offset", pair.offset), ("tilt", pair.tilt)]
    ends = f"faces stop its slide, with a play of {free:.2g}" if trapped else "no face stops its slide"
    sizes += [("play", free)] if trapped else []
    if pair.virtual:
        kind, text = EvidenceKind.VIRTUAL_PIN, f"equal bores of radius {hole.radius:.4g} without a pin"
    else:
        how = "clearance" if pair.clearance >= 0 else "interference"
        fit = "fits" if exact else f"has a {how} of {abs(pair.clearance):.2g} and is {pair.offset:.1g} off"
        kind, text = EvidenceKind.CLEARANCE, f"the pin of radius {pair.one.radius:.4g} {fit}"
    return [Inference(parts, Evidence(kind, tuple(sizes), f"{text}; {ends}"), joint)]


def _lying(known: Inferring) -> list[Inference]:
    """Bodies that touch one other body only, and that by one plane."""
    body = known.body
    ties: dict[str, set[str]] = {}
    planes: dict[Pair, list[Vector]] = {}
    jointed = [each.parts for each in known.found if each.joint] + [tuple(pair) for pair in known.by_hand]
    for parts in (*map(tuple, known.touching), *jointed):
        one, other = (body[part] for part in parts)
        ties.setdefault(one, set()).add(other)
        ties.setdefault(other, set()).add(one)
    for contact in known.contacts:
        owners = frozenset(body[part] for part in contact.parts)
        surface = contact.surfaces[0]
        planes.setdefault(owners, []).append(surface.normal if contact.state == "a" else np.zeros(3))
    hinged = {frozenset(body[part] for part in parts) for parts in jointed}
    result = []
    for one, others in ties.items():
        others = others - {one}
        if len(others) != 1 or body[one] == body[known.fixed[0]]:
            continue
        (other,) = others
        normals = planes.get(frozenset((one, other)), [])
        flat = normals and all(np.linalg.norm(np.cross(n, normals[0])) < ACROSS and np.any(n) for n in normals)
        if flat and frozenset((one, other)) not in hinged:
            text = f"{one!r} touches {other!r} only, and that on one plane"
            parts = tuple(sorted((one, other), key=known.order.__getitem__))
            result.append(Inference(parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
    return result


def _alone(known: Inferring) -> list[Inference]:
    """Parts that nothing ties to the fixed ones: with the part that they are most likely rigid with, or at rest."""
    result: list[Inference] = []
    extent = size(tuple(known.parts))
    ties = [
        *map(tuple, known.touching),
        *(each.parts for each in known.found),
        *known.rigid,
        *map(tuple, known.by_hand),
    ]
    groups = connected(known.names, [pair for tie in ties for pair in combinations(tie, 2)])
    held = {name for group in groups if {*known.fixed} & {*group} for name in group}
    islands = [sorted(group, key=known.order.__getitem__) for group in groups if not held & {*group}]
    while islands:
        distance, island, part, host = min(
            (
                (_distance(known.solids[part], known.solids[host]), island, part, host)
                for island in islands
                for part in island
                for host in held
            ),
            key=lambda each: (each[0], known.order[each[2]], known.order[each[3]]),
        )
        islands.remove(island)
        held |= {*island}
        near = distance <= NEAR * extent
        host = host if near else known.fixed[0]
        text = (
            f"{part!r} is tied to nothing, and {distance:.3g} from {host!r}" if near else f"{part!r} is tied to nothing"
        )
        text += "" if near else ": left at rest"
        parts = (host, part)
        result.append(Inference(parts, Evidence(EvidenceKind.NEAREST, (("distance", distance),), text)))
    return result


def _distance(one: Part, other: Part) -> float:
    """Distance between the boxes of two parts."""
    if boxes_meet(one, other):
        return 0.0
    gap = np.maximum(np.maximum(other.box[0] - one.box[1], one.box[0] - other.box[1]), 0.0)
    return float(np.linalg.norm(gap))


def told(inferences: Collection[Inference]) -> list[str]:
    """The inferences in words."""
    return [f"inferred: {each}" for each in inferences]
