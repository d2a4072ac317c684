"""Write a whole mechanism: joints, couplings, limits, unit, notes and evidence in JSON, all digits of its numbers.

Solids are not in the file: a mechanism that was read back computes the same motion, and has no parts to draw.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

from jaxkin._files import whole
from jaxkin.linkage.evidence_record import of_bond
from jaxkin.linkage.record import as_record

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

MECHANISM_SUFFIX = ".json"

FORMAT = "jaxkin mechanism"
"""What the file says that it is."""
VERSION = 2
"""Raised with every change of what is written; files of a later version are refused."""


def save_mechanism(mechanism: Mechanism, path: str | os.PathLike[str]) -> Path:
    """Write a mechanism into one file (.json), and return its path; the file appears whole or not at all.

    Raises ValueError for another suffix, and inside `jit`, `vmap` and `grad`.
    """
    target = Path(path)
    if target.suffix.lower() != MECHANISM_SUFFIX:
        raise ValueError(f"a mechanism is saved as a {MECHANISM_SUFFIX} file, got {str(target)!r}")
    record = {
        "format": FORMAT,
        "version": VERSION,
        "unit": mechanism.unit,
        "linkage": as_record(mechanism.linkage),
        "motors": list(mechanism.motors),
        "bonds": [of_bond(bond) for bond in mechanism.bonds],
        "history": list(mechanism.history),
        "alignment": list(mechanism.alignment),
    }
    with whole(target) as draft:
        draft.write_text(json.dumps(record, indent=1, allow_nan=False), encoding="utf-8")
    return target
