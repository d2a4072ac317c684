"""Files that hold a whole mechanism: joints, couplings, limits, unit and notes in JSON, every number in full precision.

Solids are not in the file: a mechanism that was read back computes the same motion, and has no parts to draw.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

from jaxkin._files import check_file, whole
from jaxkin.geometry.units import check_unit
from jaxkin.linkage.record import as_record, from_record
from jaxkin.mechanism.mechanism import Mechanism

MECHANISM_SUFFIX = ".json"

_FORMAT = "jaxkin mechanism"
"""What the file says that it is."""
_VERSION = 1
"""Raised with every change of what is written; files of a later version are refused."""
_LONGEST = 400
"""Letters of what is said about a damaged file."""


def save_mechanism(mechanism: Mechanism, path: str | os.PathLike[str]) -> Path:
    """Write a mechanism into one file (.json), and return its path; the file appears whole or not at all.

    Raises ValueError for another suffix, and inside `jit`, `vmap` and `grad`.
    """
    target = Path(path)
    if target.suffix.lower() != MECHANISM_SUFFIX:
        raise ValueError(f"a mechanism is saved as a {MECHANISM_SUFFIX} file, got {str(target)!r}")
    record = {
        "format": _FORMAT,
        "version": _VERSION,
        "unit": mechanism.unit,
        "linkage": as_record(mechanism.linkage),
        "motors": list(mechanism.motors),
        "history": list(mechanism.history),
        "alignment": list(mechanism.alignment),
    }
    with whole(target) as draft:
        draft.write_text(json.dumps(record, indent=1, allow_nan=False), encoding="utf-8")
    return target


def read_mechanism(path: str | os.PathLike[str]) -> Mechanism:
    """Read a mechanism that `save_mechanism` wrote. Raises ValueError where the file holds none, or a later version."""
    target = Path(path)
    check_file(target, "saved mechanism")
    try:
        record = json.loads(target.read_text(encoding="utf-8"))
        if not isinstance(record, dict) or record.get("format") != _FORMAT:
            raise ValueError(f'it does not say "format": "{_FORMAT}"')
        if record["version"] > _VERSION:
            raise ValueError(f"version {record['version']}, and this jaxkin reads up to {_VERSION}: update jaxkin")
        return Mechanism(
            from_record(record["linkage"]),
            check_unit(record["unit"]),
            history=tuple(record["history"]),
            alignment=tuple(record["alignment"]),
            motors=tuple(record["motors"]),
        )
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        said = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        said = said if len(said) <= _LONGEST else f"{said[:_LONGEST]}..."  # of names without end
        raise ValueError(f"{target.name} is no mechanism that Mechanism.save wrote: {said}") from error
