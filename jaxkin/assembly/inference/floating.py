"""Floating parts: between two bodies that turn about axes across them, in a slot of each, as the disc of Oldham's
coupling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.assembly.inference.walls import MAX_SIDE_PLAY, Looking, facing, walls
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints import pairs
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind


def floating(known: Known, joined: Sequence[StoppedJoint]) -> list[Inference]:
    """Infer the two slides of parts that are between two bodies, with walls of each on both sides.

    Neither body alone stops the part along the axis. Both do, where they turn about axes in that direction, by bearings
    or hinges `joined`, and so stay where they are along it.
    """
    body, result = known.body, []
    tied = {*known.jointed, *(frozenset(body[each] for each in hinge.inference.parts) for hinge in joined)}
    turning = [each.joint for each in (*known.found, *(each.inference for each in joined)) if each.joint]
    turning = [joint for joint in turning if joint.kind is JointKind.REVOLUTE]
    if len(turning) < 2:
        return []
    for part in known.parts:
        around = known.around(part, body)
        free = (owner for owner in around if frozenset((body[part.name], owner)) not in tied)
        free = (owner for owner in free if _may_slide(known, part.name, owner) and _turns(turning, body, owner))
        looking = {owner: facing(part, around[owner]) for owner in free}
        for one, other in combinations(looking, 2):
            axis = _between(looking[one], looking[other])
            if axis is None or not all(_turns(turning, body, owner, axis) for owner in (one, other)):
                continue
            found = {owner: wall_across(looking[owner], axis) for owner in (one, other)}
            slots = {owner: wall for owner, wall in found.items() if wall is not None}
            for owner, (normal, play) in slots.items() if len(slots) == 2 else ():
                result.append(_slide(known, part, around[owner][0], np.cross(normal, axis), play))
                tied.add(frozenset((body[part.name], owner)))
    return result


def _may_slide(known: Known, part: str, owner: str) -> bool:
    """Tell whether a part and a body touch on plane faces only, if at all, and no pin of one is in the other."""
    body = known.body
    pair = {body[part], owner}
    axes = any({body[each] for each in axis.parts} == pair for axis in known.axes if not axis.virtual)
    others = (each for each in known.contacts if {body[part] for part in each.parts} == pair)
    return not axes and all(each.contact_state.is_flat and isinstance(each.surfaces[0], Plane) for each in others)


def _turns(turning: Sequence[Joint], body: Mapping[str, str], owner: str, axis: Vector | None = None) -> bool:
    """Tell whether a body has a joint about an axis, or about any without one."""
    own = (joint for joint in turning if owner in {body[part] for part in joint.parts})
    about = (np.asarray(joint.frames_1, float)[0, :3, 2] for joint in own)
    return any(axis is None or np.linalg.norm(np.cross(each, axis)) < ACROSS for each in about)


def _between(one: Sequence[Looking], other: Sequence[Looking]) -> Vector | None:
    """Find the direction in which a part is between faces of two bodies, with a play that is none for its width."""
    for normal, gap, place in one:
        for back, other_gap, other_place in other:
            width = abs(place + other_place)
            if np.linalg.norm(normal + back) < ACROSS and gap + other_gap <= MAX_SIDE_PLAY * width:
                return normal
    return None


def wall_across(looking: Sequence[Looking], axis: Vector) -> tuple[Vector, float] | None:
    """Find the walls of a body on both sides of a part, across an axis: their normal, and the play; None where walls
    hold the part in two directions across the axis, or in none."""
    held = [(normal, play) for normal, play, _ in walls(looking) if abs(normal @ axis) < ACROSS]
    if not held or any(np.linalg.norm(np.cross(normal, held[0][0])) > ACROSS for normal, _ in held):
        return None
    return min(held, key=lambda each: each[1])


def _slide(known: Known, part: Part, other: Part, along: Vector, play: float) -> Inference:
    """Make the prismatic joint of a floating part and a body whose slot it is in."""
    parts = known.in_order((part.name, other.name))
    text = f"{part.name!r} floats between two bodies that turn, with a play of {play:.2g} in a slot of {other.name!r}"
    evidence = Evidence(EvidenceKind.CLEARANCE, (("play", play),), text)
    joint = pairs.prismatic("-".join(parts), *parts, point=part.box.mean(axis=0), axis=along)
    return Inference.of(joint, evidence)
