"""Whether two bodies turn about an axis, or slide along it, by a joint that was inferred or by their exact contacts."""

from __future__ import annotations

import numpy as np

from jaxkin.assembly.inference.bores import NEAR_ANGLE, NEAR_LENGTH, Bore
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.stop_faces import ACROSS
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Cylinder, Plane, Surface
from jaxkin.joints.kinds import JointKind

TURNING = (JointKind.REVOLUTE, JointKind.CYLINDRICAL)
SLIDING = (JointKind.PRISMATIC, JointKind.CYLINDRICAL)


def moves(known: Known, one: str, other: str, axis: Bore, *, turning: bool) -> bool:
    """Tell whether two bodies turn about an axis, or slide along it, on each other: by an inferred joint, or else by
    exact contacts, all of which let them."""
    body, owners = known.body, {one, other}
    for joint in (each.joint for each in known.found if each.joint):
        if {body[part] for part in joint.parts} == owners:
            place = np.asarray(joint.frames_1[0])
            along = _along(place[:3, 2], axis) and (not turning or _is_on(place[:3, 3], axis))
            return bool(along and joint.kind in (TURNING if turning else SLIDING))
    touching = [each for each in known.contacts if {body[part] for part in each.parts} == owners]
    faces = [each.surfaces[0] for each in touching]
    if turning:
        round_ones = any(isinstance(face, Cylinder) for face in faces)
        return round_ones and all(_turns(face, axis) for face in faces)
    return all(_slides(face, axis) for face in faces) and _guide(faces)


def _along(direction: Vector, axis: Bore) -> bool:
    return bool(np.linalg.norm(np.cross(direction, axis.axis)) <= NEAR_ANGLE)


def _is_on(point: Vector, axis: Bore) -> bool:
    return bool(np.linalg.norm(np.cross(point - axis.point, axis.axis)) <= NEAR_LENGTH * axis.radius)


def _turns(face: Surface, axis: Bore) -> bool:
    """Tell whether a face lets what touches it turn about an axis: it is round about that, or a plane across it."""
    if isinstance(face, Cylinder):
        return _along(face.axis, axis) and _is_on(face.point, axis)
    return isinstance(face, Plane) and _along(face.normal, axis)


def _slides(face: Surface, axis: Bore) -> bool:
    """Tell whether a face lets what touches it slide along an axis."""
    if isinstance(face, Cylinder):
        return _along(face.axis, axis)
    return isinstance(face, Plane) and abs(float(face.normal @ axis.axis)) < ACROSS


def _guide(faces: list[Surface]) -> bool:
    """Tell whether faces that let parts slide along an axis guide them there: one is round, or two planes differ."""
    normals = [face.normal for face in faces if isinstance(face, Plane)]
    return len(normals) < len(faces) or any(np.linalg.norm(np.cross(each, normals[0])) > ACROSS for each in normals)
