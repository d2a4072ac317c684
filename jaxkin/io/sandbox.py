"""Readers of files that are not to be trusted, as programs of their own: bounded in time and memory, and silent.

A few bytes may ask for any amount of either, or make native code print or crash; the process that asked lives on. A
reader ends when its time is over, when the process that asked is interrupted or killed (`guardian.py`), and, should
all who watch it be gone or stopped, by itself.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from jaxkin.io.time_limit import PATIENCE, TimeLimit

_SAID = 100_000
"""Characters that are kept of what a reader says."""

_LONGER = 5.0
"""Seconds after its time at which a reader ends by itself: whoever waits for it is to end it first, with a message."""

# Bounded from within: from without it would take a shell, or code between fork and exec. The thread of faulthandler
# needs no lock of Python, which native code that does not return keeps for ever.
_BOUNDED = """
import faulthandler, os, runpy, sys
seconds, processor, memory = float(sys.argv.pop(1)), int(sys.argv.pop(1)), int(sys.argv.pop(1))
sys.argv.pop(0)
nowhere = open(os.devnull, "w")
faulthandler.dump_traceback_later(seconds, exit=True, file=nowhere)
bounds = {"RLIMIT_AS": (memory, memory), "RLIMIT_CORE": (0, 0), "RLIMIT_CPU": (processor, processor + 5)}
for name, bound in bounds.items():
    try:
        import resource
        resource.setrlimit(getattr(resource, name), bound)
    except (ImportError, ValueError):  # not on every system, and none above what the system itself allows
        pass
runpy.run_path(sys.argv[0], run_name="__main__")
"""

_OVERTIME = -getattr(signal, "SIGXCPU", 0) & 255 or None
"""Exit status, as the guardian gives it, of a reader that took more of the processor than it may; None where systems
have no such limit, and the clock alone counts."""

_GUARDIAN = Path(__file__).with_name("guardian.py")


def run_apart(worker: str, *arguments: object, folder: str, limit: TimeLimit, memory: int) -> tuple[int, str]:
    """Run a file of this package as a program with arguments; its exit status and what it said, output and errors.

    `folder` has the files that it makes, and is removed where this process is killed before it can do so. `memory`
    bounds its address space, in bytes. Raises ValueError where the reader takes more of the processor than the limit
    allows, or `PATIENCE` times as much of the clock.
    """
    processor = limit.remaining()
    seconds = PATIENCE * processor
    program = Path(__file__).with_name(worker)
    bounds = [str(seconds + _LONGER), str(math.ceil(processor)), str(memory)]
    reader = [sys.executable, "-P", "-c", _BOUNDED, *bounds, str(program), *map(str, arguments)]
    command = [sys.executable, "-I", "-S", str(_GUARDIAN), folder, *reader]
    # threads of numpy take address space and are not used; each arena of malloc takes 64 MB of it
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "4"}
    with tempfile.TemporaryFile("w+", errors="replace") as said:  # a pipe would keep all of it in memory
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=said, stderr=said, env=alone) as guardian:
            try:
                status = guardian.wait(seconds)
            except subprocess.TimeoutExpired:
                raise limit.exceeded() from None
            finally:  # by leaving: closes its standard input, at which it ends the reader, and waits for it
                if guardian.stdin is not None:
                    guardian.stdin.close()
        if status == _OVERTIME:
            raise limit.exceeded()
        said.seek(0)
        return status, said.read(_SAID)
