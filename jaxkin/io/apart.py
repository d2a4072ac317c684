"""Readers of files that are not to be trusted, as programs of their own: bounded in time and memory, and silent.

A few bytes may ask for any amount of either, or make native code print or crash; the process that asked lives on.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

_SAID = 100_000
"""Characters that are kept of what a reader says."""

# address space is bounded from within: from without it would take a shell, or code between fork and exec
_BOUNDED = """
import runpy, sys
memory = int(sys.argv.pop(1))
sys.argv.pop(0)
try:
    import resource
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
except (ImportError, ValueError):  # not on every system
    pass
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def run_apart(worker: str, *arguments: object, name: str, seconds: int, memory: int) -> tuple[int, str]:
    """Run a file of this folder as a program with arguments; its exit status and what it said, output and errors.

    `memory` bounds its address space, in bytes. Raises ValueError, with `name` for the file that it reads, where it is
    not done in time.
    """
    program = Path(__file__).with_name(worker)
    command = [sys.executable, "-P", "-c", _BOUNDED, str(memory), str(program), *map(str, arguments)]
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # numpy's threads take address space and are not used
    with tempfile.TemporaryFile("w+", errors="replace") as said:  # a pipe would keep all of it in memory
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, stdout=said, stderr=said, timeout=seconds, check=False, env=alone
            )
        except subprocess.TimeoutExpired:
            raise ValueError(
                f"{name} was not read within {seconds} seconds: it is damaged, or larger than can be used"
            ) from None
        said.seek(0)
        return done.returncode, said.read(_SAID)
