"""STEP to binary glTF by cascadio, in a process of its own: on a damaged file its native code prints, or crashes."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

TESSELLATION = {"tol_linear": 0.01, "tol_relative": True, "tol_angular": 0.2}
"""Sag over edge length, radians a chord. Surfaces are exact, only the outlines of faces follow the triangles."""

# trimesh, which cascadio imports for a loader that is not used here, takes longer to import than most files to convert
_SCRIPT = """
import sys
sys.modules["trimesh"] = None
try:
    import resource
    resource.setrlimit(resource.RLIMIT_AS, ({memory}, {memory}))
except (ImportError, ValueError):  # not on every system
    pass
import cascadio
cascadio.step_to_glb(sys.argv[1], sys.argv[2], include_brep=True, **{tessellation})
"""


SECONDS = 300
"""For one file; hundreds of solids take some ten."""

MEMORY = 16 << 30
"""Bytes of address space for the reader, most of it never used."""


def convert(data: bytes, name: str) -> bytes:
    """The binary glTF of the bytes of a STEP file; `name` is what messages call it.

    Raises ValueError with what the reader said if it cannot be read; warns if entities of the file are damaged.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.step", Path(folder) / "out.glb"
        source.write_bytes(data)
        script = _SCRIPT.format(tessellation=TESSELLATION, memory=MEMORY)
        command = [sys.executable, "-P", "-c", script, str(source), str(target)]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", check=False, timeout=SECONDS
            )
        except subprocess.TimeoutExpired:
            raise ValueError(
                f"{name} was not read within {SECONDS} seconds: it is damaged, or larger than can be used"
            ) from None
        glb = target.read_bytes() if target.exists() else b""
    said = done.stdout + done.stderr
    if "Traceback" in said:
        raise RuntimeError(f"cascadio could not be run: {said.strip().splitlines()[-1]}")
    if done.returncode not in (0, 1):  # 1: an exception of Python, seen above
        raise ValueError(f"{name}: the reader of STEP files crashed on it: it is damaged; export it again")
    damage = re.findall(r"\*+ ERR \w+ : (.*?)\s*\*+", said)
    if not glb:
        raise ValueError(f"{name} cannot be read as STEP: {'; '.join(damage) or 'no shapes in it'}; export it again")
    if damage:
        warnings.warn(
            f"{name} is damaged ({'; '.join(damage)}): parts or faces may be missing; export it again", stacklevel=2
        )
    return glb
