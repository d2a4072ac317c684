"""Tell which loops of a mechanism are open in the given pose, or cannot be closed from there, by how much, and where
(host code)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.geometry.pose import apply, turned_by
from jaxkin.joints.screws import complement, freedoms
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.host_closure import ClosedLoops, LoopCoordinates, Travel, closure_twist
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import loop_freedoms


@dataclass(frozen=True)
class Opening:
    """The loop that is open the most."""

    residual: float
    """Square root of Eq. 12 of all loops of its loop group, lengths over the characteristic length."""
    parts: tuple[str, ...]
    """The parts of the loop, in order of travel."""
    joints: tuple[str, ...]
    """Names of the joints of the loop, in order of travel."""
    length: float
    """Distance between the two ends of the loop at `joint`, in the unit of the mechanism."""
    angle: float
    """Angle between the two ends of the loop, radians."""
    joint: str
    """The joint of the loop whose frames on its two parts are the farthest apart in the given pose."""
    unit: str
    """Name of the unit of length."""
    coupling: str = ""
    """The coupling that is off more than any loop is open, by `angle` (with lengths over the characteristic length);
    empty where a loop is open the most. Then `joint` is its last one."""

    def __str__(self) -> str:
        if self.coupling:
            return f"the coupling {self.coupling!r} of {listed(self.joints)} is off by {self.angle:.2g}"
        gap = f"{self.length:.2g} {self.unit}".rstrip()
        return (
            f"the loop over {listed(self.joints)} is open by {gap} and {self.angle:.2g} rad, most of all at joint "
            f"{self.joint!r}"
        )


def opening(linkage: Linkage, unit: str = "") -> Opening | None:
    """Find the loop that is open the most in the given pose; None where all loops close or JAX traces the linkage."""
    if traced(linkage):
        return None
    worst: Opening | None = None
    for loop_group in linkage.structure.loop_groups:
        loops = closed_loops(linkage, loop_group)
        at_rest = np.zeros(len(loops.columns))
        if loops.coincide or (norm := loops.travel(at_rest).residual_norm) <= loops.thresholds.residual:
            continue
        if worst is None or norm > worst.residual:
            worst = tell_opening(linkage, unit, loops, at_rest)
    return worst


def left_open(linkage: Linkage, unit: str = "") -> Opening | None:
    """Find the loop that stays open the most where the loops are closed from the given pose.

    None where all close, so that what the mechanism can do is known, in the given pose or with new lengths beside it;
    and where JAX traces the linkage, whose numbers cannot be looked at.
    """
    still_open = [] if traced(linkage) else [each for each in loop_freedoms(linkage) if not each.closes]
    if not still_open:
        return None
    worst = max(still_open, key=lambda each: each.home.travel.residual_norm)
    return tell_opening(linkage, unit, closed_loops(linkage, worst.loop_group), worst.home.q)


def check_assembles(linkage: Linkage, unit: str, what: str, call: str) -> None:
    """Raise ValueError if loops cannot be closed from the given pose, with the size of what is `left_open`.

    `what` names the result that cannot be computed then, and `call` is the call that computes it, with `{}` in place of
    the mechanism.
    """
    if (found := left_open(linkage, unit)) is None:
        return
    raise ValueError(
        f"{what} cannot be told of a mechanism that cannot be assembled: where its loops are the least open, {found}; "
        "give it lengths with which they close, as with_lengths does, or let mechanism.close() try from other poses: "
        f"where that closes them, write {call.replace('{}', 'mechanism.close().mechanism')}"
    )


def tell_opening(linkage: Linkage, unit: str, loops: ClosedLoops, q: LoopCoordinates) -> Opening:
    """Find the loop of a loop group that is open the most at scaled coordinates `q`, and its worst joint.

    Or the coupling, where one is off by more than the residual of any loop.
    """
    found = loops.travel(q)
    loop_gaps = np.linalg.norm(found.left_open - np.eye(4), axis=(1, 2))
    if np.abs(found.coupling_residual).max(initial=0.0) > loop_gaps.max(initial=0.0):
        return _off_coupling(linkage, unit, loops, found)
    number = int(np.argmax(loop_gaps))
    loop, left = loops.loop_group.loops[number], found.left_open[number]
    joint = max((joint for joint, _ in loop), key=lambda joint: _misfit(loops, joint))
    place = apply(found.places[loops.ends[joint][0]], loops.chains[joint].frames_1[0, :3, 3])
    joints = [linkage.joints[index] for index, _ in loop]
    return Opening(
        residual=found.residual_norm,
        parts=tuple(dict.fromkeys(part for joint in joints for part in joint.parts)),
        joints=tuple(joint.name for joint in joints),
        length=float(np.linalg.norm(apply(left, place) - place)) * loops.length,
        angle=turned_by(left),
        joint=linkage.joints[joint].name,
        unit=unit,
    )


def _off_coupling(linkage: Linkage, unit: str, loops: ClosedLoops, found: Travel) -> Opening:
    """Tell of the coupling that is off the most."""
    worst = int(np.argmax(np.abs(found.coupling_residual)))
    number = loops.loop_group.couplings[worst]
    joints = [joint for joint in linkage.joints if joint.name in linkage.structure.coupled[number]]
    return Opening(
        residual=found.residual_norm,
        parts=tuple(dict.fromkeys(part for joint in joints for part in joint.parts)),
        joints=tuple(joint.name for joint in joints),
        length=0.0,
        angle=float(abs(found.coupling_residual[worst])),
        joint=linkage.structure.coupled[number][-1],
        unit=unit,
        coupling=linkage.couplings[number].name,
    )


def _misfit(loops: ClosedLoops, joint: int) -> tuple[float, float]:
    """Measure the distance between the frames of a joint on its two parts, as they are given.

    The first number counts only what the joint forbids (zero if below the closure residual), the second one everything.
    """
    apart, screws = loops.chains[joint].displaced(np.zeros(freedoms(loops.chains[joint].movements)))
    twist = np.array(closure_twist(apart))
    forbidden = float(np.linalg.norm(complement(screws) @ twist)) if screws.size else float(np.linalg.norm(twist))
    return forbidden if forbidden > loops.thresholds.residual else 0.0, float(np.linalg.norm(apart - np.eye(4)))
