"""Remove file noise from contacts: make axes exactly parallel, perpendicular, coaxial or intersecting that nearly are.

CAD readers round the placements of parts to float32. Axes that are parallel by design then differ by 1e-8 to 1e-7 rad,
and a planar loop of such axes closes exactly in no pose but the assembled one. Axes are compared across all contacts,
since the axes of one loop belong to different contacts. Only what the motion depends on is aligned: of a plane on a
plane the normal but not the height, of a pin in a hole the axis but not the position along it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.movements import MOVEMENTS, symmetry_of
from jaxkin.geometry.pose import cross, frame
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.joints.axes import align_positions
from jaxkin.joints.directions import align_directions

Frames = Float[np.ndarray, "frames 4 4"]

_MAX_ANGLE = 1e-4
"""Largest angle that may count as noise, radians.

It is the default angle tolerance of `Assembly.contacts`: surfaces at larger angles are not in contact at all."""


@dataclass(frozen=True)
class Noise:
    """The largest deviations that count as rounding of the file; larger ones count as design."""

    angle: float
    """Largest angle, radians."""
    length: float
    """Largest distance, in the unit of the contacts."""

    @property
    def size(self) -> float:
        """The lever arm at which a rotation by `angle` moves a point by `length`: about the size of the assembly."""
        return self.length / self.angle

    def with_uncertainty(self, angle: float, length: float) -> Noise:
        """Enlarge the noise so that it covers an uncertainty of angles (radians) and of lengths.

        `angle` and `length` of the result are those of this noise times one factor of at least 1, so that `size` stays;
        the angle of the result is at most `_MAX_ANGLE`, and then an uncertainty may not be covered.
        """
        factor = max(1.0, min(max(angle / self.angle, length / self.length), _MAX_ANGLE / self.angle))
        return Noise(float(factor * self.angle), float(factor * self.length))

    @staticmethod
    def of(contacts: Sequence[Contact]) -> Noise:
        """Estimate the noise that float32 leaves in contacts, times ten for safety.

        Rounding to float32 changes a number by up to 6e-8 of itself. Rounded entries of a rotation matrix turn an axis
        by up to 1e-7 rad, and move points by that times the size of the assembly; a rounded coordinate moves a point by
        6e-8 times its distance from the origin of the world. Deviations by design are 1e-5 rad or more.
        """
        origins = np.concatenate([contact.frames[:, :3, 3] for contact in contacts] or [np.zeros((1, 3))])
        radii = [getattr(surface, "radius", 0.0) for contact in contacts for surface in contact.surfaces]
        size = np.linalg.norm(np.ptp(origins, axis=0)) + max(radii, default=0.0)
        return Noise(1e-6, float(1e-6 * size + 6e-7 * np.abs(origins).max()))


@dataclass(frozen=True, eq=False)
class Regularised:
    """Contacts after the removal of noise, and the largest corrections that were made."""

    contacts: tuple[Contact, ...]
    angle: float
    """Largest correction of a direction, radians."""
    length: float
    """Largest correction of the place of an axis or a centre, in the unit of the contacts."""


def regularise(contacts: Sequence[Contact], noise: Noise) -> Regularised:
    """Align the frames and surfaces of all contacts with each other where they deviate by no more than the noise.

    The fields of a contact other than `frames` and `surfaces` stay as they were found. Up to rounding, a second
    application changes nothing, and contacts that are displaced or scaled together give a result displaced or scaled
    alike.
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
    """Align the z axes and origins of frames with each other as far as their movements depend on them.

    `movements` holds the movement of each frame; its `Movement.aligned` says whether the direction of the z axis, the
    line of the z axis, or the origin is to be aligned. Returns the aligned frames, the largest change of a z axis
    (radians) and the largest displacement of an origin (a length).
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
        aligned[k, :3, :3] = np.stack([x, cross(z[k], x), z[k]], axis=1)
    aligned[:, :3, 3] = origin
    angle = np.linalg.norm(z - frames[:, :3, 2], axis=1).max(initial=0.0)
    length = np.linalg.norm(origin - frames[:, :3, 3], axis=1).max(initial=0.0)
    return aligned, float(angle), float(length)


def _surface_frame(surface: Surface) -> np.ndarray:
    """Make a frame of a surface for the alignment: z along the axis or normal, the origin on it, or at the centre."""
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
