"""Combine several contacts, or mates, of two parts into the one subgroup joint that they are exactly equivalent to.

The displacements of a subgroup joint form a subgroup of those of space (Herve 1978 lists them): the lower pairs, which
contacts on surfaces amount to, and, from mates that keep an angle only, translations of a plane and of space, and the
Schoenflies motions.

A displacement keeps all contacts if it lies in the displacement set of each contact. To first order these sets are
spaces of twists, and their intersection leaves one candidate for the joint. The candidate is then verified at finite
displacements: contact of the four surfaces is an algebraic condition, so a joint that keeps the contacts at a random
displacement keeps them at every displacement. No larger set keeps them, since none has more freedoms at the pose.

The result is never a screw: a helix is not algebraic, so contacts that allow a screw motion also allow its rotation and
its translation separately.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.movement import Movement
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import Transform, Vector, cross, frame, inverse, skew
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise, movements
from jaxkin.joints.screws import Screws, complement, freedoms, misfit
from jaxkin.joints.screws import chain as displace


def subgroup_joints(movements: Mapping[str, Movement]) -> dict[tuple[int, int], tuple[JointKind, str]]:
    """Tabulate the subgroup joints among some movements: number of rotations and of translations -> kind, key.

    Raises ValueError where two of them share these numbers: contacts that are combined could not tell them apart.
    """
    found: dict[tuple[int, int], tuple[JointKind, str]] = {}
    for name, movement in movements.items():
        if movement.subgroup_joint and not movement.has_pitch:
            kind, other = found.setdefault(movement.turns_and_slides, (JointKind(movement.subgroup_joint), name))
            if other != name:
                turns, slides = movement.turns_and_slides
                raise ValueError(
                    f"movement {name!r} is said to be the subgroup joint {movement.subgroup_joint!r}, with {turns} "
                    f"rotations and {slides} translations, as {other!r} is already ({kind}): contacts can be combined "
                    "to one of them only, leave the `subgroup_joint` of the other out"
                )
    return found


SUBGROUP_JOINTS = subgroup_joints(MOVEMENTS)
"""Number of rotations and of translations, which no two subgroup joints share -> their kind and movement."""


@dataclass(frozen=True, eq=False)
class SubgroupJoint:
    """A joint whose displacements form a subgroup, with its place: revolute, prismatic, cylindrical, planar, spherical,
    or fixed (no freedoms); of mates also rectangular, cartesian or Schoenflies."""

    kind: JointKind
    movement: str
    """Key of the joint in `MOVEMENTS`."""
    frame: Transform
    """Joint frame (4x4) in world coordinates at the assembled pose."""
    margin: float
    """How strictly the contacts forbid all motions that the joint does not allow, dimensionless: the smallest non-zero
    singular value of the constraints on the twist, with lengths over the size of the assembly, but at most 1. A margin
    little above the noise says that the contacts were perhaps meant to allow more."""


class Chain(NamedTuple):
    """A set of displacements, given as all products of some movements one after the other."""

    movements: Sequence[str]
    """Keys of the movements in `MOVEMENTS`."""
    frames: Float[np.ndarray, "frames 4 4"]
    """The frame of each movement, in world coordinates at the assembled pose."""


def combine(contacts: Sequence[Contact], noise: Noise) -> SubgroupJoint | None:
    """Find the lower pair that the contacts between two parts are equivalent to; None if there is none.

    `noise` says which deviations count as zero. The contacts may name the two parts in either order, since a lower pair
    allows the inverse of each displacement that it allows.
    """
    return subgroup_joint([Chain(movements(contact), contact.frames) for contact in contacts], noise)


def subgroup_joint(chains: Sequence[Chain], noise: Noise) -> SubgroupJoint | None:
    """Find the subgroup joint whose displacements are those that all chains allow; None if there is none.

    Where the joint leaves the origin of its frame arbitrary, the admissible point next to the first frame of the first
    chain is chosen; the directions are those of the first frame of any chain with a parallel z axis, or arbitrary in x
    and y if there is none. Of a joint that only slides, x is along the first z axis of another direction, across z.
    `noise` says which deviations count as zero.
    """
    centre, size = chains[0].frames[0, :3, 3], noise.size
    # lengths from `centre` over `size`, so that one tolerance serves angles and lengths
    scaled = [Chain(chain.movements, _scaled(chain.frames, centre, size)) for chain in chains]
    allowed = [displace(*each, np.zeros(freedoms(each.movements)))[1] for each in scaled]
    # 4: entries of the matrices are sums of a few numbers, each within the noise
    tolerance = 4 * noise.angle
    forbidden = np.vstack([complement(screws) for screws in allowed])
    _, strengths, twists = np.linalg.svd(forbidden, full_matrices=True)
    rank = int(np.sum(strengths > tolerance))
    candidate = _candidate(twists[rank:].T, np.concatenate([each.frames for each in scaled]), tolerance)
    if candidate is None:
        return None
    kind, movement, pose = candidate
    coordinates = freedoms([movement])
    # finite displacements of the joint must lie in all sets; chains are algebraic, so random ones decide; two, since
    # one might be special by chance; half a radian, so that `misfit` converges
    for q in np.random.default_rng(0).uniform(-0.5, 0.5, (2, coordinates)):
        displacement = displace([movement], pose[None], q)[0]
        if any(misfit(*each, displacement) > tolerance for each in scaled):
            return None
    pose = pose.copy()
    pose[:3, 3] = centre + size * pose[:3, 3]
    return SubgroupJoint(kind, movement, pose, float(strengths[:rank].min(initial=1.0)))


def includes(loose: Chain, strict: Chain, noise: Noise, back: bool = False) -> bool:
    """Check whether a set of displacements has all that another one has, or their inverses where `back`.

    Both are found to finite displacements, as in `subgroup_joint`, since chains are algebraic.
    """
    if (count := freedoms(strict.movements)) > freedoms(loose.movements):
        return False
    centre = strict.frames[0, :3, 3]
    loose, strict = (Chain(each.movements, _scaled(each.frames, centre, noise.size)) for each in (loose, strict))
    for q in np.random.default_rng(0).uniform(-0.5, 0.5, (2, count)):
        displacement = displace(*strict, q)[0]
        if misfit(*loose, inverse(displacement) if back else displacement) > 4 * noise.angle:
            return False
    return True


def _scaled(frames: np.ndarray, centre: Vector, size: float) -> np.ndarray:
    """Move the origins of frames by `-centre` and divide them by `size`."""
    result = frames.copy()
    result[:, :3, 3] = (result[:, :3, 3] - centre) / size
    return result


def _candidate(twists: Screws, frames: np.ndarray, tolerance: float) -> tuple[JointKind, str, Transform] | None:
    """Find the subgroup joint with the same first-order freedoms as a space of twists; None if none has them.

    `twists` (6, freedoms) spans the space; `frames` (frames, 4, 4) are all frames of the chains, scaled, from which
    arbitrary origins and directions are taken. Returns the kind, the key in `MOVEMENTS` and the frame of the joint.
    """
    directions, strengths, mixes = np.linalg.svd(twists[:3], full_matrices=True)
    rotations = int(np.sum(strengths > tolerance))
    slides = (twists @ mixes[rotations:].T)[3:]  # (3, translations): velocities of the twists without rotation
    if (rotations, slides.shape[1]) not in SUBGROUP_JOINTS:
        return None
    kind, movement = SUBGROUP_JOINTS[rotations, slides.shape[1]]
    turns = twists @ mixes[:rotations].T  # (6, rotations)
    origin, z = frames[0, :3, 3], frames[0, :3, 2]
    if rotations == 1:
        z = directions[:, 0]
    elif slides.shape[1] == 1:
        z = slides[:, 0]
    elif slides.shape[1] == 2:
        z = cross(*slides.T)
    aligned = MOVEMENTS[movement].aligned
    if aligned & {"axis", "centre"}:
        # a rotation w about the point p moves the origin of the world by v = p x w
        crosses = np.vstack([-skew(w) for w in turns[:3].T])
        point = np.linalg.lstsq(crosses, turns[3:].T.ravel(), rcond=tolerance)[0]
        origin = point + z * ((origin - point) @ z) if "axis" in aligned else point
    is_parallel = [bool(np.linalg.norm(cross(pose[:3, 2], z)) <= tolerance) for pose in frames]
    if True not in is_parallel:
        return kind, movement, frame(origin, z)
    same = frames[is_parallel.index(True)]
    x = same[:3, 0]
    if rotations == 0 and slides.shape[1] > 1 and False in is_parallel:
        x = frames[is_parallel.index(False), :3, 2]
    return kind, movement, frame(origin, same[:3, 2], x)
