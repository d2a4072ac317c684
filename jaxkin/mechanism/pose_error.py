"""The error for poses that are off the branch of the assembled pose or beyond limits, with what to do about them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool

from jaxkin._traced import traced
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.joint_limits import breaches, first_within, limit_report
from jaxkin.mobility.infeasible_drive import dead_point
from jaxkin.solve.status import SEVERITY, Status

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion


class PoseError(RuntimeError):
    """Some poses of a motion are not on the branch of the assembled pose, or beyond the limits of a joint.

    `motion` holds them all.
    """

    def __init__(self, motion: Motion) -> None:
        super().__init__(_message(motion))
        self.motion = motion


def check(motion: Motion) -> None:
    """Raise PoseError if a pose is off the branch or beyond limits; ValueError where JAX traces the statuses."""
    if traced(motion.status, motion.displacements):
        raise ValueError(
            "check(), throw=True and solve() without throw=False look at numbers, which JAX traces here: inside jit, "
            "vmap and grad write throw=False and read the status, and check() outside"
        )
    if not np.all(_usable(motion)):
        raise PoseError(motion)


def _usable(motion: Motion) -> Bool[np.ndarray, " poses"]:
    """Tell which poses are on the branch, and within the limits of joints."""
    # numbers of the host: the first comparison of arrays of JAX compiles a program
    usable = np.isin(np.asarray(motion.status), (Status.CLOSED, Status.LIMITED, Status.MISFIT))
    for over in motion.beyond_limits.values():
        usable = usable & (over == 0)
    return usable


def _message(motion: Motion) -> str:
    """Write one line for each status, the worst first: how many poses, the first one with its inputs, the remedy."""
    status, usable = np.asarray(motion.status), _usable(motion)
    wrong, limited = status[~usable], breaches(motion)
    cause = "not on the branch of the assembled pose" + (", or beyond the limits of a joint" if limited else "")
    lines = [f"{len(wrong)} of {len(motion)} poses are {cause}:"]
    for each in reversed(SEVERITY):
        if count := int(np.sum(wrong == each)):
            first = int(np.argmax((status == each) & ~usable))
            inputs = ", ".join(f"{name} = {float(values[first]):.6g}" for name, values in motion.inputs.items())
            where = f"first pose {first}" + (f" ({inputs})" if inputs else "")
            lines.append(f"  {count} {each.name}, {where}: {each.message}")
    linkage = motion.mechanism.linkage
    if Status.STALLED in wrong and (why := dead_point(linkage, [coordinate(linkage, name) for name in motion.inputs])):
        lines.append(f"  {why}")
    lines += [f"  {line}" for line in limit_report(limited, motion.mechanism, motion.inputs, first_within(motion))]
    return "\n".join(lines)
