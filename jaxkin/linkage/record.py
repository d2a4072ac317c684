"""Write a linkage as plain data for files (dicts, lists, texts, numbers), and read it: no digit is lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isinf
from typing import Any

import numpy as np

from jaxkin._traced import traced
from jaxkin.geometry.curves import Curve
from jaxkin.geometry.patches import Followed, Patch
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.linkage import Linkage, SpinningPart
from jaxkin.topology.structure import structure


def as_record(linkage: Linkage) -> dict[str, Any]:
    """Write a linkage as plain data, which JSON can hold; ValueError inside `jit`, `vmap` and `grad`."""
    if traced(linkage):
        raise ValueError("a mechanism whose numbers are traced by JAX cannot be saved: save it outside of jit and grad")
    found = linkage.structure
    record: dict[str, Any] = {
        "parts": list(found.part_names),
        "fixed": list(found.fixed),
        "joints": [_of_joint(joint) for joint in linkage.joints],
    }
    if found.chords is not None:
        record["chords"] = list(found.chords)
    if linkage.couplings:
        record["couplings"] = [
            {
                "name": coupling.name,
                "coordinates": list(coupling.coordinates),
                "coefficients": np.asarray(coupling.coefficients, float).tolist(),
                "offset": float(coupling.offset),
                "angles": coupling.angles,
            }
            for coupling in linkage.couplings
        ]
    if linkage.ideal:
        record["ideal"] = [_of_joint(joint) for joint in linkage.ideal]
    if linkage.spinning:
        record["spinning"] = {part.name: part.freedoms for part in linkage.spinning}
    return record


def from_record(record: Mapping[str, Any]) -> Linkage:
    """Make a linkage of what `as_record` wrote. Raises KeyError, TypeError or ValueError where it is none."""
    joints = tuple(_joint(each) for each in record["joints"])
    couplings = [
        Coupling(
            each["name"],
            tuple(each["coordinates"]),
            np.asarray(each["coefficients"], float),
            np.asarray(each["offset"], float),
            each["angles"],
        )
        for each in record.get("couplings", [])
    ]
    described = [(joint.name, *joint.parts) for joint in joints]
    found = structure(record["parts"], described, record["fixed"], record.get("chords"))
    ideal = tuple(_joint(each) for each in record.get("ideal", []))
    spinning = tuple(SpinningPart(name, freedoms) for name, freedoms in record.get("spinning", {}).items())
    made = coupled(Linkage.of(joints, found), couplings)
    return replace(made.with_joints(joints, ideal), spinning=spinning)


def _of_joint(joint: Joint) -> dict[str, Any]:
    """Write a joint; what is as by default is left out: equal frames of part 2, no pitch, no curves, no limits."""
    record: dict[str, Any] = {
        "name": joint.name,
        "parts": list(joint.parts),
        "kind": str(joint.kind),
        "movements": list(joint.movements),
        "frames_1": np.asarray(joint.frames_1, float).tolist(),
    }
    if not np.array_equal(joint.frames_1, joint.frames_2):
        record["frames_2"] = np.asarray(joint.frames_2, float).tolist()
    if pitch := float(joint.pitch):
        record["pitch"] = pitch
    if joint.curves:
        record["curves"] = [None if curve is None else _of_curve(curve) for curve in joint.curves]
    if joint.limits:  # JSON has no infinity
        record["limits"] = [[None if isinf(end) else end for end in ends] for ends in joint.limits]
    return record


def _joint(record: Mapping[str, Any]) -> Joint:
    """Read a joint that `_of_joint` wrote; its evidence is not in the record, and None."""
    frames_1 = _frames(record, "frames_1")
    limits = tuple(
        (-inf if low is None else float(low), inf if high is None else float(high))
        for low, high in record.get("limits", ())
    )
    part1, part2 = record["parts"]
    return Joint(
        record["name"],
        (part1, part2),
        JointKind(record["kind"]),
        tuple(record["movements"]),
        frames_1,
        _frames(record, "frames_2") if "frames_2" in record else frames_1,
        np.asarray(record.get("pitch", 0.0), float),
        limits=limits,
        curves=tuple(None if each is None else _curve(each) for each in record.get("curves", ())),
    )


def _of_curve(curve: Followed) -> dict[str, Any]:
    """Write a curve or a surface that a joint follows: its points, and where the assembled pose is on it."""
    found: dict[str, Any] = {
        "points": np.asarray(curve.points, float).tolist(),
        "start": np.asarray(curve.start, float).tolist(),
        "place": np.asarray(curve.place, float).tolist(),
        "closed": curve.closed,
    }
    if isinstance(curve, Patch):
        found["closed"] = list(curve.closed)
        if curve.height is not None:
            found["height"] = float(curve.height)
    return found


def _curve(record: Mapping[str, Any]) -> Followed:
    """Read a curve; a surface is closed, or not, in two directions."""
    place, closed = np.asarray(record["place"], float).reshape(3), record["closed"]
    points, start = np.asarray(record["points"], float), np.asarray(record["start"], float)
    if not isinstance(closed, list):
        return Curve(points.reshape(-1, 2), start.reshape(()), place, bool(closed))
    closed_u, closed_v = map(bool, closed)
    height = record.get("height")
    height = None if height is None else np.asarray(height, float).reshape(())
    return Patch(points.reshape(len(points), -1, 3), start.reshape(2), place, height, (closed_u, closed_v))


def _frames(record: Mapping[str, Any], side: str) -> np.ndarray:
    """Read the frames of a joint on one side, one a movement; ValueError where they are no finite 4x4 poses."""
    found = np.asarray(record[side], float).reshape(-1, 4, 4)
    if len(found) != len(record["movements"]) or not np.isfinite(found).all():
        raise ValueError(
            f"joint {record['name']!r}: {side} must hold one finite 4x4 pose for each of its "
            f"{len(record['movements'])} movements, got shape {np.shape(record[side])}"
        )
    return found
