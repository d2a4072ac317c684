"""The gallery of hard cases: tests run through it, and `benchmarks/hard_cases.py` prints it as a table."""

from __future__ import annotations

from reference.hard_case import HardCase
from reference.hard_freedoms import IDLE, INPUTS, OVERCONSTRAINED
from reference.hard_numbers import NEARLY, SINGLE_PRECISION, SIZES
from reference.hard_rounded import ROUNDED
from reference.hard_singular import CHANGE_POINTS, LIMITS, NEAR_CHANGE_POINTS

CASES: tuple[HardCase, ...] = (
    *CHANGE_POINTS,
    *NEAR_CHANGE_POINTS,
    *LIMITS,
    *OVERCONSTRAINED,
    *IDLE,
    *INPUTS,
    *NEARLY,
    *SIZES,
    *SINGLE_PRECISION,
    *ROUNDED,
)
