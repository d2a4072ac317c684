"""The gravity of robot files, which mechanisms do not keep: forces are computed with that which they are given."""

from __future__ import annotations

import numpy as np

from jaxkin.effects.forces.acting import STANDARD_GRAVITY
from jaxkin.io.robot_model import numbers

CLOSE = 0.01
"""Metres per second squared by which a gravity may differ from the standard one: files write 9.8, 9.81, 9.80665."""


def gravity_notes(file: str, text: str | None) -> tuple[str, ...]:
    """Write a note where the gravity that a file says, three numbers in m/s^2, is not the standard one."""
    said = numbers(text, 3, f"{file}: gravity", STANDARD_GRAVITY)
    if np.abs(said - STANDARD_GRAVITY).max() <= CLOSE:
        return ()
    given = ", ".join(f"{each:g}" for each in said)
    return (f"{file}: its gravity is not kept: give forces gravity=({given}), in a study [effects] gravity",)
