"""Bodies that faces seat in or on another one but for a slide, or a turn as of a thread, which moves nothing else."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Set
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.guides import is_guide
from jaxkin.assembly.inference.bores import NEAR_ANGLE, bores
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import BodyPair
from jaxkin.assembly.inference.lead_nuts import is_lead_screw
from jaxkin.geometry.part import size
from jaxkin.geometry.pose import Transform, Vector
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.open_loops import opening
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

NEAR = 1e-4
"""Distance of two axes that are one, over the size of the assembly."""


def useful_freedoms(mechanism: Mechanism) -> int:
    """Count the freedoms that are of use; 0 where the loops are open in the given pose, so that none can be counted."""
    return 0 if opening(mechanism.linkage, mechanism.unit) is not None else mechanism.mobility().useful


def not_idle(mechanism: Mechanism) -> int:
    """Count the freedoms that are not idle, those of parts that only spin included; 0 where none is of use."""
    return useful_freedoms(mechanism) and mechanism.mobility().useful + mechanism.mobility().spins


def seats_of(
    mechanism: Mechanism, inexact: bool, bearings: Collection[str], driven: Collection[BodyPair]
) -> list[Inference]:
    """Find bodies between which faces leave slides that move nothing else: a bracket on a step, a plate between two
    cheeks; and rods that are set into each other as a rod end into its rod, which leave a turn, where the assembly is
    `inexact`: where exact contacts do not determine all of it. What is in one of the `bearings` turns there, and
    so do the `driven`, motors and what is on their shafts.

    Only where something moves: of a mechanism that is locked nothing is known to be of no use. Seats on both sides of a
    body that would hold two others to each other which move by a joint, or, where they are flat, over a roller, are not
    both taken, nor a seat of a body that slides in a third one on a body that turns there. A carriage on a rail is a
    guide, though nothing that is drawn moves with it. What drives turns in what is fixed, but a motor itself is held
    there, and so is a pin between the cheeks of a fork; a lead screw turns in what it moves.
    """
    if not useful_freedoms(mechanism):
        return []
    idle = {*mechanism.mobility().idle}
    owner = body_of_parts(mechanism.bodies)
    useful = [joint.parts for joint in mechanism.all_joints if {*joint.full_names} - idle]
    over_rollers = _over_rollers(mechanism, idle, owner)
    ground = {owner.get(part, part) for part in mechanism.fixed}
    threads = [joint.parts for joint in mechanism.all_joints if is_lead_screw(joint)]
    on_threads = {owner[part] for parts in threads for part in parts} - ground
    result = []
    for joint in mechanism.all_joints:
        flat = joint.kind in (JointKind.PRISMATIC, JointKind.PLANAR)
        turning = inexact and joint.kind is JointKind.REVOLUTE and frozenset(joint.parts) not in driven
        turning = turning and not {owner[part] for part in joint.parts} & on_threads
        mounted = any(pair & {*joint.parts} for pair in driven)
        if turning and not mounted and {owner[part] for part in joint.parts} & ground:
            turning = _is_pin_of_fork(mechanism, joint, owner, ground)
        screwed = turning and not {*joint.parts} & {*bearings} and _is_in_line(mechanism, joint, owner)
        if joint.kind is JointKind.FIXED and joint.name in mechanism.contacts and joint.evidence:
            result.append(Inference(joint.parts, joint.evidence))
            continue
        moved = {*joint.full_names} - idle
        if joint.name not in mechanism.contacts or not (flat or screwed) or moved or is_guide(mechanism, joint):
            continue
        one, other = (owner[part] for part in joint.parts)
        joined = {part: one if body == other else body for part, body in owner.items()}
        moving = [*useful, *over_rollers] if flat else useful
        apart = all(joined[first] != joined[second] or owner[first] == owner[second] for first, second in moving)
        if apart and not locks_slide(mechanism, joint, owner):
            rest = "turn, as of a thread," if screwed else "slide"
            text = f"faces hold {joint.parts[0]!r} to {joint.parts[1]!r} but for a {rest} that moves nothing else"
            result.append(Inference(joint.parts, Evidence(EvidenceKind.ENCLOSED, (), text)))
            owner = joined
    return result


def _over_rollers(mechanism: Mechanism, idle: Collection[str], owner: Mapping[str, str]) -> list[tuple[str, str]]:
    """List the pairs of bodies with a roller between them, which moves on the one and only turns or slides idly on the
    pin of the other."""
    moving: list[tuple[str, str]] = []
    on: dict[str, list[str]] = {}
    for joint in mechanism.all_joints:
        one, other = (owner[part] for part in joint.parts)
        if {*joint.full_names} - {*idle}:
            moving += [(one, other), (other, one)]
        elif joint.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
            on.setdefault(one, []).append(other)
            on.setdefault(other, []).append(one)
    return [(one, pin) for one, roller in moving for pin in on.get(roller, ()) if pin != one]


def is_on_one_plane(mechanism: Mechanism, seat: Inference) -> bool:
    """Tell whether all that faces hold of a seat is that one part lies flat on the other."""
    joints = [joint for joint in mechanism.all_joints if {*joint.parts} == {*seat.parts}]
    return any(joint.kind is JointKind.PLANAR for joint in joints)


def locks_slide(mechanism: Mechanism, seat: Joint, owner: Mapping[str, str]) -> bool:
    """Tell whether one of two bodies slides in a third one on which the other one turns: a crank and the yoke on it."""
    kinds: dict[tuple[str, str], set[JointKind]] = {}
    for joint in mechanism.all_joints:
        pair = [owner[part] for part in joint.parts]
        for one, other in (pair, pair[::-1]):
            kinds.setdefault((one, other), set()).add(joint.kind)
    one, other = ({body: some for (first, body), some in kinds.items() if first == owner[part]} for part in seat.parts)
    both = [{*map(frozenset, (one[body], other[body]))} for body in one.keys() & other.keys()]
    return {frozenset({JointKind.PRISMATIC}), frozenset({JointKind.REVOLUTE})} in both


def _is_in_line(mechanism: Mechanism, joint: Joint, owner: Mapping[str, str]) -> bool:
    """Tell whether all other joints of one of two bodies are about the axis of a joint, as those of the rod of a
    cylinder with an eye on its end are; a roller also touches its rail."""
    pose = np.asarray(joint.frames_1, float)[0]
    point, axis = pose[:3, 3], pose[:3, 2]
    near = NEAR * size(mechanism.solids)
    for body in {owner[part] for part in joint.parts}:
        others = [
            each
            for each in mechanism.all_joints
            if each is not joint and each.freedoms and body in {owner[part] for part in each.parts}
        ]
        if others and all(_is_about(each, point, axis, near) for each in others):
            return True
    return False


def _is_pin_of_fork(mechanism: Mechanism, joint: Joint, owner: Mapping[str, str], ground: Set[str]) -> bool:
    """Tell whether all that is on a body that turns in the ground is between holes of the ground for it, and turns
    there about the same axis, or moves across it, as what is on a pin between the cheeks of its fork does.

    A screw or a nut that drives something moves it along its axis, and a shaft carries its crank beside its bearings.
    """
    frame = np.asarray(joint.frames_1, float)[0]
    pairs = [(each, {owner[part] for part in each.parts}) for each in mechanism.all_joints if each is not joint]
    turning = {owner[part] for part in joint.parts} - ground
    on = {body for _, pair in pairs if pair & turning for body in pair - turning}
    across = {
        body
        for each, pair in pairs
        if each.kind in (JointKind.PLANAR, JointKind.REVOLUTE)
        and np.linalg.norm(np.cross(np.asarray(each.frames_1, float)[0, :3, 2], frame[:3, 2])) < NEAR_ANGLE
        and pair & ground
        for body in pair - ground
    }
    cheeks = _holes(mechanism, ground, owner, frame)
    near = NEAR * size(mechanism.solids)
    for body in on & across:
        ends = [end for span in _holes(mechanism, {body}, owner, frame) for end in span]
        before = any(end <= min(ends, default=-np.inf) + near for _, end in cheeks)
        if not (before and any(start >= max(ends) - near for start, _ in cheeks)):
            return False
    return bool(on) and on <= across


def _holes(
    mechanism: Mechanism, bodies: Set[str], owner: Mapping[str, str], frame: Transform
) -> list[tuple[float, float]]:
    """Find where the holes of some bodies on an axis are along it, the z axis of `frame`."""
    axis, near = frame[:3, 2], NEAR * size(mechanism.solids)
    own = [bore for part in mechanism.solids if owner.get(part.name, part.name) in bodies for bore in bores(part)]
    own = [bore for bore in own if bore.hole and np.linalg.norm(np.cross(bore.axis, axis)) < NEAR_ANGLE]
    own = [bore for bore in own if np.linalg.norm(np.cross(bore.point - frame[:3, 3], axis)) <= near]
    return [span for bore in own for span in bore.spans_along(axis)]


def _is_about(joint: Joint, point: Vector, axis: Vector, near: float) -> bool:
    """Tell whether a joint is a turn about an axis, or along and about it, or about a point on it, but for the distance
    `near`."""
    frame = np.asarray(joint.frames_1, float)[0]
    offset = frame[:3, 3] - point
    apart = float(np.linalg.norm(np.cross(offset, axis)))
    along = bool(np.linalg.norm(np.cross(frame[:3, 2], axis)) < NEAR_ANGLE)
    turns = joint.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL) and along
    return (turns or joint.kind is JointKind.SPHERICAL) and apart <= near
