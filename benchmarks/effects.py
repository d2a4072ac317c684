"""What each effect costs beside the sweep of 10,000 poses of the four-bar, and of the paper's Fig. 7.

    python benchmarks/effects.py [poses] [name of a case ...]

Whole calls of Python functions, compiled before, as users make them, each in turn with a sweep of the same poses: by
the clock, and by the processor, whose ratio holds on a machine that has other work too. Large sweeps and forces share
the cores, so that the two differ. Rates of parts are computed when they are asked for, and are not in the rates here.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from cases import CASES

import jaxkin as jk

jax.config.update("jax_enable_x64", True)
POSES = 10_000
GRAVITY = (0.0, -9.81, 0.0)
"""In the plane of both, so that the forces are not zero."""
RUNS = 7


def main(poses: int = POSES, *names: str) -> None:
    print(f"{jax.default_backend()}, {poses} poses; times in sweeps\n")
    headings = ("rates", "accel.", "jerk", "static", "inverse dyn.", "reactions", "friction")
    print(f"{'':<26}{'sweep [ms]':>11}" + "".join(f"{each:>{len(each) + 3}}" for each in headings))
    for name in names or ("four-bar", "paper, Fig. 7"):
        make, drive = CASES[name]
        mechanism, inputs = make(), drive(poses)
        moving = [part for part in mechanism.parts if part not in mechanism.fixed]
        masses = jk.masses(mechanism, given={part: jk.Mass(1.0, centre=(0.1, 0.2, 0), inertia=1e-3) for part in moving})
        motion = mechanism.sweep(inputs)
        speeds = dict.fromkeys(motion.inputs, 1.0)
        hinge = next(name for name, joint in mechanism.joints.items() if joint.kind in ("revolute", "cylindrical"))
        rubs = jk.joint_friction(hinge, 0.1, radius=1.0)
        calls = {
            "rates": lambda m=motion, s=speeds: jk.velocities(m, s),
            "accelerations": lambda m=motion, s=speeds: jk.accelerations(m, s),
            "jerks": lambda m=motion, s=speeds: jk.jerks(m, s),
            "static": lambda m=motion, w=masses: jk.drive_forces(m, w, gravity=GRAVITY),
            "inverse dynamics": lambda m=motion, w=masses, s=speeds: jk.drive_forces(m, w, rates=s, gravity=GRAVITY),
            "reactions": lambda m=motion, w=masses, s=speeds: jk.reactions(m, w, rates=s, gravity=GRAVITY),
            "friction in one joint": lambda m=motion, w=masses, s=speeds, f=rubs: jk.drive_forces(
                m, w, rates=s, applied=f, gravity=GRAVITY
            ),
        }
        found, sweeps = [], []
        for call in calls.values():
            times = [
                (_times(lambda m=mechanism, u=inputs: m.sweep(u).displacements), _times(call)) for _ in range(RUNS + 1)
            ]
            sweep, effect = np.median(times[1:], axis=0)  # the first is compiled
            found.append(effect / sweep)
            sweeps.append(sweep)
        for unit, sweep, row in zip(
            ("clock", "processor"), np.median(sweeps, axis=0), np.transpose(found), strict=True
        ):
            cells = "".join(f"{value:>{len(each) + 3}.2f}" for value, each in zip(row, headings, strict=True))
            print(f"{name + ', ' + unit:<26}{1e3 * sweep:>11.2f}{cells}", flush=True)


def _times(call: Callable[[], Any]) -> tuple[float, float]:
    """Seconds that a call takes by the clock, and of the processor."""
    begin, busy = time.perf_counter(), time.process_time()
    jax.block_until_ready(call())
    return time.perf_counter() - begin, time.process_time() - busy


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else POSES, *sys.argv[2:])
