"""Read the files of whole mechanisms that `Mechanism.save` wrote (`mechanism_file`)."""

from __future__ import annotations

import json
import os
from pathlib import Path

from jaxkin._files import check_file
from jaxkin.geometry.units import check_unit
from jaxkin.io.mechanism_file import FORMAT, VERSION
from jaxkin.linkage.record import from_record
from jaxkin.mechanism.mechanism import Mechanism

_LONGEST = 400
"""Letters of what is said about a damaged file."""


def read_mechanism(path: str | os.PathLike[str]) -> Mechanism:
    """Read a mechanism that `save_mechanism` wrote. Raises ValueError where the file holds none, or a later version."""
    target = Path(path)
    check_file(target, "saved mechanism")
    try:
        record = json.loads(target.read_text(encoding="utf-8"))
        if not isinstance(record, dict) or record.get("format") != FORMAT:
            raise ValueError(f'it does not say "format": "{FORMAT}"')
        if record["version"] > VERSION:
            raise ValueError(f"version {record['version']}, and this jaxkin reads up to {VERSION}: update jaxkin")
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
