"""Numbers that judge a motion: transmission angle, stroke; and look-ups of lengths and joints by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._names import nearest
from jaxkin.dimensions import lengths
from jaxkin.linkage.coordinates import coordinate

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion


STATIC = {"static": True}
"""Of a field that is no number: a program is compiled anew for another value."""


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
        found = jnp.asarray(self.given if self.extra is None else extras[self.extra], float)
        return motion.points(self.part, jnp.append(found, 0.0) if found.shape == (2,) else found)


def part_point(part: str, point: Any) -> PartPoint:
    """Make a point of a part, of its coordinates or of the name of an extra variable."""
    if isinstance(point, str):
        return PartPoint(part, point, None)
    given = np.asarray(point, float)
    return PartPoint(part, None, np.append(given, 0.0) if given.shape == (2,) else given)


def transmission_angle(motion: Motion, joint: str, ends: tuple[str, str]) -> Float[Array, " poses"]:
    """Measure the angle at a joint between its two links, 0 to pi, in every pose.

    `ends` names the joint at the other end of either link: in a four-bar with coupler B C and rocker C D it is
    `transmission_angle(motion, "C", ("B", "D"))`. A right angle transmits best; at 0 and pi the linkage jams.
    """
    corner, links = joint_path(motion, joint), []
    for end in ends:
        common = set(motion.mechanism.joints[known_joint(motion, end)].parts)
        if not common & set(motion.mechanism.joints[joint].parts):
            parts = " and ".join(map(repr, motion.mechanism.joints[joint].parts))
            raise ValueError(f"joint {end!r} is on neither of the links {parts} that meet at {joint!r}")
        links.append(joint_path(motion, end) - corner)
    cross = jnp.linalg.norm(jnp.cross(*links) + 1e-300, axis=-1)
    return jnp.arctan2(cross, jnp.sum(links[0] * links[1], axis=-1))


def stroke(motion: Motion, joint: str) -> Float[Array, ""]:
    """Measure the stroke of a joint of one coordinate, radians or a length: largest minus smallest of closed poses."""
    values = joint_coordinate(motion, joint)
    inside = motion.closed
    return jnp.max(jnp.where(inside, values, -jnp.inf)) - jnp.min(jnp.where(inside, values, jnp.inf))


def length_now(mechanism: Mechanism, key: tuple[str, ...]):
    """Find the value of a length by any key that `with_lengths` knows; ValueError where there is none."""
    # this one only: to trace the derivatives of all lengths took a quarter of the time to trace a path problem
    return lengths.length_now(mechanism.linkage, key)


def joint_path(motion: Motion, name: str) -> Float[Array, "poses 3"]:
    """Find where the origin of a joint is in every pose."""
    joint = motion.mechanism.joints[known_joint(motion, name)]
    return motion.points(joint.parts[0], jnp.asarray(joint.frames_1)[0, :3, 3])


def joint_coordinate(motion: Motion, name: str) -> Float[Array, " poses"]:
    """Find the displacement of a joint by "joint", where it has one coordinate, or "joint.coordinate"."""
    linkage = motion.mechanism.linkage
    joint, k = coordinate(linkage, name)
    return motion.coordinates[linkage.joints[joint].name][:, k]


def known_joint(motion: Motion, name: str) -> str:
    """Return the name, if there is such a joint; else ValueError with the nearest."""
    if name not in motion.mechanism.joints:
        raise ValueError(f"there is no joint {name!r}{nearest(name, motion.mechanism.joints)}")
    return name


def as_rows(values, what: str, width: int) -> np.ndarray:
    """Convert numbers to an array (rows, width); ValueError naming what they are for."""
    array = np.asarray(values, float)
    if array.ndim != 2 or array.shape[1] != width or not np.all(np.isfinite(array)):
        raise ValueError(f"{what} must be finite numbers of shape (poses, {width}), got shape {array.shape}")
    return array
