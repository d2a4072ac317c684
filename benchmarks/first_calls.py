"""What the first call of each effect costs, most of which is compiled: seconds of the processor, and programs.

    python benchmarks/first_calls.py [name of an effect ...]

Each in turn in this process, of 361 poses of the four-bar or of what it needs, without JAX's persistent cache.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import timing  # noqa: F401  puts the closed forms on the path
from jax import monitoring

import jaxkin as jk
from reference.mechanisms import planar_fourbar

jax.config.update("jax_enable_x64", True)
TURN = np.linspace(0.0, 2 * np.pi, 361)
GRAVITY = (0.0, -9.81, 0.0)
AT = (60.0, 40.0, 0.0)
"""A point of the coupler, millimetres."""


def main(*names: str) -> None:
    programs: list[float] = []

    def listen(event: str, duration_secs: float, **_: str | int) -> None:
        if event.endswith("backend_compile_duration"):
            programs.append(duration_secs)

    monitoring.register_event_duration_secs_listener(listen)
    print(f"{'':<24}{'first [s]':>10}{'programs':>10}{'again [ms]':>12}")
    for name, call in calls().items():
        if names and name not in names:
            continue
        programs.clear()
        first = _seconds(call)
        count, again = len(programs), min(_seconds(call) for _ in range(3))
        print(f"{name:<24}{first:>10.2f}{count:>10}{1e3 * again:>12.1f}", flush=True)


def calls() -> dict[str, Callable[[], Any]]:
    mechanism = planar_fourbar()
    moving = [part for part in mechanism.parts if part not in mechanism.fixed]
    masses = jk.masses(mechanism, given={part: jk.Mass(1.0, centre=(0.1, 0.2, 0), inertia=1e-3) for part in moving})
    lengths = [key for key, value in mechanism.lengths.items() if float(value) > 0]
    motion = mechanism.sweep({"A": TURN})
    target = motion.points("coupler", AT)[::12] + jnp.array([3.0, 2.0, 0.0])

    def loss(motion):
        return jnp.mean((motion.points("coupler", AT) - target) ** 2)

    def measure(motion):
        return jnp.max(motion.points("coupler", AT)[:, 0])

    rates = {"A": 1.0}
    return {
        "sweep": lambda: mechanism.sweep({"A": TURN}).displacements,
        "points": lambda: motion.points("coupler", AT),
        "sigma_min": lambda: mechanism.sweep({"A": TURN}).sigma_min,
        "velocities": lambda: jk.velocities(motion, rates).points("coupler", AT),
        "accelerations": lambda: jk.accelerations(motion, rates).points("coupler", AT),
        "screw axes": lambda: jk.screw_axes(jk.velocities(motion, rates), "coupler").point,
        "static torque": lambda: jk.drive_forces(motion, masses, gravity=GRAVITY).forces,
        "reactions": lambda: jk.reactions(motion, masses, gravity=GRAVITY, rates=rates).forces,
        "reactions, printed": lambda: str(jk.reactions(motion, masses, gravity=GRAVITY, rates=rates)),
        "transmission": lambda: jk.transmission(motion, "D").angle,
        "coupler curve": lambda: jk.coupler_curve(motion, "coupler", AT).points,
        "limits": lambda: jk.limits(mechanism, "A").full_turn,
        "assembly modes": lambda: len(jk.assembly_modes(mechanism, {"A": 0.3})),
        "gradient": lambda: jax.grad(lambda x: loss(mechanism.with_lengths({lengths[0]: x}).sweep({"A": TURN[::12]})))(
            float(mechanism.lengths[lengths[0]])
        ),
        "tolerances": lambda: (
            jk.tolerances(
                mechanism, dict.fromkeys(lengths, 0.01), measure, drive={"A": TURN[::12]}, samples=1000
            ).nominal
        ),
        "optimize": lambda: (
            jk.optimize(
                loss,
                mechanism,
                drive={"A": TURN[::12]},
                lengths={
                    key: (0.9 * float(mechanism.lengths[key]), 1.1 * float(mechanism.lengths[key])) for key in lengths
                },
            ).value
        ),
        "calibrate": lambda: (
            jk.calibrate(
                mechanism,
                {"A": TURN[:20]},
                {jk.point("coupler", AT): motion.points("coupler", AT)[:20]},
                lengths=lengths[:2],
            ).deviation
        ),
    }


def _seconds(call: Callable[[], Any]) -> float:
    """Seconds of the processor that a call takes."""
    begin = time.process_time()
    jax.block_until_ready(call())
    return time.process_time() - begin


if __name__ == "__main__":
    main(*sys.argv[1:])
