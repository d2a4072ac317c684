"""What `--drive` says: which joint, and the range of its displacements in degrees or in the unit of the file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.motions import is_length

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism

_HELP = "write JOINT=START:STOP:COUNT, as in ground-crank=0:360:361, or JOINT=VALUE,VALUE,..."


def parse_drives(options: Iterable[str]) -> dict[str, Float[np.ndarray, " poses"]]:
    """Displacements by name as they were written, one option each: "crank=0:360:361" or "crank=0,10,25".

    Raises ValueError for an option that cannot be read, and for a name given twice.
    """
    drives: dict[str, Float[np.ndarray, " poses"]] = {}
    for option in options:
        name, equals, values = option.rpartition("=")
        if not equals or not name:
            raise ValueError(f"--drive {option}: {_HELP}")
        if name in drives:
            raise ValueError(f"--drive {option}: {name} was given a range already; give each joint coordinate once")
        drives[name] = _values(option, values)
    return drives


def to_radians(
    mechanism: Mechanism, drives: Mapping[str, Float[np.ndarray, " poses"]]
) -> dict[str, Float[np.ndarray, " poses"]]:
    """The drives by the full names of their coordinates, angles turned from degrees into radians."""
    from jaxkin.motion.drive import resolve

    if not drives:
        names = ", ".join(f"{joint.name}.{c}" for joint in mechanism.all_joints for c in joint.coordinates)
        raise ValueError(f"nothing is driven: give --drive once or more, {_HELP}; there are {names}")
    names = resolve(mechanism, drives)
    return {
        name: values if is_length(name.rpartition(".")[2]) else np.deg2rad(values)
        for name, values in zip(names, drives.values(), strict=True)
    }


def _values(option: str, text: str) -> Float[np.ndarray, " poses"]:
    try:
        if ":" not in text:
            return np.array([float(value) for value in text.split(",")])
        start, stop, count = text.split(":")
        start, stop, count = float(start), float(stop), int(count)
    except ValueError:
        raise ValueError(f"--drive {option}: cannot read {text!r} as a range; {_HELP}") from None
    if count < 1:
        raise ValueError(f"--drive {option}: COUNT must be 1 or more, got {count}; {_HELP}")
    return np.linspace(start, stop, count)
