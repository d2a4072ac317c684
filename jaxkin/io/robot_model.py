"""What the file of a robot says: links with their shapes, and joints given by a frame on each of two links.

Each format has a reader that makes a `RobotModel` of it; `jaxkin.io.robots` makes an assembly of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.pose import Transform, rotation
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import JointLimits
from jaxkin.joints.kinds import JointKind

WORLD = "world"
"""Name of the part that stands for the ground, in the formats that have such a name."""

UNLIMITED = 1e9
"""Radians or metres from which on the end of a range is none: formats that know no infinity write such numbers."""


@dataclass(frozen=True, eq=False)
class LinkShape:
    """One solid of a link."""

    pose: Transform
    """From the frame of the solid to that of the link, metres."""
    kind: str
    """"box", "sphere", "cylinder", "capsule" (along z, about the origin), or "mesh"."""
    size: tuple[float, ...] = ()
    """Metres: of a box its three edges, of a sphere its radius, or three of them along its axes, else radius and
    length; of a mesh its three scales."""
    file: str = ""
    """Of a mesh, as the robot file names it."""
    corners: np.ndarray | None = None
    """Triangles (n, 3, 3) of a mesh that the robot file holds itself, metres before its scales."""
    reference: Transform | None = None
    """Of a mesh: the frame of the solid, in that of its file, before its scales; None where they are one."""


class Weighed(NamedTuple):
    """What one solid of a link weighs."""

    shape: LinkShape
    amount: float
    """Its mass in kilograms, or its density in kilograms per cubic metre."""
    is_mass: bool


@dataclass(frozen=True, eq=False)
class RobotLink:
    """A rigid link at the zero of the file."""

    name: str
    pose: Transform
    """From the link to the world, metres."""
    shapes: tuple[LinkShape, ...] = ()
    """What is seen of it."""
    collisions: tuple[LinkShape, ...] = ()
    """What it collides with: drawn where nothing that is seen of it can be read."""
    inertial: Inertial | None = None
    """In the frame of the link, metres; None where the file says nothing of its mass."""
    weighed: tuple[Weighed, ...] = ()
    """The solids whose masses are that of the link, where `inertial` is None and the file says what they weigh."""


@dataclass(frozen=True, eq=False)
class RobotJoint:
    """A joint between two links. Its two frames coincide where the zero of the file closes the loop that it is in."""

    name: str
    parts: tuple[str, str]
    kind: JointKind
    frame_1: Transform
    """On the first link, in the world at the zero of the file, metres; the axis is z. A universal joint turns in the
    first link about y, and the second link on it about x."""
    frame_2: Transform
    """On the second link."""
    text: str
    """What the file calls it, such as "<joint name='hip'>"."""
    limits: JointLimits = ()
    """Counted from the zero of the file."""
    values: tuple[float, ...] = ()
    """What the file calls its coordinates at the zero; empty where that is zero too."""
    pitch: float = 0.0
    """Metres a turn, of a screw."""
    turn: tuple[Transform, Transform] | None = None
    """Of a joint of constant angle the frames, on the first and on the second link, of its turn about the axis of the
    second one, which follows the slides and the turn of the two frames above; None for all others."""

    @property
    def frames_1(self) -> Float[np.ndarray, "frames 4 4"]:
        """The frames on the first link, one a movement."""
        return np.stack([self.frame_1] if self.turn is None else [self.frame_1, self.turn[0]])

    @property
    def frames_2(self) -> Float[np.ndarray, "frames 4 4"]:
        """The frames on the second link."""
        return np.stack([self.frame_2] if self.turn is None else [self.frame_2, self.turn[1]])


@dataclass(frozen=True, eq=False)
class RobotModel:
    """What one robot file says."""

    links: tuple[RobotLink, ...]
    joints: tuple[RobotJoint, ...]
    fixed: tuple[str, ...]
    """Links at rest."""
    motors: tuple[str, ...] = ()
    """Names of the actuated joints."""
    notes: tuple[str, ...] = ()
    """What was not understood or taken otherwise, a line each, with the element of the file."""
    couplings: tuple[Coupling, ...] = ()
    """Between coordinates of the joints, counted from where the file calls them zero."""
    unit: str = "m"
    """Unit of all lengths; "" where the format says none."""


LARGEST = 1e30
"""Largest size of a number that files of robots may have: squares of squares of it are numbers yet."""


def numbers(text: str | None, count: int, where: str, default: Sequence[float] | None = None) -> np.ndarray:
    """Read finite numbers that blanks separate, up to `LARGEST`; `default` where there is no text.

    Raises ValueError for other texts, and for more or fewer numbers.
    """
    if text is None and default is not None:
        return np.array(default, float)
    try:
        found = np.array((text or "").replace("_", "?").split(), float)  # Python reads 1_0 as ten
    except ValueError:
        found = np.empty(0)
    if len(found) != count or not np.all(np.abs(found) <= LARGEST):
        raise ValueError(f"{where}: expected {count} finite number{'s' if count > 1 else ''}, got {text!r}")
    return found


def limit(text: str | None, where: str, none: float) -> float:
    """Read a limit, a number that may be infinite; `none` where there is no text."""
    try:
        found = none if text is None else float(text)
    except ValueError:
        found = np.nan
    if np.isnan(found):
        raise ValueError(f"{where}: expected a number, got {text!r}")
    return found


def limits_between(low: float, high: float) -> JointLimits:
    """Make the limits of one coordinate; none where neither end is below `UNLIMITED`."""
    low, high = (-np.inf if low <= -UNLIMITED else low), (np.inf if high >= UNLIMITED else high)
    return ((low, high),) if np.isfinite([low, high]).any() else ()


def direction(vector: np.ndarray, where: str) -> np.ndarray:
    """Divide a vector by its length; ValueError for zero."""
    size = float(np.abs(vector).max())
    if size == 0.0:
        raise ValueError(f"{where}: expected the direction of an axis, got the zero vector")
    vector = vector / size  # squares of large numbers would overflow
    return vector / np.linalg.norm(vector)


def placed(turn: np.ndarray, point: Sequence[float] | np.ndarray) -> Transform:
    """Make a pose of a rotation matrix (3, 3) and a point."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, point
    return pose


def roll_pitch_yaw(angles: Sequence[float] | np.ndarray) -> np.ndarray:
    """Make the rotation Rz(yaw) Ry(pitch) Rx(roll): fixed axes, as URDF and SDF have them, radians."""
    x, y, z = np.eye(3)
    return rotation(z, angles[2]) @ rotation(y, angles[1]) @ rotation(x, angles[0])


def quaternion(wxyz: Sequence[float] | np.ndarray, where: str) -> np.ndarray:
    """Make the rotation matrix of a quaternion (w, x, y, z) of any length but zero."""
    w, *xyz = direction(np.asarray(wxyz, float), where)
    sine = float(np.linalg.norm(xyz))
    return np.eye(3) if sine == 0.0 else rotation(np.array(xyz) / sine, 2.0 * np.arctan2(sine, w))


def along(axis: np.ndarray) -> np.ndarray:
    """Make the least rotation that turns the z axis into a unit vector."""
    z = np.array([0.0, 0.0, 1.0])
    across = np.cross(z, axis)
    sine, cosine = float(np.linalg.norm(across)), float(axis[2])
    if sine < np.finfo(float).eps:
        return np.eye(3) if cosine > 0 else np.diag([1.0, -1.0, -1.0])
    return rotation(across / sine, np.arctan2(sine, cosine))


def tag(element: Element) -> str:
    """Tell an element of a file with its name, for messages."""
    name = element.get("name")
    return f"<{element.tag}>" if name is None else f"<{element.tag} name={name!r}>"


def unknown_parts(element: Element, known: Sequence[str], where: str) -> list[str]:
    """Write notes on the elements inside one that are not among the `known` tags, one for each tag."""
    others: dict[str, list[Element]] = {}
    for each in element:
        if each.tag not in known:
            others.setdefault(each.tag, []).append(each)
    return [
        f"{where}: {tag(found[0])}{f' and {len(found) - 1} more' if len(found) > 1 else ''} is not understood; left out"
        for found in others.values()
    ]
