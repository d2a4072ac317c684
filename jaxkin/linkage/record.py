"""Write a linkage as plain data for files (dicts, lists, texts, numbers), and read it: no digit is lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isinf
from typing import Any

import numpy as np

from jaxkin._arguments import exact_numbers, text
from jaxkin._traced import traced
from jaxkin.geometry.curves import Curve
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import Followed, Patch
from jaxkin.geometry.pose import is_rigid
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint, JointLimits
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import low_and_high
from jaxkin.joints.screws import freedoms
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.evidence_record import evidence_of, of_evidence
from jaxkin.linkage.linkage import Linkage, SpinningPart
from jaxkin.topology.structure import structure

UNREADABLE = (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError, RecursionError)
"""What reading an altered file may raise: words in place of numbers, lists in place of tables, and what is missing."""


def as_record(linkage: Linkage) -> dict[str, Any]:
    """Write a linkage as plain data, which JSON can hold.

    Raises ValueError inside `jit`, `vmap` and `grad`, and for numbers that `from_record` refuses.
    """
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
    """Make a linkage of what `as_record` wrote. Raises one of `UNREADABLE` where it is none."""
    joints = tuple(_joint(each) for each in record["joints"])
    couplings = [_coupling(each) for each in record.get("couplings", [])]
    described = [(joint.name, *joint.parts) for joint in joints]
    found = structure(record["parts"], described, record["fixed"], record.get("chords"))
    ideal = tuple(_joint(each) for each in record.get("ideal", []))
    spinning = tuple(SpinningPart(name, count) for name, count in record.get("spinning", {}).items())
    for each in spinning:
        if each.name not in found.part_names or not isinstance(each.freedoms, int):
            raise ValueError(f"spinning must name parts with their freedoms, got {each.name!r}: {each.freedoms!r}")
    made = coupled(Linkage.of(joints, found), couplings)
    return replace(made.with_joints(joints, ideal), spinning=spinning)


def _coupling(record: Mapping[str, Any]) -> Coupling:
    """Read a coupling that `as_record` wrote."""
    name, names = text(record["name"], "the name of a coupling"), record["coordinates"]
    coefficients = _numbers(record["coefficients"], f"the coefficients of coupling {name!r}", (len(names), None))
    offset, angles = _numbers(record["offset"], f"the offset of coupling {name!r}", ()), record["angles"]
    if not (angles is None or isinstance(angles, bool)):
        raise ValueError(f"angles of coupling {name!r} must be true, false or null, got {angles!r}")
    return Coupling(name, tuple(names), coefficients, offset, angles)


def _of_joint(joint: Joint) -> dict[str, Any]:
    """Write a joint; what is as by default is left out: equal frames of part 2, no pitch, no curves, no limits, and no
    evidence."""
    for side in ("frames_1", "frames_2"):
        _frames(joint.name, joint.movements, side, getattr(joint, side))
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
    if joint.evidence is not None:
        record["evidence"] = of_evidence(joint.evidence)
    return record


def _joint(record: Mapping[str, Any]) -> Joint:
    """Read a joint that `_of_joint` wrote; of files of version 1 the evidence is None."""
    name, movements = text(record["name"], "the name of a joint"), tuple(record["movements"])
    part1, part2 = (text(part, f"a part of joint {name!r}") for part in record["parts"])
    frames_1 = _frames(name, movements, "frames_1", record["frames_1"])
    frames_2 = _frames(name, movements, "frames_2", record["frames_2"]) if "frames_2" in record else frames_1
    curves = tuple(None if each is None else _curve(each) for each in record.get("curves", ()))
    follows = [MOVEMENTS[each].follows for each in movements]
    if [each is not None for each in curves] != (follows if curves or any(follows) else []):
        raise ValueError(f"joint {name!r} must have a curve for each movement that follows one, and for no other")
    return Joint(
        name,
        (part1, part2),
        JointKind(record["kind"]),
        movements,
        frames_1,
        frames_2,
        _numbers(record.get("pitch", 0.0), f"the pitch of joint {name!r}", ()),
        evidence_of(record.get("evidence")),
        _limits(name, movements, record.get("limits", [])),
        curves,
    )


def _limits(name: str, movements: Sequence[str], ends: Sequence[Sequence[float | None]]) -> JointLimits:
    """Read the limits of all coordinates of a joint, or of none; ValueError for others, and where the lower one is not
    the first."""
    limits = tuple(
        low_and_high((-inf if low is None else low, inf if high is None else high), f"the limits of joint {name!r}")
        for low, high in ends
    )
    if len(limits) not in (0, freedoms(movements)):
        raise ValueError(f"joint {name!r} has {freedoms(movements)} coordinates, and limits of {len(limits)}")
    return limits


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
    place, closed = _numbers(record["place"], "the place of a curve", (3,)), record["closed"]
    if not isinstance(closed, list):
        points = _numbers(record["points"], "the points of a curve", (None, 2))
        return Curve(points, _numbers(record["start"], "the start of a curve", ()), place, bool(closed))
    closed_u, closed_v = map(bool, closed)
    points = _numbers(record["points"], "the points of a surface", (None, None, 3))
    height = record.get("height")
    height = None if height is None else _numbers(height, "the height over a surface", ())
    start = _numbers(record["start"], "the start of a surface", (2,))
    return Patch(points, start, place, height, (closed_u, closed_v))


def _frames(name: str, movements: Sequence[str], side: str, given: Any) -> np.ndarray:
    """Return the frames of a joint on one side, one a movement; ValueError where they are no rigid 4x4 poses."""
    what = f"{side} of joint {name!r}"
    found = _numbers(given, what, (len(movements), 4, 4))
    for frame in found:
        if not is_rigid(frame):
            raise ValueError(f"{what} must be rigid 4x4 poses, got {frame.tolist()}")
    return found


def _numbers(given: Any, what: str, shape: tuple[int | None, ...]) -> np.ndarray:
    """Return finite numbers of a shape, None for a length of at least one; ValueError for others."""
    found = exact_numbers(given, what)
    fits = len(found.shape) == len(shape) and all(
        have > 0 if want is None else have == want for have, want in zip(found.shape, shape, strict=True)
    )
    if not fits or not np.isfinite(found).all():
        wanted = " x ".join("n" if want is None else str(want) for want in shape) or "one"
        raise ValueError(f"{what} must be finite numbers, {wanted}, got those of shape {found.shape}")
    return found
