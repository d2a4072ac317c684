"""The solids of an assembly and what is known of them so far."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, plugged_holes
from jaxkin.assembly.inference.bores import NEAR_LENGTH, Bore, near_axis
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.measured import Measured
from jaxkin.assembly.inference.slotted_pins import is_slot_end
from jaxkin.assembly.inference.sockets import sockets
from jaxkin.assembly.inference.stop_faces import stands_across
from jaxkin.contacts.contact import Contact, Contacts
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.topology.bodies import bodies

BodyPair = frozenset[str]
"""Two bodies, each by its first part, or two parts, in no order."""


class Known:
    """What is known of the solids of an assembly.

    Only three things change after it is made. `take` adds inferences to `found`, from which `body` and `jointed`
    follow, and ignored pairs to `taken_back`. `infer` sets, before the rules that read them: `axes`, less those that
    only bearings have, `rings`, `driven`, `in_ring_grooves`, `closed`, `sleeves` and `blocks`. Sets are never gone
    through in their own order: it depends on the seed of hashes.
    """

    def __init__(
        self,
        measured: Measured,
        contacts: Contacts,
        fixed: Sequence[str],
        rigid: Sequence[Sequence[str]],
        joints: Sequence[Joint],
        ignored: Collection[BodyPair] = (),
        clearance: float | None = None,
        apart: Collection[BodyPair] = (),
        springs: Collection[str] = (),
    ):
        """Take the solids, their contacts, and what the user says of them.

        Between the parts of pairs that are `ignored` nothing is inferred; `clearance` is that of `common_axes`. The
        parts of pairs that are `apart` are not inferred to be one body. What is pushed by `springs` is not stopped by
        them.
        """
        self.measured, self.parts, self.contacts, self.fixed = measured, measured.parts, contacts, tuple(fixed)
        self.solids = {part.name: part for part in self.parts}
        self.names = tuple(self.solids)
        self.order = {name: place for place, name in enumerate(self.names)}
        self.group = _subassemblies(self.parts)
        """The sub-assembly that each part is in, by its path; () for those of the whole assembly."""
        self.rigid = [tuple(group) for group in rigid]
        self.by_hand = dict.fromkeys(frozenset(joint.parts) for joint in joints).keys()
        self.between: dict[BodyPair, list[Contact]] = {}
        """The exact contacts of each pair of parts."""
        for contact in contacts:
            self.between.setdefault(frozenset(contact.parts), []).append(contact)
        self.touching = self.between.keys()
        self.pinned = {frozenset(contact.parts) for contact in contacts if contact.contact_state.is_pin}
        self.found: list[Inference] = []
        self.body: Mapping[str, str] = bodies(self.names, self.fixed, self.rigid)
        """The first part of the body that each part belongs to."""
        self.jointed = self._jointed()
        """The pairs of bodies that joints by hand or inferred joints join."""
        self.sleeves: set[str] = set()
        """Bushes that are in another part, which they leave only by sliding."""
        self.springs = {*springs}
        """Springs, which stop nothing."""
        self.blocks: set[str] = set()
        """Blocks on a pin between walls, which have the form of a nut."""
        self.rings: set[BodyPair] = set()
        """The outer and the inner ring of each bearing, which are never one body; of a bearing that is one ring, that
        and what is in its hole."""
        self.driven: set[BodyPair] = set()
        """Motors that are one solid with their shaft, each with a hub on that."""
        self.in_ring_grooves: Mapping[tuple[str, str], float] = {}
        """Each screw that stands in a groove round a shaft, and that shaft, with the play between them."""
        self.closed: set[str] = set()
        """Bearings that are one ring each."""
        self.bores, found = measured.bores, measured.axes(clearance)
        self.ignored, self.clearance, self.apart = ignored, clearance, apart
        self.taken_back = {frozenset(pair.parts) for pair in found if frozenset(pair.parts) in ignored}
        """Those of the ignored pairs between which something would have been inferred."""
        found = [pair for pair in found if frozenset(pair.parts) not in ignored]
        self.sockets = [each for each in sockets(self.parts, clearance) if frozenset(each.parts) not in ignored]
        self.axes = [pair for pair in found if not pair.tapped and not self._is_neck(pair)]
        self.tapped = [pair for pair in found if pair.tapped]

    @cached_property
    def plugged(self) -> set[int]:
        """Numbers (`id`) of the holes that are plugged: see `plugged_holes`."""
        return plugged_holes(self.axes)

    @cached_property
    def slot_ends(self) -> set[int]:
        """Numbers (`id`) of the common axes of pins that are drawn at the end of their slot: they turn and slide
        there."""
        slotted = self.measured.slotted_pins(self.clearance)
        ends = [pair for pair in self.axes if not pair.virtual]
        return {id(pair) for pair in ends if is_slot_end(pair, slotted, self.bores[pair.other.part])}

    def bores_on(self, part: str, axis: Bore) -> list[Bore]:
        """Find the bores and pins of a part that are on the axis of another one, to `NEAR_ANGLE` and `NEAR_LENGTH`."""
        own = self.bores[part]
        return [own[k] for k in near_axis(self.measured.middles(part), axis) if own[k].on_axis_of(axis)]

    def in_order(self, names: Iterable[str]) -> tuple[str, ...]:
        """Sort names of parts as the assembly has them."""
        return tuple(sorted(names, key=self.order.__getitem__))

    def around(self, part: Part, body: Mapping[str, str]) -> dict[str, list[Part]]:
        """Find the parts of other bodies beside a part, by their bodies; `body` is that of now, found once for many."""
        found: dict[str, list[Part]] = {}
        for other in self.measured.beside(part):
            if body[other.name] != body[part.name]:
                found.setdefault(body[other.name], []).append(other)
        return found

    def touches_across(self, part: str, axis: Vector, *others: str) -> bool:
        """Tell whether a part has a plane face across an axis in contact with one of others."""
        contacts = (each for other in others for each in self.between.get(frozenset((part, other)), ()))
        return any(each.contact_state.is_flat and stands_across(each.surfaces[0], axis) for each in contacts)

    def touches_only_across(self, one: str, other: str, axis: Vector, pins: bool = True) -> bool:
        """Tell whether all that two parts have in contact are plane faces across an axis, `pins` in holes included."""
        some = self.between.get(frozenset((one, other)), ())
        across = [stands_across(each.surfaces[0], axis) for each in some if pins or not each.contact_state.is_pin]
        return bool(across) and all(across)

    def parts_flat_on(self, part: str, axis: Vector) -> list[str]:
        """Find the parts that lie flat on a part, across an axis."""
        some = [each for each in self._flat.get(part, ()) if stands_across(each.surfaces[0], axis)]
        return list(dict.fromkeys(each.parts[part == each.parts[0]] for each in some))

    @cached_property
    def _flat(self) -> dict[str, list[Contact]]:
        """The contacts of plane faces on plane faces, by their parts."""
        found: dict[str, list[Contact]] = {}
        for contact in self.contacts:
            if contact.contact_state.is_flat:
                for part in contact.parts:
                    found.setdefault(part, []).append(contact)
        return found

    @property
    def far(self) -> list[CommonAxis]:
        """Axes that are taken only for parts that nothing else ties; none where a largest clearance is asked for."""
        if self.clearance is not None:
            return []
        return [pair for pair in self.measured.far_axes if frozenset(pair.parts) not in self.ignored]

    def fastened(self, pin: CommonAxis, text: str, *parts: str) -> Inference:
        """Infer that the parts of a pin and its hole are one body, or other `parts` that the pin fastens."""
        sizes = (("radius", pin.one.radius), ("clearance", pin.clearance))
        return Inference(self.in_order(parts or pin.parts), Evidence(EvidenceKind.FASTENER, sizes, text))

    def take(self, inferences: Sequence[Inference]) -> bool:
        """Take the inferences of a rule, bodies first; tell whether any was taken.

        Parts that are one body are not joined again. Parts that joints by hand or inferred joints join are left apart,
        and so are the rings of a bearing, and the pairs of `apart`. Of joints those within a body are left out, and
        those between bodies that something joined before: one rule may find several axes of two bodies, as bearings do.
        What is ignored is left out first.
        """
        inferences = [less for each in inferences if (less := self._heeding(each))]
        before = len(self.found)
        jointed = (frozenset(each.parts) for each in self.found if each.joint)
        jointed = [*self.by_hand, *self.rings, *self.apart, *jointed]
        for each in (each for each in inferences if each.joint is None):
            owners = {self.body[part] for part in each.parts}
            apart = ({self.body[part] for part in pair} for pair in jointed)
            if len(owners) > 1 and not any(len(pair) > 1 and pair <= owners for pair in apart):
                self.found.append(each)
                first = min(owners, key=self.order.__getitem__)
                self.body = {part: first if owner in owners else owner for part, owner in self.body.items()}
        joined = self._jointed()
        for each in (each for each in inferences if each.joint is not None):
            owners = frozenset(self.body[part] for part in each.parts)
            if len(owners) > 1 and owners not in joined:
                self.found.append(each)
        self.jointed = self._jointed()
        return len(self.found) > before

    def _heeding(self, inference: Inference) -> Inference | None:
        """Leave out of an inference those parts that are to be ignored beside an earlier one, often their host; None
        where it is about nothing then.

        Pairs with a contact left are ignored by some of their faces only, and springs by what they do not push. Parts
        that nothing ties are not tied to an ignored one in the first place, or are left at rest.
        """
        if inference.evidence.kind is EvidenceKind.NEAREST:
            return inference
        kept: list[str] = []
        for part in inference.parts:
            pairs = {frozenset((part, other)) for other in kept} & {*self.ignored} - self.touching
            pairs = {pair for pair in pairs if not pair & self.springs}
            self.taken_back |= pairs
            kept += [] if pairs else [part]
        if len(kept) == len(inference.parts):
            return inference
        return None if inference.joint or len(kept) < 2 else replace(inference, parts=tuple(kept))

    def _jointed(self) -> frozenset[BodyPair]:
        pairs = (*self.by_hand, *(each.parts for each in self.found if each.joint))
        return frozenset(frozenset(self.body[part] for part in pair) for pair in pairs)

    def _is_neck(self, pair: CommonAxis) -> bool:
        """Tell whether a pin in a hole is the neck of a ball in the opening of its socket: the ball guides it."""
        for each in self.sockets:
            apart = np.linalg.norm(np.cross(each.ball.centre - pair.one.point, pair.one.axis))
            if {*pair.parts} == {*each.parts} and apart <= pair.offset + NEAR_LENGTH * pair.other.radius:
                return True
        return False


def _subassemblies(parts: Sequence[Part]) -> dict[str, tuple[str, ...]]:
    """Map each part to the path of its innermost sub-assembly; to () where that holds every part."""
    paths = [part.path for part in parts]
    same = next((k for k, level in enumerate(zip(*paths, strict=False)) if len(set(level)) > 1), min(map(len, paths)))
    return {part.name: part.path if len(part.path) > same else () for part in parts}
