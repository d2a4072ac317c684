"""A joint: a chain of the paper's movements between two parts (Table 2).

The displacement of part 2 relative to part 1, in world coordinates, is the product over the frames of the chain of
`frames_1[i] T_i frames_2[i]^-1`. At the assembled pose `frames_1 == frames_2`, and the joint is the paper's
`M_i^-1 T_i M_i`. A frame is stored twice since its two copies move with different parts: a link length changes one of
them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import text
from jaxkin._pytree import register_leaves
from jaxkin._traced import traced
from jaxkin.contacts.states import CONTACT_STATES, ContactState
from jaxkin.geometry.curves import Spline
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import BicubicSpline, Followed
from jaxkin.joints.evidence import BY_HAND, Evidence
from jaxkin.joints.kinds import JointKind

JointCoordinate = tuple[int, int]
"""(joint, coordinate): the number of a joint in `Linkage.joints`, and that of one of its `coordinates`. A pair (joint,
sign) is no such thing, but a step of a walk: see `jaxkin.topology.graph`."""

JointLimits = tuple[tuple[float, float], ...]
"""For each coordinate of a joint its lowest and highest displacement from the assembled pose, radians or lengths in the
unit of the mechanism, -inf and inf where it has none; empty where no coordinate has limits."""

_CONTACT_STATES = {(JointKind.of_state(state.letter), state.movements): state for state in CONTACT_STATES}
"""(kind, movements) -> contact state. The movements distinguish a contact on a circle, (j) and (n), from the contact at
a point with the same letter."""


@dataclass(frozen=True, eq=False, repr=False)
class Joint:
    """A joint between two parts. It is a pytree: frames, pitch and the numbers of curves are leaves, all else but
    `evidence` is static."""

    name: str
    parts: tuple[str, str]
    kind: JointKind
    """"revolute", "prismatic", ..., or "contact b" for a contact state of the paper."""
    movements: tuple[str, ...]
    """Keys of `MOVEMENTS`, one a frame."""
    frames_1: Float[Array | np.ndarray, "*batch frames 4 4"]
    """Pose of each frame on the side of part 1, in world coordinates of the assembled pose."""
    frames_2: Float[Array | np.ndarray, "*batch frames 4 4"]
    """Pose of each frame on the side of part 2; equal to `frames_1` unless lengths were changed."""
    pitch: Float[Array | np.ndarray, "*batch"]
    """Advance per turn of a screw, in the unit of the mechanism; zero for all others."""
    evidence: Evidence | None = None
    """What the joint is known from; None after JAX has flattened and rebuilt the joint."""
    limits: JointLimits = ()
    """Limits of the coordinates, as they were given or read: see `JointLimits`. Poses beyond them are computed too."""
    curves: tuple[Followed | None, ...] = ()
    """For each movement the curve or the surface that it follows, None for others; empty where none follows
    one."""

    def __repr__(self) -> str:
        return f"<{getattr(self.kind, 'value', self.kind)} joint {self.name!r}: {' - '.join(self.parts)}>"

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates of the joint; a name that occurs twice in its chain is numbered: phi1, phi2."""
        names = [name for movement in self.movements for name in MOVEMENTS[movement].coordinates]
        seen: Counter[str] = Counter()
        result = []
        for name in names:
            seen[name] += 1
            result.append(f"{name}{seen[name]}" if names.count(name) > 1 else name)
        return tuple(result)

    @property
    def full_names(self) -> tuple[str, ...]:
        """Full names "joint.coordinate" of the coordinates, as inputs and results name them; in the same order."""
        return tuple(f"{self.name}.{coordinate}" for coordinate in self.coordinates)

    @property
    def driven_together(self) -> tuple[tuple[int, ...], ...]:
        """Indices of the coordinates in tuples that belong together: the angles of a ball are one turn."""
        groups: list[tuple[int, ...]] = []
        for movement in self.movements:
            first = sum(map(len, groups))
            here = range(first, first + len(MOVEMENTS[movement].coordinates))
            groups += [tuple(here)] if MOVEMENTS[movement].ball else [(index,) for index in here]
        return tuple(groups)

    @cached_property
    def splines(self) -> tuple[Spline | BicubicSpline | None, ...]:
        """For each movement the spline that it follows, computed on the host; None for movements that follow none."""
        curves = self.curves or (None,) * len(self.movements)
        return tuple(None if curve is None else curve.spline() for curve in curves)

    @property
    def coincides(self) -> bool:
        """Whether the joint is closed as assembled: the same frames on both parts, and each curve begins in its frame.

        Numbers only; it is not where lengths or profiles were changed.
        """
        begun = all(spline is None or spline.begins_at_contact for spline in self.splines)
        return begun and bool(np.array_equal(self.frames_1, self.frames_2))

    @property
    def contact_state(self) -> ContactState | None:
        """The contact state (Tables 1 and 2) of the joint; None for a joint that is no contact state."""
        return _CONTACT_STATES.get((self.kind, self.movements))

    @property
    def freedoms(self) -> int:
        """Number of coordinates."""
        return len(self.coordinates)


register_leaves(
    Joint,
    leaves=("frames_1", "frames_2", "pitch", "curves"),
    static=("name", "parts", "kind", "movements", "limits"),
)


def joint(
    name: str,
    parts: tuple[str, str],
    kind: JointKind,
    movements: tuple[str, ...],
    frames: Sequence[Array | np.ndarray] | Array | np.ndarray,
    pitch: float | int | Array | np.ndarray = 0.0,
    evidence: Evidence = BY_HAND,
    limits: JointLimits = (),
    curves: tuple[Followed | None, ...] = (),
) -> Joint:
    """Make a joint whose frames coincide on both parts: the paper's form, closed at the assembled pose.

    `frames` are 4x4 poses in world coordinates at the assembled pose, one for each movement; `pitch` is the advance per
    turn of a screw. Numbers stay float64 on the host until JAX computes with them; traced numbers stay traced.
    """
    text(name, "the name of a joint")
    for part in parts:
        text(part, f"a part of joint {name!r}")
    xp = jnp if traced(frames, pitch) else np
    poses = xp.stack([xp.asarray(frame, dtype=float) for frame in frames]).reshape(-1, 4, 4)
    return Joint(name, parts, kind, movements, poses, poses, xp.asarray(pitch, dtype=float), evidence, limits, curves)


def shifted(given: Joint, q: Float[np.ndarray, " freedoms"]) -> Joint:
    """Count the limits of a joint from its displacement `q`, where its new assembled pose is."""
    limits = tuple((low - by, high - by) for (low, high), by in zip(given.limits, map(float, q), strict=False))
    return replace(given, limits=limits)


def check_joints(given: Any) -> tuple[Joint, ...]:
    """Return the joints of a list of joints; ValueError says what was given in place of one."""
    joints = ()
    if isinstance(given, Joint):
        wrong = f"the joint {given.name!r} alone"
    elif not isinstance(given, Iterable):
        wrong = repr(given)
    else:
        joints = tuple(given)
        wrong = next((f"{each!r} among them" for each in joints if not isinstance(each, Joint)), None)
    if wrong:
        raise ValueError(f"joints must be a list of joints, such as [jk.revolute(...)], got {wrong}")
    return joints
