"""Group poses for the device that a program is made for.

A core of a CPU takes poses in groups whose numbers stay in its cache. Other devices, such as GPUs, take all poses at
once: they compute thousands side by side, and would wait for each group.
"""

from __future__ import annotations

import jax

DEVICE_GROUP = 2**16
"""Largest number of poses that a device that is no CPU computes at once: their Jacobians take some 1e9 bytes."""


def on_cpu() -> bool:
    """Tell whether programs are made for CPUs, by JAX's default device and backend."""
    device = getattr(jax.config, "jax_default_device", None) or jax.default_backend()
    return getattr(device, "platform", device) == "cpu"


def group_for_device(of_cpu: int, of_others: int = DEVICE_GROUP) -> int:
    """Choose how many poses are computed together on a CPU, or on other devices."""
    return of_cpu if on_cpu() else of_others
