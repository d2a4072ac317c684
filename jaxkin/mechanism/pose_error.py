"""The error for poses that are not on the branch of the assembled pose, with what to do about them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jaxkin._traced import traced
from jaxkin.solve.status import SEVERITY, Status

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion


class PoseError(RuntimeError):
    """Some poses of a motion are not on the branch of the assembled pose. `motion` holds them all."""

    def __init__(self, motion: Motion) -> None:
        super().__init__(_message(motion))
        self.motion = motion


def check(motion: Motion) -> None:
    """Raise PoseError if a pose is not on the branch; ValueError where JAX traces the statuses."""
    if traced(motion.status):
        raise ValueError(
            "throw=True and check() look at numbers, which JAX traces here: inside jit, vmap and grad read "
            "motion.status, and write check() outside"
        )
    # numbers of the host: the first comparison of arrays of JAX compiles a program
    if not np.isin(np.asarray(motion.status), (Status.CLOSED, Status.MISFIT)).all():
        raise PoseError(motion)


def _message(motion: Motion) -> str:
    """Write one line for each status, the worst first: how many poses, the first one with its inputs, the remedy."""
    status, on_branch = np.asarray(motion.status), np.asarray(motion.on_branch)
    off_branch = status[~on_branch]
    lines = [f"{len(off_branch)} of {len(motion)} poses are not on the branch of the assembled pose:"]
    for each in reversed(SEVERITY):
        if count := int(np.sum(off_branch == each)):
            first = int(np.argmax(status == each))
            inputs = ", ".join(f"{name} = {float(values[first]):.6g}" for name, values in motion.inputs.items())
            where = f"first pose {first}" + (f" ({inputs})" if inputs else "")
            lines.append(f"  {count} {each.name}, {where}: {each.message}")
    return "\n".join(lines)
