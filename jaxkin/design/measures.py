"""Numbers that judge a motion: transmission angle, stroke; and look-ups of lengths and joints by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import numbers, text
from jaxkin._names import listed, nearest
from jaxkin._traced import traced
from jaxkin.design import given
from jaxkin.dimensions import lengths
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.root import root
from jaxkin.linkage.coordinates import coordinate

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion


STATIC = {"static": True}
"""Of a field that is no number: a program is compiled anew for another value."""
ON_AXIS = 1e-9
"""Distance of a point from an axis, over its distance from the joint of the axis, up to which it is on the axis."""
IN_LINE = 16
"""Sine of the angle between two links up to which they are in line, in roundings: a few of each of their ends."""


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class PartPoint:
    """A point of a part, which may be an extra variable."""

    part: str = field(metadata=STATIC)
    extra: str | None = field(metadata=STATIC)
    """Name of the extra variable; None where the point is given."""
    given: Any
    """Where the point is in the assembled pose; None where it is a variable."""

    def path(self, motion: Motion, extras: Mapping[str, Any]) -> Float[Array, "poses 3"]:
        """Compute where the point is in every pose; (x, y) is in the plane z = 0."""
        if self.extra is None:
            return motion.points(self.part, jnp.asarray(self.given, float))
        return motion.points(self.part, given.extra_point(extras, self.extra, f"the point of {self.part!r}"))


def part_point(part: str, point: Any, what: str) -> PartPoint:
    """Make a point of a part, of its coordinates or of the name of an extra variable; `what` begins messages."""
    text(part, f"{what}: part")
    if isinstance(point, str):
        return PartPoint(part, point, None)
    expected = "finite numbers (x, y, z) or (x, y), or the name of an extra variable"
    found = numbers(point, f"{what}: point", expected)
    if found.shape not in ((2,), (3,)) or not (traced(found) or np.all(np.isfinite(found))):
        raise ValueError(f"{what}: point must be {expected}, got {point!r}")
    return PartPoint(part, None, (jnp if traced(found) else np).append(found, 0.0) if found.shape == (2,) else found)


def transmission_angle(motion: Motion, joint: str, ends: tuple[str, str]) -> Float[Array, " poses"]:
    """Measure the angle at a joint between its two links, 0 to pi, in every pose.

    `ends` names the joint at the other end of either link: in a four-bar with coupler B C and rocker C D it is
    `transmission_angle(motion, "C", ("B", "D"))`. A right angle transmits best; at 0 and pi the linkage jams. At a
    hinge the links are seen along its axis: heights of the joints in a planar linkage do not count, and of a spherical
    one it is the angle between the planes of the two links. At a ball it is the angle in space.
    """
    ends = given.ends(ends, "transmission angle: ends")
    corner, links, held = joint_path(motion, joint), [], set()
    meeting = set(motion.mechanism.joints[joint].parts)
    said = f"links {' and '.join(map(repr, motion.mechanism.joints[joint].parts))} that meet at {joint!r}"
    for end in ends:
        on = meeting & set(motion.mechanism.joints[known_joint(motion, end)].parts)
        if not on:
            raise ValueError(f"joint {end!r} is on neither of the {said}")
        held |= on
        links.append(joint_path(motion, end) - corner)
    if joint in ends or len(held) < 2:
        raise ValueError(f"{ends[0]!r} and {ends[1]!r} must be two other joints, one on each of the {said}")
    axis = _axis_of_turn(motion, joint)
    if axis is not None:
        for number, (end, link) in enumerate(zip(ends, links, strict=True)):
            across = link - jnp.sum(link * axis, axis=-1, keepdims=True) * axis
            if not traced(across) and np.all(np.linalg.norm(across, axis=-1) <= ON_AXIS * np.abs(link).max()):
                raise ValueError(
                    f"the point of joint {end!r} is on the axis of {joint!r}: its link has no direction there; give "
                    f"{end!r} another point of its axis, or name another joint of the same link"
                )
            links[number] = across
    square, lengths = jnp.sum(jnp.cross(*links) ** 2, axis=-1), jnp.sum(links[0] ** 2, -1) * jnp.sum(links[1] ** 2, -1)
    # links in line but for rounding are in line: which side they are on, and with it the slope, would be chance
    in_line = square <= (IN_LINE * jnp.finfo(square.dtype).eps) ** 2 * lengths
    return jnp.arctan2(root(jnp.where(in_line, 0.0, square)), jnp.sum(links[0] * links[1], axis=-1))


def stroke(motion: Motion, joint: str) -> Float[Array, ""]:
    """Measure the stroke of a joint of one coordinate, radians or a length: largest minus smallest of closed poses."""
    values = joint_coordinate(motion, joint)
    inside = motion.closed
    return jnp.max(jnp.where(inside, values, -jnp.inf)) - jnp.min(jnp.where(inside, values, jnp.inf))


def lengths_now(mechanism: Mechanism, keys: Sequence[tuple[str, ...]]):
    """Find the values of lengths by any keys that `with_lengths` knows; ValueError where there is none."""
    # these only: to trace the derivatives of all lengths took a quarter of the time to trace a path problem
    return lengths.lengths_now(mechanism.linkage, keys)


def joint_path(motion: Motion, name: str) -> Float[Array, "poses 3"]:
    """Find where the origin of a joint is in every pose."""
    joint = motion.mechanism.joints[known_joint(motion, name)]
    return motion.points(joint.parts[0], jnp.asarray(joint.frames_1)[0, :3, 3])


def _axis_of_turn(motion: Motion, name: str) -> Float[Array, "poses 3"] | None:
    """Find the unit vector of the one axis about which the parts of a joint turn; None for none or several."""
    joint = motion.mechanism.joints[name]
    turns = {
        element.axis
        for movement in joint.movements
        for element in MOVEMENTS[movement].elements
        if element.kind != "translate"
    }
    if len(joint.movements) != 1 or len(turns) != 1:
        return None
    frame = jnp.asarray(joint.frames_1)[0]
    tip = frame[:3, 3] + frame[:3, turns.pop()]
    return motion.points(joint.parts[0], tip) - motion.points(joint.parts[0], frame[:3, 3])


def joint_coordinate(motion: Motion, name: str) -> Float[Array, " poses"]:
    """Find the displacement of a joint by "joint", where it has one coordinate, or "joint.coordinate"."""
    linkage = motion.mechanism.linkage
    joint, k = coordinate(linkage, name)
    return motion.coordinates[linkage.joints[joint].name][:, k]


def driven_values(motion: Motion, name: str, what: str) -> Float[Array, " poses"]:
    """Find the displacements of a driven coordinate by its name; ValueError where it is not driven.

    `what` begins the message.
    """
    linkage = motion.mechanism.linkage
    if name in motion.inputs:  # also those of targets, which are no joints of the linkage
        return motion.inputs[name]
    joint, k = coordinate(linkage, name)
    full = linkage.joints[joint].full_names[k]
    if full not in motion.inputs:
        raise ValueError(f"{what}: {full!r} is not driven; name what the drive gives, {listed([*motion.inputs])}")
    return motion.inputs[full]


def known_joint(motion: Motion, name: str) -> str:
    """Return the name, if there is such a joint; else ValueError with the nearest."""
    if name not in motion.mechanism.joints:
        raise ValueError(f"there is no joint {name!r}{nearest(name, motion.mechanism.joints)}")
    return name
