"""Contacts of surfaces for the tests of joints: frames by Table 1, from surfaces as a reader would give them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jaxkin.contacts.contact import Contact
from jaxkin.contacts.frames import contact_frames
from jaxkin.contacts.states import find_state
from jaxkin.geometry.pose import apply, rotation, unit
from jaxkin.geometry.surfaces import Cylinder, Plane, Sphere, Surface

X, Y, Z = np.eye(3)


def touching(parts, state: str, s1: Surface, s2: Surface, at=(0.0, 0.0, 0.0), region: str | None = None) -> Contact:
    """The contact that the detection would report, but for the names of the faces."""
    row, at = find_state(state, region), np.asarray(at, float)
    frames = contact_frames(row, s1, s2, row.touch(s1, s2, at), at)
    return Contact(parts, ("face 1", "face 2"), state, row.region, frames, (s1, s2), at, 0.0)


def moved(contact: Contact, poses: dict[str, np.ndarray], scale: float = 1.0) -> Contact:
    """The contact of the parts displaced one by one, then scaled; the frames are built anew."""
    surfaces = [scaled(s.moved(poses[part]), scale) for s, part in zip(contact.surfaces, contact.parts, strict=True)]
    at = apply(poses[contact.parts[0]], contact.centre) * scale
    return touching(contact.parts, contact.state, *surfaces, at, contact.region)


def gap(contact: Contact, displacement: np.ndarray) -> float:
    """How far the surfaces are from their contact when surface 2 is displaced: lengths and radians added."""
    state = find_state(contact.state, contact.region)
    touch = state.touch(contact.surfaces[0], contact.surfaces[1].moved(displacement), contact.centre)
    return np.inf if touch is None else abs(touch.gap) + abs(touch.tilt)


def scaled(surface: Surface, scale: float) -> Surface:
    names = [name for name in ("point", "apex", "centre", "radius") if hasattr(surface, name)]
    return replace(surface, **{name: getattr(surface, name) * scale for name in names})


def vector(v) -> np.ndarray:
    return np.asarray(v, float)


def face(at, normal, parts=("p", "q")) -> Contact:
    """State (a)."""
    n = unit(vector(normal))
    return touching(parts, "a", Plane(vector(at), n), Plane(vector(at), -n), at)


def pin(at, axis, radius=3.0, parts=("p", "q")) -> Contact:
    """State (e): part 1 holds the hole."""
    a = unit(vector(axis))
    return touching(parts, "e", Cylinder(vector(at), a, radius, -1), Cylinder(vector(at), a, radius, 1), at)


def ball(at, radius=4.0, parts=("p", "q")) -> Contact:
    """State (o): part 1 holds the socket."""
    return touching(parts, "o", Sphere(vector(at), radius, -1), Sphere(vector(at), radius, 1), at)


def roller(at, normal, axis, radius=3.0, parts=("p", "q")) -> Contact:
    """State (b): a plane of part 1 that bears at `at` a cylinder of part 2."""
    n, at = unit(vector(normal)), vector(at)
    return touching(parts, "b", Plane(at, n), Cylinder(at + radius * n, unit(vector(axis)), radius, 1), at)


def tip(at, normal, radius=3.0, parts=("p", "q")) -> Contact:
    """State (d): a plane of part 1 that bears at `at` a ball of part 2."""
    n, at = unit(vector(normal)), vector(at)
    return touching(parts, "d", Plane(at, n), Sphere(at + radius * n, radius, 1), at)


def displacement(rng: np.random.Generator, angle: float, length: float) -> np.ndarray:
    """About a random axis through the origin by up to `angle`, and by a random vector of up to `length`."""
    pose = np.eye(4)
    pose[:3, :3] = rotation(unit(rng.normal(size=3)), angle * rng.uniform(0.3, 1.0))
    pose[:3, 3] = length * rng.uniform(0.3, 1.0) * unit(rng.normal(size=3))
    return pose


def placed(contacts, rng: np.random.Generator, scale: float = 1.0, noise: float = 0.0, size: float = 100.0) -> list:
    """All contacts in an arbitrary pose and unit; then each part off by `noise` (radians, and of the size)."""
    parts = sorted({part for contact in contacts for part in contact.parts})
    place = displacement(rng, 3.0, size)
    poses = {part: displacement(rng, noise, noise * size) @ place for part in parts}
    return [moved(contact, poses, scale) for contact in contacts]
