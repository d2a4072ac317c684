"""What two bodies have about a common axis: pins in holes, equal bores, and all exact contacts between the bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import CommonAxis, engaged
from jaxkin.assembly.inference.bores import NEAR_ANGLE, NEAR_LENGTH, Bore
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.stop_faces import ACROSS, stands_across
from jaxkin.contacts.contact import Contact
from jaxkin.geometry.surfaces import Cylinder, Plane


class CoaxialFeatures(NamedTuple):
    """What two bodies have about a common axis."""

    owners: BodyPair
    found: list[CommonAxis]
    touching: list[Contact]
    """Their exact contacts."""

    @property
    def pins(self) -> list[bool]:
        """Whether each contact is one of a pin in a hole."""
        return [contact.contact_state.is_pin for contact in self.touching]

    @property
    def first(self) -> CommonAxis:
        """That with a pin, the tightest first."""
        return min(self.found, key=lambda pair: (pair.virtual, abs(pair.clearance)))

    @property
    def is_alone(self) -> bool:
        """Whether exact contacts of pins, if there are some, are about the axes that were found, as are all others."""
        first, alike = self.first.other, all(each.other.on_axis_of(self.first.other) for each in self.found)
        return not any(self.pins) or (alike and all(pin or _rolls(each, first) for each, pin in self._contacts))

    @property
    def is_kept(self) -> bool:
        """Whether exact contacts say that the bodies turn about the axis without a slide: pins, and faces across it."""
        pair = self.first
        flat = [contact.surfaces[0] for contact, pin in self._contacts if not pin and contact.contact_state.is_flat]
        across = [stands_across(each, pair.one.axis) for each in flat]
        return any(self.pins) and any(across) and all(across) and len(flat) + sum(self.pins) == len(self.touching)

    @property
    def _contacts(self) -> list[tuple[Contact, bool]]:
        return list(zip(self.touching, self.pins, strict=True))


def coaxial_features(known: Known, axes: Sequence[CommonAxis] | None = None) -> list[CoaxialFeatures]:
    """Find the bodies that have axes in common, but those that joints join already."""
    if axes is None:
        axes = [pair for pair in known.axes if not pair.threaded and id(pair) not in known.slot_ends]
    body, between, jointed = known.body, {}, known.jointed
    for pair in _neighbours(axes, body):
        owners = frozenset(body[part] for part in pair.parts)
        if len(owners) == 2 and owners not in jointed:
            between.setdefault(owners, []).append(pair)
    exact: dict[BodyPair, list[Contact]] = {}
    for contact in known.contacts:
        exact.setdefault(frozenset(body[part] for part in contact.parts), []).append(contact)
    return [_features_of(owners, found, exact.get(owners, [])) for owners, found in between.items()]


def _features_of(owners: BodyPair, found: list[CommonAxis], touching: list[Contact]) -> CoaxialFeatures:
    """Collect what two bodies have about their axis.

    Where a pin fits exactly, equal bores without a pin on another axis hold nothing, such as those of two tubes that
    are drawn in line; parallel ones that bolts go through have made one body.
    """
    every = CoaxialFeatures(owners, found, touching)
    if every.first.virtual or not any(every.pins):
        return every
    on_axis = [each for each in found if not each.virtual or each.other.on_axis_of(every.first.other)]
    return every._replace(found=on_axis)


def _rolls(contact: Contact, axis: Bore) -> bool:
    """Tell whether a round face about an axis touches a plane along it, as a flywheel that grazes its base: whatever
    turns about the axis, or slides along it, still does."""
    planes = [each for each in contact.surfaces if isinstance(each, Plane)]
    rounds = [each for each in contact.surfaces if isinstance(each, Cylinder)]
    if len(planes) != 1 or len(rounds) != 1 or abs(float(planes[0].normal @ axis.axis)) > ACROSS:
        return False
    offset = rounds[0].point - axis.point
    apart = np.linalg.norm(np.cross(offset, axis.axis))
    tilt = np.linalg.norm(np.cross(rounds[0].axis, axis.axis))
    return bool(tilt <= NEAR_ANGLE and apart <= NEAR_LENGTH * axis.radius)


def _neighbours(axes: Sequence[CommonAxis], body: Mapping[str, str]) -> list[CommonAxis]:
    """Find the common axes of pins, and of bores without a pin those between neighbours along one axis.

    Five levers on one axis have four hinges: the others follow from these, and would lock nothing but say more.
    """
    import networkx as nx  # here, as it takes as long to import as half of JAX

    virtual = sorted((pair for pair in axes if pair.virtual), key=lambda pair: -engaged(pair))
    graphs: list[tuple[Bore, nx.Graph]] = []
    kept = {id(pair) for pair in axes if not pair.virtual}
    for pair in virtual:
        graph = next((graph for axis, graph in graphs if pair.one.on_axis_of(axis)), None)
        if graph is None:
            graph = nx.Graph()
            graphs.append((pair.one, graph))
        one, other = (body[part] for part in pair.parts)
        if one != other and not (one in graph and other in graph and nx.has_path(graph, one, other)):
            graph.add_edge(one, other)
            kept.add(id(pair))
        elif graph.has_edge(one, other):
            kept.add(id(pair))
    return [pair for pair in axes if id(pair) in kept]
