"""Read the files of whole mechanisms that `Mechanism.save` wrote (`mechanism_file`)."""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from jaxkin._arguments import text
from jaxkin._files import check_file
from jaxkin.geometry.units import check_unit
from jaxkin.io.mechanism_file import FORMAT, VERSION
from jaxkin.joints.evidence import Bond
from jaxkin.linkage.coordinates import coordinates
from jaxkin.linkage.evidence_record import bond_of
from jaxkin.linkage.record import UNREADABLE, from_record
from jaxkin.mechanism.mechanism import Mechanism

_LONGEST = 400
"""Letters of what is said about a damaged file."""


def read_mechanism(path: str | os.PathLike[str]) -> Mechanism:
    """Read a mechanism that `save_mechanism` wrote. Raises ValueError where the file holds none, or a later version."""
    target = Path(path)
    check_file(target, "saved mechanism")
    try:
        record = json.loads(target.read_text(encoding="utf-8-sig"))  # editors of Windows write a mark
        if not isinstance(record, dict) or record.get("format") != FORMAT:
            raise ValueError(f'it does not say "format": "{FORMAT}"')
        if not isinstance(record["version"], int):
            raise ValueError(f"its version must be a whole number, got {record['version']!r}")
        if record["version"] > VERSION:
            raise ValueError(f"version {record['version']}, and this jaxkin reads up to {VERSION}: update jaxkin")
        linkage, motors = from_record(record["linkage"]), _texts(record, "motors")
        if motors:
            coordinates(linkage, motors)  # refuses those that are not there
        return Mechanism(
            linkage,
            check_unit(record["unit"]),
            history=_texts(record, "history"),
            alignment=_texts(record, "alignment"),
            bonds=tuple(_bond(each, linkage.parts) for each in record.get("bonds", [])),
            motors=motors,
        )
    except UNREADABLE as error:
        said = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        said = said if len(said) <= _LONGEST else f"{said[:_LONGEST]}..."  # of names without end
        raise ValueError(f"{target.name} is no mechanism that Mechanism.save wrote: {said}") from error


def _texts(record: Mapping[str, Any], key: str) -> tuple[str, ...]:
    """Read a list of texts."""
    if not isinstance(record[key], list):
        raise ValueError(f"{key} must be a list of texts, got {record[key]!r}")
    return tuple(text(each, f"each of {key}") for each in record[key])


def _bond(record: Mapping[str, Any], parts: Collection[str]) -> Bond:
    """Read parts that move as one; ValueError for parts that are not there."""
    bond = bond_of(record)
    if unknown := [part for part in bond.parts if part not in parts]:
        raise ValueError(f"a bond names the unknown part {unknown[0]!r}")
    return bond
