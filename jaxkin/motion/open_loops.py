"""Tell which loops of a mechanism are open in the given pose, by how much, and where (host code)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.traced import traced
from jaxkin.joints.screws import chain
from jaxkin.motion.closed_loops import ClosedLoops, Row
from jaxkin.topology.names import listed

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism


@dataclass(frozen=True)
class Opening:
    """The loop that is open the most."""

    residual: float
    """Square root of Eq. 12 of all loops of its structure element, lengths over the characteristic length."""
    parts: tuple[str, ...]
    """The parts of the loop, in order of travel."""
    joints: tuple[str, ...]
    """Its joints."""
    length: float
    """How far its two ends are apart, in the unit of the mechanism."""
    angle: float
    """The angle between them, radians."""
    joint: str
    """The joint of the loop whose frames on its two parts are the farthest apart in the given pose."""
    unit: str

    def __str__(self) -> str:
        gap = f"{self.length:.2g} {self.unit}".rstrip()
        return (
            f"the loop over {listed(self.joints)} is open by {gap} and {self.angle:.2g} rad, most of all at joint "
            f"{self.joint!r}"
        )


def opening(mechanism: Mechanism) -> Opening | None:
    """The loop that is open the most in the given pose; None where all close to rounding, or where JAX traces."""
    return None if traced(mechanism) else _most(mechanism, closed=False)


def stays_open(mechanism: Mechanism) -> Opening | None:
    """The loop that stays open the most when Newton's method closes them from the given pose."""
    return _most(mechanism, closed=True)


def check_closed(mechanism: Mechanism, what: str, call: str) -> None:
    """Refuse to tell something of a pose that is open: ValueError with its size, and how to close it."""
    if (found := opening(mechanism)) is not None:
        raise ValueError(
            f"{what} cannot be told of a pose that is not closed: {found}; close it first, mechanism.close() says how "
            f"far parts have to move for that, and write mechanism.close().mechanism.{call}"
        )


def _most(mechanism: Mechanism, closed: bool) -> Opening | None:
    worst: Opening | None = None
    for block in mechanism.structure.blocks:
        loops = ClosedLoops(mechanism, block)
        q = np.zeros(len(loops.columns))
        if (found := loops.travel(q)).gap <= loops.noise.closed:
            continue
        if closed:
            q, found = loops.closed(q)
        if found.gap > loops.noise.closed and (worst is None or found.gap > worst.residual):
            worst = _opening(mechanism, loops, q, found.gap)
    return worst


def _opening(mechanism: Mechanism, loops: ClosedLoops, q: Row, gap: float) -> Opening:
    misfits = loops.travel(q).residual.reshape(-1, 6)
    loop = loops.block.loops[int(np.argmax(np.linalg.norm(misfits, axis=1)))]
    twist = misfits[int(np.argmax(np.linalg.norm(misfits, axis=1)))]
    joints = [mechanism.all_joints[joint] for joint, _ in loop]
    apart = []
    for joint, _ in loop:
        names, before, after, pitch = loops.chains[joint]
        zero = np.zeros(mechanism.all_joints[joint].freedoms)
        apart.append(float(np.abs(chain(names, before, zero, pitch, after)[0] - np.eye(4)).max()))
    return Opening(
        residual=gap,
        parts=tuple(dict.fromkeys(part for joint in joints for part in joint.parts)),
        joints=tuple(joint.name for joint in joints),
        length=float(np.linalg.norm(twist[3:])) * loops.length,
        angle=float(np.arcsin(min(1.0, float(np.linalg.norm(twist[:3]))))),
        joint=joints[int(np.argmax(apart))].name,
        unit=mechanism.unit,
    )
