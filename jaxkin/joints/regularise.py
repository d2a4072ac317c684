"""Remove the noise of files from contacts: axes that are parallel, perpendicular, coaxial or meet do so exactly.

Readers pass the placements of parts through float32. Axes that are parallel by design arrive 1e-8 to 1e-7 rad apart,
and a planar loop of such axes closes exactly only in the pose that was read. Relations are looked for among all
contacts together, since the axes of one loop belong to different contacts. Only that is aligned which the motion
depends on: of a face on a face its normal and not its height, of a pin its axis and not the place along it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.movements import MOVEMENTS, symmetry_of
from jaxkin.geometry.pose import frame
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.joints.axes import align_positions
from jaxkin.joints.directions import align_directions

Frames = Float[np.ndarray, "frames 4 4"]

_MAX_ANGLE = 1e-4
"""Largest angle that counts as noise, radians: the default angle tolerance of `Assembly.contacts`, since surfaces that
are farther apart are not in contact."""


@dataclass(frozen=True)
class Noise:
    """The largest deviations that count as the noise of a file and not as design."""

    angle: float
    """Radians."""
    length: float
    """In the unit of the contacts."""

    @property
    def size(self) -> float:
        """The length over which angle and length are equivalent: the size of the assembly."""
        return self.length / self.angle

    def with_uncertainty(self, angle: float, length: float) -> Noise:
        """Enlarge this noise to given uncertainties of angles (radians) and lengths, up to `_MAX_ANGLE` of the angle.

        Both entries grow by one factor, so that `size` stays.
        """
        factor = max(1.0, min(max(angle / self.angle, length / self.length), _MAX_ANGLE / self.angle))
        return Noise(float(factor * self.angle), float(factor * self.length))

    @staticmethod
    def of(contacts: Sequence[Contact]) -> Noise:
        """Return ten times the noise of single precision for contacts of this size.

        Rounding to float32 changes a number by up to 6e-8 of itself: an entry of a rotation matrix (1e-7 rad in all),
        or a coordinate, which grows with the distance of the assembly from the origin. Design deviates by 1e-5 or more.
        """
        origins = np.concatenate([contact.frames[:, :3, 3] for contact in contacts] or [np.zeros((1, 3))])
        radii = [getattr(surface, "radius", 0.0) for contact in contacts for surface in contact.surfaces]
        size = np.linalg.norm(np.ptp(origins, axis=0)) + max(radii, default=0.0)
        return Noise(1e-6, float(1e-6 * size + 6e-7 * np.abs(origins).max()))


@dataclass(frozen=True, eq=False)
class Regularised:
    """Contacts without noise, and the largest corrections that this took."""

    contacts: tuple[Contact, ...]
    angle: float
    """Largest correction of a direction, radians."""
    length: float
    """Largest correction of the place of an axis or a centre, in the unit of the contacts."""


def regularise(contacts: Sequence[Contact], noise: Noise) -> Regularised:
    """Align the frames and surfaces of all contacts with each other; their centres and misfits stay as they were found.

    A second application changes nothing, and the result moves and scales with the input, both up to rounding.
    """
    names = [name for contact in contacts for name in movements(contact)]
    names += [symmetry_of(surface.kind) for contact in contacts for surface in contact.surfaces]
    given = [pose for contact in contacts for pose in contact.frames]
    given += [_surface_frame(surface) for contact in contacts for surface in contact.surfaces]
    frames = np.array(given, float).reshape(-1, 4, 4)
    aligned, angle, length = align(names, frames, noise)
    rest = iter(aligned)
    placed = [replace(contact, frames=np.array([next(rest) for _ in contact.frames])) for contact in contacts]
    placed = [replace(contact, surfaces=tuple(_placed(s, next(rest)) for s in contact.surfaces)) for contact in placed]
    return Regularised(tuple(placed), angle, length)


def movements(contact: Contact) -> tuple[str, ...]:
    """Look up the movement of each frame of a contact (Table 2)."""
    return contact.contact_state.movements


def align(movements: Sequence[str], frames: Frames, noise: Noise) -> tuple[Frames, float, float]:
    """Align frames with each other in what their movements depend on (`Movement.aligned`).

    Returns the frames, and the largest change of a direction (radians) and of a place (length).
    """
    has_axis, has_direction, has_centre = (
        np.array([what in MOVEMENTS[name].aligned for name in movements], bool)
        for what in ("axis", "direction", "centre")
    )
    z, origin = frames[:, :3, 2].copy(), frames[:, :3, 3].copy()
    z[has_direction] = align_directions(z[has_direction], noise.angle)
    origin[has_axis], origin[has_centre] = align_positions(
        origin[has_axis], z[has_axis], origin[has_centre], noise.length
    )
    aligned = frames.copy()
    for k in np.flatnonzero(has_direction):
        # the columns are set one by one: normalising z again could change its last bit
        x = frames[k, :3, 0] - (frames[k, :3, 0] @ z[k]) * z[k]
        x /= np.linalg.norm(x)
        aligned[k, :3, :3] = np.stack([x, np.cross(z[k], x), z[k]], axis=1)
    aligned[:, :3, 3] = origin
    angle = np.linalg.norm(z - frames[:, :3, 2], axis=1).max(initial=0.0)
    length = np.linalg.norm(origin - frames[:, :3, 3], axis=1).max(initial=0.0)
    return aligned, float(angle), float(length)


def _surface_frame(surface: Surface) -> np.ndarray:
    """Make the frame of a surface that takes part in the alignment: z along its axis or normal."""
    match surface:
        case Plane():
            return frame(surface.point, surface.normal)
        case Cylinder():
            return frame(surface.point, surface.axis)
        case Cone():
            return frame(surface.apex, surface.axis)
        case Sphere():
            return frame(surface.centre, np.array([0.0, 0.0, 1.0]))


def _placed(surface: Surface, pose: np.ndarray) -> Surface:
    """Move a surface to its aligned frame."""
    origin, z = pose[:3, 3].copy(), pose[:3, 2].copy()
    match surface:
        case Plane():
            return replace(surface, point=origin, normal=z)
        case Cylinder():
            return replace(surface, point=origin, axis=z)
        case Cone():
            return replace(surface, apex=origin, axis=z)
        case Sphere():
            return replace(surface, centre=origin)
