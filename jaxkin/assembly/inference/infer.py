"""What a set of solids implies beside its exact contacts, step by step, the surest first."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from jaxkin.assembly.inference.ball_joints import ball_joints
from jaxkin.assembly.inference.ball_studs import held_studs
from jaxkin.assembly.inference.bearing_blocks import bearing_blocks
from jaxkin.assembly.inference.bearing_joints import bearing_bodies, bearing_joints
from jaxkin.assembly.inference.bearings import outside_of
from jaxkin.assembly.inference.carriages import carriages
from jaxkin.assembly.inference.clamp_screws import swivel_screws
from jaxkin.assembly.inference.closed_bearing_joints import (
    closed_bearing_bodies,
    closed_bearing_joints,
    in_closed_bearings,
    lone_rollers,
)
from jaxkin.assembly.inference.collets import collets
from jaxkin.assembly.inference.concentric import without_concentric
from jaxkin.assembly.inference.dowels import dowelled
from jaxkin.assembly.inference.far import far_joints
from jaxkin.assembly.inference.fasteners import fasteners, stacks
from jaxkin.assembly.inference.feathers import feathers
from jaxkin.assembly.inference.fittings import screwed_fittings
from jaxkin.assembly.inference.floating import floating
from jaxkin.assembly.inference.grooves import in_grooves, rollers_in_channels
from jaxkin.assembly.inference.heads import is_beside_its_hole, is_countersunk, is_head_on_tube
from jaxkin.assembly.inference.held import (
    attached_fasteners,
    bolted_bodies,
    pressed_rings,
    rollers,
    with_hosts,
)
from jaxkin.assembly.inference.hinges import hinges
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.keyed import flatted_hubs, keyed_hubs, seated_on_squares, slit_hubs, squared_hubs
from jaxkin.assembly.inference.known import BodyPair, Known
from jaxkin.assembly.inference.lead_nuts import lead_nuts, on_lead_screws, on_travelling_screws
from jaxkin.assembly.inference.link_ends import hinged_ends
from jaxkin.assembly.inference.lock_nuts import locked_threads
from jaxkin.assembly.inference.lying_on_one import lying_on_one
from jaxkin.assembly.inference.meshing_wheels import meshing_wheels
from jaxkin.assembly.inference.motors import motor_shafts
from jaxkin.assembly.inference.on_motors import held_motors, motor_joints, on_shafts
from jaxkin.assembly.inference.on_rings import clamped_on_rings
from jaxkin.assembly.inference.one_screw import clamped_by_one_screw
from jaxkin.assembly.inference.pinned_slides import pinned_slides
from jaxkin.assembly.inference.pocketed_nuts import nuts_in_pockets
from jaxkin.assembly.inference.pressed_bars import pressed_bars
from jaxkin.assembly.inference.retaining_rings import retaining_rings
from jaxkin.assembly.inference.ring_grooves import in_ring_grooves, turning_in_hubs
from jaxkin.assembly.inference.rod_end_bolts import bolted_balls
from jaxkin.assembly.inference.screwed import screwed_bodies, screwed_in
from jaxkin.assembly.inference.set_on import set_on_pins
from jaxkin.assembly.inference.set_screws import clamped_hubs
from jaxkin.assembly.inference.shims import shims
from jaxkin.assembly.inference.shoes import blocks_between_walls, shoes
from jaxkin.assembly.inference.shouldered import pressed_on_shoulders
from jaxkin.assembly.inference.sleeves import (
    barrels,
    driven_sleeves,
    hollow_axles,
    hollow_pins,
    seated_sleeves,
    sleeves,
    sliding_rods,
)
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.assembly.inference.slides import guided_on_faces, loose_slides
from jaxkin.assembly.inference.slot_joints import slot_joints
from jaxkin.assembly.inference.slotted import clamped_on_slots
from jaxkin.assembly.inference.spacers import clamped_standoffs, spacers
from jaxkin.assembly.inference.spreaders import spreaders
from jaxkin.assembly.inference.standing import butting_pins, embedded_pins, standing_rods
from jaxkin.assembly.inference.stopped_joint import StoppedJoint, near_first
from jaxkin.assembly.inference.tabs import tabs_in_slots
from jaxkin.assembly.inference.tapers import self_holding_tapers
from jaxkin.assembly.inference.tight_ends import bolted_ends, pressed_pins, riveted_studs, screwed_on_ends
from jaxkin.assembly.inference.tube_clamps import clamped_halves, u_bolts
from jaxkin.assembly.inference.undrawn import (
    empty_nuts,
    half_screwed,
    lone_screws,
    screwed_flat,
    screwed_on_shafts,
)
from jaxkin.assembly.inference.undrawn_rods import on_undrawn_rods
from jaxkin.assembly.inference.untied import sunk_in_siblings, tied_to_nothing


class Inferred(NamedTuple):
    """What solids imply."""

    found: list[Inference]
    stops: list[list[Inference]]
    """Lists of joints without a slide, from the surest to the least sure. Each joint may replace a sliding one; the
    caller takes it where that slide moves nothing else."""
    fasteners: frozenset[str]
    """The parts that were taken for fasteners by their form, and that neither slide, turn nor roll on what they are
    in."""
    taken_back: set[BodyPair]
    """Those of the ignored pairs between which something would have been inferred."""
    driven: set[BodyPair]
    """Motors that are one solid with their shaft, each with a hub on that."""


def infer(known: Known) -> Inferred:
    """Infer bodies and joints from solids, the surest rule first; later rules never change what earlier ones found.

    Rules are called in ranks, one function each below; the order within a function counts as well. Each rule is a
    function of what is `known` so far, which grows by what the rule finds.
    """
    _take_bearings(known)
    fastening = _take_hubs_and_find_fasteners(known)
    _take_pins_in_one_part(known, fastening)
    _take_what_fasteners_hold(known, fastening)
    stopped = _take_joints_between_bodies(known, fastening)
    _take_what_is_left(known, stopped.guided)

    # what would stop slides that contacts allow, by how sure it is
    body = known.body
    replacing = [each for each in stopped.joined if each.replaces_slide]
    replacing = [each for each in replacing if len({body[part] for part in each.inference.parts}) > 1]
    levels = [[each for each in replacing if each.stop is level] for level in Stop]
    levels[Stop.FACES : Stop.FACES + 1] = near_first(levels[Stop.FACES])
    stops = [[each.inference for each in level] for level in levels]
    return Inferred(known.found, stops, frozenset(fastening), known.taken_back, known.driven)


def _take_bearings(known: Known) -> None:
    """Take what rolling bearings tell: their rings and balls, what lies on one ring only, and bearings that are one
    ring each in what they sit in."""
    measured = known.measured
    rolling = measured.bearings
    known.axes = outside_of(rolling, known.axes)
    known.rings = {frozenset((each.outer, each.inner)) for each in rolling}
    known.take(bearing_bodies(known, rolling))
    known.take(clamped_on_rings(known, rolling))
    closed = measured.closed_bearings
    known.rings |= {frozenset(pair.parts) for pair in in_closed_bearings(known, closed)}
    known.closed = {each.part.name for each in closed}
    known.take(closed_bearing_bodies(known, closed))
    known.driven = {frozenset(pair.parts) for _, pair in on_shafts(known)}
    known.rings |= known.driven


def _take_hubs_and_find_fasteners(known: Known) -> set[str]:
    """Take what holds shafts and hubs to each other, keys, flats, balls of rod ends, split rings, bushes and screws
    across; find which of the parts of the form of a fastener are fasteners."""
    known.in_ring_grooves = in_ring_grooves(known)
    known.take(feathers(known))
    known.take([*keyed_hubs(known), *flatted_hubs(known), *slit_hubs(known)])
    known.take(bolted_balls(known))
    known.take([*collets(known), *self_holding_tapers(known)])
    set_in = sleeves(known)
    driven = driven_sleeves(known, set_in)
    clamped = clamped_standoffs(known, set_in)
    known.take([*clamped.values()])
    set_in = [each for each in set_in if each.part not in driven | clamped.keys()]
    known.take(seated_sleeves(known, set_in))
    bores = [bore for pair in known.axes for bore in (pair.one, pair.other)]
    fastening = fasteners(known.parts, bores, known.bores, known.plugged)
    known.take(clamped_hubs(known, fastening))
    known.sleeves = {each.part for each in set_in} - {*known.fixed}

    # no fasteners are rings and sleeves, nor what slides, turns or rolls
    rings = {name for each in known.measured.bearings for name in (each.outer, each.inner)}
    fastening -= rings | known.sleeves | known.closed
    axles = hollow_axles(known)
    fastening -= sliding_rods(known, set_in) | (axles - hollow_pins(known, axles)) | driven | barrels(set_in)
    known.blocks = blocks_between_walls(known, fastening)
    fastening -= rollers(known, fastening) | rollers_in_channels(known, fastening)
    fastening -= known.blocks | bearing_blocks(known, fastening) | in_grooves(known, fastening)
    fastening -= {each.screw.part for each in lead_nuts(known)}
    known.take([*squared_hubs(known, fastening), *pressed_on_shoulders(known, fastening)])
    known.take(seated_on_squares(known, fastening))
    fastening -= meshing_wheels(known, fastening) | turning_in_hubs(known, fastening)
    fastening -= swivel_screws(known, fastening)
    known.take(locked_threads(known, fastening))
    body = known.body
    others = [each for each in known.contacts if not (each.contact_state.is_flat or each.contact_state.is_pin)]
    others = [each for each in others if not (is_head_on_tube(known, each) or is_countersunk(known, each))]
    others = [each for each in others if not is_beside_its_hole(known, each)]
    others = [each for each in others if not {each.parts, each.parts[::-1]} & known.in_ring_grooves.keys()]
    separate = [each.parts for each in others if len({body[part] for part in each.parts}) > 1]
    return fastening - {*known.fixed, *(part for parts in separate for part in parts)}


def _take_pins_in_one_part(known: Known, fastening: Collection[str]) -> None:
    """Take pins that are in one part: by threads, motors, posts, press fits, rivets, rings in grooves."""
    known.take(nuts_in_pockets(known))
    known.take(screwed_in(known, fastening))
    known.take(motor_shafts(known, fastening))
    known.take(embedded_pins(known, fastening))
    known.take(butting_pins(known, fastening))
    known.take(standing_rods(known, fastening))
    known.take([*pressed_pins(known), *bolted_ends(known)])
    known.take([*riveted_studs(known, fastening), *screwed_on_ends(known), *screwed_fittings(known)])
    known.take([*pressed_rings(known), *retaining_rings(known)])
    known.take(spreaders(known))


def _take_what_fasteners_hold(known: Known, fastening: Collection[str]) -> None:
    """Take what patterns of fasteners hold, then each fastener with its body, then what one screw alone holds."""
    outside = [pair for pair in known.axes if not {*pair.parts} & known.closed]  # bearings hold no fastener
    outside = [pair for pair in outside if frozenset(pair.parts) not in known.driven]
    touching = {pair for pair in known.touching if not pair & known.closed} - known.driven
    drawn = stacks(outside, fastening, touching, known.order)
    every = with_hosts([*drawn, *spacers(known, fastening)], known)
    known.take(on_undrawn_rods(known))
    while known.take(bolted_bodies(known, every)):
        pass
    known.take(attached_fasteners(known, every))
    known.take(pressed_bars(known, fastening))
    known.take([*empty_nuts(known), *screwed_on_shafts(known)])
    known.take([*screwed_bodies(known, every), *half_screwed(known, every)])
    if known.take(clamped_by_one_screw(known, every)):  # patterns of what these are one body with
        while known.take(bolted_bodies(known, every)):
            pass
    known.take(shims(known, every))
    known.take(clamped_on_slots(known, every))
    known.take([*clamped_halves(known), *u_bolts(known)])


class _StoppedJoints(NamedTuple):
    """Joints between bodies with what stops their slides; of these, those that replace a slide are not taken yet."""

    joined: list[StoppedJoint]
    """All of them."""
    guided: list[StoppedJoint]
    """Those that walls guide along faces."""


def _take_joints_between_bodies(known: Known, fastening: Collection[str]) -> _StoppedJoints:
    """Take joints between bodies, but for those that would replace a slide: by bearings, balls, shoes, hinges, slides,
    wheels."""
    known.take(held_motors(known))
    known.take(bearing_joints(known, known.measured.bearings))
    known.take(ball_joints(known))
    known.take(on_lead_screws(known, lead_nuts(known)))
    known.take(shoes(known))
    known.take([*pinned_slides(known), *dowelled(known), *tabs_in_slots(known)])
    turning = [*closed_bearing_joints(known, known.measured.closed_bearings), *motor_joints(known)]
    known.take([each.inference for each in turning if not each.replaces_slide])
    body = known.body
    borne = {frozenset(body[part] for part in each.inference.parts) for each in turning}
    others = without_concentric(known, hinges(known, fastening), [*known.found, *(each.inference for each in turning)])
    joined = [*turning, *(each for each in others if {body[part] for part in each.inference.parts} not in borne)]
    guided = guided_on_faces(known)
    sliding = [*(each.inference for each in guided), *carriages(known)]
    joined += [*set_on_pins(known, joined, sliding), *guided]
    known.take(floating(known, joined))
    known.take(held_studs(known, joined, fastening))
    known.take([each.inference for each in joined if not each.replaces_slide and each not in turning])
    known.take(carriages(known))
    known.take(slot_joints(known, joined))
    known.take(loose_slides(known))
    known.take(carriages(known))
    known.take(on_travelling_screws(known))
    return _StoppedJoints(joined, guided)


def _take_what_is_left(known: Known, guided: Sequence[StoppedJoint]) -> None:
    """Take what is left: parts that lie on one other, or that nothing ties."""
    known.take(hinged_ends(known))
    known.take([*screwed_flat(known), *lone_rollers(known, known.measured.closed_bearings)])
    known.take(lone_screws(known))
    known.take(lying_on_one(known, guided))
    known.take(sunk_in_siblings(known))
    known.take(far_joints(known))
    known.take(tied_to_nothing(known))
