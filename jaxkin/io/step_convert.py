"""STEP to binary glTF by cascadio, in a process of its own: on a damaged file its native code prints, or crashes."""

from __future__ import annotations

import json
import re
import tempfile
from pathlib import Path

from jaxkin.io.sandbox import run_apart
from jaxkin.io.time_limit import TimeLimit

TESSELLATION = {"tol_linear": 0.01, "tol_relative": True, "tol_angular": 0.2}
"""Sag over edge length, radians a chord. Surfaces are exact, only the outlines of faces follow the triangles."""

STEP_MEMORY = 4 << 30
"""Bytes of address space for the reader of every file, most of it never used: 0.4 GB, and 8 MB for each core."""

MEMORY_PER_BYTE = 200
"""Bytes more for each byte of the file; real assemblies take 30 to 80."""

_TOLD_DAMAGES = 3
"""Damages of a file that are told."""


def convert(data: bytes, limit: TimeLimit) -> tuple[bytes, list[str]]:
    """Make the binary glTF of the bytes of a STEP file, and what the reader said about damages.

    Raises ValueError with what the reader said if it cannot be read within the limit.
    """
    name, memory = limit.name, STEP_MEMORY + MEMORY_PER_BYTE * len(data)
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.step", Path(folder) / "out.glb"
        source.write_bytes(data)
        options = json.dumps(TESSELLATION)
        status, said = run_apart("step_worker.py", source, target, options, folder=folder, limit=limit, memory=memory)
        glb = target.read_bytes() if target.exists() else b""
    if "Traceback" in said and "MemoryError" not in said:
        raise RuntimeError(f"cascadio could not be run: {said.strip().splitlines()[-1]}")
    if status not in (0, 1) or "MemoryError" in said:  # 1: an exception of Python, seen above
        raise ValueError(
            f"{name}: the reader of STEP files crashed on it: it is damaged, or asks for more than "
            f"{memory / 2**30:.3g} GB of memory; export it again, or part by part"
        )
    found = list(dict.fromkeys(re.findall(r"\*+ ERR \w+ : ([^*\n]*)", said)))
    damages = [" ".join(text.split()) for text in found[:_TOLD_DAMAGES]] + ["and more"] * (len(found) > _TOLD_DAMAGES)
    if not glb:
        raise ValueError(f"{name} cannot be read as STEP: {'; '.join(damages) or 'no shapes in it'}; export it again")
    return glb, damages
