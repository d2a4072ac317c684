"""Cranks whose shaft is not drawn: what turns idly on its pins, with a round face on one axis with the fixed parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.inference.bores import NEAR_ANGLE, Bore
from jaxkin.joints import pairs
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.open_loops import opening

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def told_shafts(
    mechanism: Mechanism, bores: Mapping[str, Sequence[Bore]], tried: Callable[[Joint], Mechanism]
) -> list[str]:
    """Tell of parts that turn idly between others where their shaft would be: a round face of them is on one axis with
    one of the fixed parts, beside the hinges that they turn on and parallel to these.

    Nothing drawn says that they turn there, so that it is no inference. `tried` makes the mechanism with a joint more:
    the line is told only where that leaves useful freedoms, and these parts no idle turn.
    """
    result = []
    fixed = [bore for part in mechanism.fixed for bore in bores.get(part, ())]
    if not fixed or opening(mechanism.linkage, mechanism.unit) is not None:
        return []  # an open pose has no mobility of its own
    for motion in mechanism.mobility().idle_motions:
        hinges = [each for each in mechanism.all_joints if {*each.parts} & {*motion.parts} and each.freedoms]
        if any(each.kind is not JointKind.REVOLUTE or {*each.parts} & {*mechanism.fixed} for each in hinges):
            continue
        if (found := _shaft([bore for part in motion.parts for bore in bores.get(part, ())], fixed, hinges)) is None:
            continue
        own, host = found
        name = f"{host.part}-{own.part}"
        more = tried(pairs.revolute(name, host.part, own.part, point=own.point, axis=own.axis)).mobility()
        if more.useful and not any({*each.parts} & {*motion.parts} for each in more.idle_motions):
            point, axis = (np.round(each, 6).tolist() for each in (own.point, own.axis))
            freedoms = "one useful freedom" if more.useful == 1 else f"{more.useful} useful freedoms"
            text = f"{motion}, and nothing else holds it; {own.part!r} and {host.part!r} have round faces on one axis: "
            text += f"if it turns there on a shaft that is not drawn, say joints=[jk.revolute({name!r}, {host.part!r}, "
            result.append(text + f"{own.part!r}, point={point}, axis={axis})], which leaves {freedoms}")
    return result


def _shaft(own: Sequence[Bore], fixed: Sequence[Bore], hinges: Sequence[Joint]) -> tuple[Bore, Bore] | None:
    """Find round faces of a body and of the fixed parts on one axis that is parallel to all hinges, and on none."""
    axes = [(pose[:3, 3], pose[:3, 2]) for pose in (np.asarray(each.frames_1, float)[0] for each in hinges)]
    for bore in own:
        tilts = [np.linalg.norm(np.cross(axis, bore.axis)) for _, axis in axes]
        away = [np.linalg.norm(np.cross(point - bore.point, bore.axis)) for point, _ in axes]
        if max(tilts) <= NEAR_ANGLE and min(away) > bore.radius / 2:
            for other in fixed:
                if other.on_axis_of(bore):
                    return bore, other
    return None
