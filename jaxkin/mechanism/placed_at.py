"""Assemble a mechanism in another of its poses: joints, limits, couplings, solids and contacts stand there then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import check_motion
from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Transform, inverse
from jaxkin.joints.joint import Joint, shifted
from jaxkin.joints.screws import chain, freedoms
from jaxkin.linkage.coupled import counted_from
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.moved_solids import moved_solids
from jaxkin.mechanism.pose import Pose
from jaxkin.mobility.alignment import SIX_DIGITS, aligned
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def mechanism_at(mechanism: Mechanism, motion: Motion | Pose, index: int) -> Mechanism:
    """Assemble the same parts and joints as in a closed pose of a motion of the mechanism.

    Solids, limits and couplings stand there too, and all displacements count from there; lengths stay as they are.
    Raises ValueError for a pose that is not closed, for the motion of a mechanism with other joints, and inside `jit`,
    `vmap` and `grad`.
    """
    motion = motion_of(motion, "poses to assemble in")
    if traced((mechanism, motion)):
        raise ValueError("at() is for numbers: inside jit, vmap and grad sweep the mechanism instead")
    own = {joint.name: joint.parts for joint in mechanism.all_joints}
    if not own.items() <= {joint.name: joint.parts for joint in motion.mechanism.all_joints}.items():
        raise ValueError("the motion is that of a mechanism with other parts or joints: write motion.mechanism.at(...)")
    check_closed_pose(motion, index)
    rows = {name: np.asarray(q, float)[index] for name, q in motion.coordinates.items()}
    return placed_at(mechanism, rows, SIX_DIGITS)[0]


def motion_of(given: Motion | Pose, what: str) -> Motion:
    """Return a motion, or that of one pose; ValueError for others, whose message begins with what is found of it."""
    motion = given.motion if isinstance(given, Pose) else given
    check_motion(motion, what)
    return motion


def check_closed_pose(motion: Motion, index: int) -> None:
    """Raise ValueError where a motion has no pose of that number, and where the pose is not closed.

    A status that JAX traces is not looked at.
    """
    if isinstance(index, bool) or not isinstance(index, int | np.integer) or not -len(motion) <= index < len(motion):
        raise ValueError(f"the motion has {len(motion)} poses, numbered from 0, got {index!r}")
    if traced(motion.status):
        return
    status = Status(int(motion.status[index]))
    if status not in (Status.CLOSED, Status.LIMITED, Status.JUMPED):
        raise ValueError(
            f"pose {index} is {status.name}: {status.message}; a mechanism is assembled in closed poses only"
        )


def placed_at(
    mechanism: Mechanism, coordinates: Mapping[str, Float[np.ndarray, " _"]], noise: float
) -> tuple[Mechanism, dict[str, Transform]]:
    """Assemble a mechanism where its joints, by name, are displaced by `coordinates`, in a pose whose loops close.

    All lengths stay as they are; displacements, limits and couplings count from there. `noise` is that of `aligned`.
    Also returns the displacement of each part, in world coordinates.
    """
    given = mechanism.linkage
    places = part_places(given, [coordinates[joint.name] for joint in given.joints])
    joints = [
        shifted(_placed(joint, places[joint.parts[0]], coordinates[joint.name]), coordinates[joint.name])
        for joint in given.joints
    ]
    couplings = counted_from(given.couplings, given.joints, coordinates)
    linkage, notes = aligned(replace(given.with_joints(joints), couplings=couplings), noise, mechanism.unit)
    solids, contacts, left_out = moved_solids(mechanism.solids, mechanism.contacts, places)
    history = mechanism.history
    if left_out:
        names = ", ".join(map(repr, left_out))
        history = (*history, f"the contacts of {names} are not followed from here on: its parts have moved")
    found = replace(mechanism, linkage=linkage, solids=solids, history=history, alignment=notes, contacts=contacts)
    return found, places


def part_places(linkage: Linkage, coordinates: Sequence[Float[np.ndarray, " _"]]) -> dict[str, Transform]:
    """Compute displacements of all parts, in world coordinates, from those of all joints along the tree."""
    places = {part: np.eye(4) for part in linkage.fixed}
    for part, parent, index, sign in linkage.structure.tree:
        step = _displacement(linkage.joints[index], coordinates[index])
        places[part] = places[parent] @ (step if sign > 0 else inverse(step))
    return {part: places[part] for part in linkage.parts}


def _displacement(joint: Joint, q: Float[np.ndarray, " _"]) -> Transform:
    before, after = (np.asarray(side, float) for side in (joint.frames_1, joint.frames_2))
    return chain(joint.movements, before, q, float(joint.pitch), after, joint.splines)[0]


def _placed(joint: Joint, place: Transform, q: Float[np.ndarray, " _"]) -> Joint:
    """Move a joint to its new place, where the frames on its two parts are the same.

    Each frame goes along with all elementary motions of its movement but the last one: from there on the movement is
    what it was, whatever the last one has turned or shifted. Where a coordinate drives several motions, as in a
    constant velocity joint, the frame goes along with half of the rotation: its z axis bisects the shafts again. That
    of a curve or a surface goes along to the contact where it belongs to part 1, and counts from there.
    """
    frames, start = [], 0
    curves = list(joint.curves)
    for number, name in enumerate(joint.movements):
        before, after = (np.asarray(side, float)[number : number + 1] for side in (joint.frames_1, joint.frames_2))
        own = q[start : start + freedoms([name])]
        start += len(own)
        most, splines = own.copy(), joint.splines[number : number + 1]
        curve = joint.curves[number] if joint.curves else None
        if curve is not None:
            curves[number] = curve.counted_from(*map(float, own))
            most *= MOVEMENTS[name].elements[0].sense > 0
        elif MOVEMENTS[name].elements and not MOVEMENTS[name].repeats:
            most[MOVEMENTS[name].elements[-1].coordinate] = 0.0
        new = place @ chain([name], before, most, float(joint.pitch), splines=splines)[0] @ before[0]
        if MOVEMENTS[name].repeats:
            start_of = place @ before[0]
            new[:3, :3] = start_of[:3, :3] @ _half(start_of[:3, :3].T @ new[:3, :3])
        frames.append(new)
        place = place @ chain([name], before, own, float(joint.pitch), after, splines)[0]
    stacked = np.array(frames, np.asarray(joint.frames_1).dtype)
    return replace(joint, frames_1=stacked, frames_2=stacked, curves=tuple(curves))


def _half(rotation: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """Find the rotation about the same axis by half the angle, below half a turn: the rotation nearest to 1 + R."""
    left, _, right = np.linalg.svd(np.eye(3) + rotation)
    return left @ right
