"""Where the parts of a mechanism are in each pose, and how they move: twists, along the tree from the fixed parts.

Behind an elementary motion with the unit twist S and the rates q', q'', a body with the twist V and its derivative V'
gets

    V + S q',    V' + S q'' + [V, S] q',    [V, S] = (w x w_S; w x v_S + v x w_S).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.effects.forces.joint_screws import JointScrews, carried, chains, coordinates_of_motions
from jaxkin.effects.forces.screws import Scale, Twist, bracket, turned
from jaxkin.geometry.rigid import Rigid, as_rigid, inverse, product
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage


class Places(NamedTuple):
    """A mechanism in each pose."""

    scale: Scale
    parts: dict[str, Rigid]
    """Displacements of the parts that are not fixed, in the unit of the mechanism."""
    joints: dict[int, JointScrews]
    """The joints that were asked for, by number; those of the tree always."""

    def point(self, part: str, at: Any) -> Float[Array, "3 _"]:
        """Place a point of a part, given where it is in the assembled pose: from the middle, over the size."""
        at = jnp.asarray(at, float)
        if part not in self.parts:
            return self.scale.arm(at[:, None])
        own = self.parts[part]
        return self.scale.arm(turned(own, at) + own[:, 3])


def places(linkage: Linkage, displacements: Sequence[Array], chords: bool) -> Places:
    """Place parts, and joints of the tree; with `chords` the other joints, too."""
    scale, tree = Scale.of(linkage), linkage.structure.tree
    numbers = range(len(linkage.joints)) if chords else sorted(number for _, _, number, _ in tree)
    joints = [linkage.joints[number] for number in numbers]
    found = chains(joints, [displacements[number] for number in numbers], scale)
    moved = {number: chain.displacement for number, chain in zip(numbers, found, strict=True)}
    still = as_rigid(jnp.eye(4))
    parts: dict[str, Rigid] = {}
    for part, parent, number, sign in tree:
        step = moved[number] if sign > 0 else inverse(moved[number])
        # found once: XLA would find the whole chain anew wherever it is used
        parts[part] = lax.optimization_barrier(product(parts[parent], step) if parent in parts else step)
    screws = carried(joints, found, [parts.get(joint.parts[0], still) for joint in joints], scale)
    return Places(scale, parts, dict(zip(numbers, screws, strict=True)))


def relative_twist(joint: Joint, own: JointScrews, rates: Float[Array, "poses _"], scale: Scale) -> Twist:
    """Compute the twist of part 2 of a joint relative to part 1; `rates` are in the unit of the mechanism."""
    units = scale.of_coordinates(joint)
    motions = zip(coordinates_of_motions(joint), own.twists, strict=True)
    terms = (twist * (rates[:, k] / units[k]) for k, twist in motions)
    return sum(terms, jnp.zeros((6, rates.shape[0])))


def twists_of_parts(
    linkage: Linkage, at: Places, first: Sequence[Array], second: Sequence[Array] | None = None
) -> tuple[dict[str, Twist], dict[str, Twist]]:
    """Compute the twists of all parts that are not fixed, and their derivatives by time, from rates of all joints.

    `first` and `second` derivatives of the displacements are in radians and the unit of the mechanism, (poses,
    coordinates); without second ones the twists have no derivatives.
    """
    tree = linkage.structure.tree
    none = jnp.zeros((6, first[0].shape[0]))
    twists: dict[str, Twist] = {}
    for part, parent, number, sign in tree:
        step = sign * relative_twist(linkage.joints[number], at.joints[number], first[number], at.scale)
        twists[part] = lax.optimization_barrier(twists.get(parent, none) + step)
    if second is None or not tree:
        return twists, {}
    steps = _changes_in_joints(linkage, at, first, second, twists)
    changes: dict[str, Twist] = {}
    for part, parent, number, sign in tree:
        changes[part] = lax.optimization_barrier(changes.get(parent, none) + sign * steps[number])
    return twists, changes


def _changes_in_joints(
    linkage: Linkage, at: Places, first: Sequence[Array], second: Sequence[Array], twists: dict[str, Twist]
) -> dict[int, Twist]:
    """Compute for each joint of the tree the derivative by time of the twist of part 2 relative to part 1."""
    none = jnp.zeros((6, first[0].shape[0]))
    befores, steps, owners, changes = [], [], [], {}
    for _, _, number, _ in linkage.structure.tree:
        joint, own = linkage.joints[number], at.joints[number]
        units, here, changes[number] = at.scale.of_coordinates(joint), twists.get(joint.parts[0], none), none
        for k, twist, bend in zip(coordinates_of_motions(joint), own.twists, own.bends, strict=True):
            rate = first[number][:, k] / units[k]
            changes[number] = changes[number] + twist * (second[number][:, k] / units[k])
            for j, by_j in bend.items():
                changes[number] = changes[number] + by_j * (first[number][:, j] / units[j]) * rate
            befores.append(here)
            steps.append(twist * rate)
            owners.append(number)
            here = here + steps[-1]
    if steps:
        # all at once: each bracket is three cross products
        brackets = bracket(jnp.stack(befores, axis=1), jnp.stack(steps, axis=1))
        for place, number in enumerate(owners):
            changes[number] = changes[number] + brackets[:, place]
    return changes
