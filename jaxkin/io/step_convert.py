"""STEP to binary glTF by cascadio, in a process of its own: on a damaged file its native code prints, or crashes."""

from __future__ import annotations

import json
import re
import tempfile
import warnings
from pathlib import Path

from jaxkin.io.apart import run_apart

TESSELLATION = {"tol_linear": 0.01, "tol_relative": True, "tol_angular": 0.2}
"""Sag over edge length, radians a chord. Surfaces are exact, only the outlines of faces follow the triangles."""

SECONDS = 300
"""For one file; hundreds of solids take some ten."""

MEMORY = 16 << 30
"""Bytes of address space for the reader, most of it never used."""

_TOLD = 3
"""Damages of a file that are told."""


def convert(data: bytes, name: str) -> bytes:
    """The binary glTF of the bytes of a STEP file; `name` is what messages call it.

    Raises ValueError with what the reader said if it cannot be read; warns if entities of the file are damaged.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.step", Path(folder) / "out.glb"
        source.write_bytes(data)
        options = json.dumps(TESSELLATION)
        status, said = run_apart("step_worker.py", source, target, options, name=name, seconds=SECONDS, memory=MEMORY)
        glb = target.read_bytes() if target.exists() else b""
    if "Traceback" in said and "MemoryError" not in said:
        raise RuntimeError(f"cascadio could not be run: {said.strip().splitlines()[-1]}")
    if status not in (0, 1) or "MemoryError" in said:  # 1: an exception of Python, seen above
        raise ValueError(
            f"{name}: the reader of STEP files crashed on it: it is damaged, or asks for more than "
            f"{MEMORY / 2**30:.3g} GB of memory; export it again, or part by part"
        )
    found = list(dict.fromkeys(re.findall(r"\*+ ERR \w+ : ([^*\n]*)", said)))
    damage = "; ".join(text.strip() for text in found[:_TOLD]) + (" and more" if len(found) > _TOLD else "")
    if not glb:
        raise ValueError(f"{name} cannot be read as STEP: {damage or 'no shapes in it'}; export it again")
    if damage:
        warnings.warn(f"{name} is damaged ({damage}): parts or faces may be missing; export it again", stacklevel=2)
    return glb
