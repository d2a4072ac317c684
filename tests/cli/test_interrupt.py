"""Ctrl-C ends a command, also where Python ignores exceptions."""

import subprocess
import sys

SCRIPT = """
import gc, signal, time
from jaxkin.cli.interrupt import never_ignored

signal.signal(signal.SIGINT, signal.default_int_handler)  # shells that run it in the background have it ignored

def interrupted(phase, info):  # as JAX is called when Python collects garbage
    if phase == "start" and not seen:
        seen.append(phase)
        signal.raise_signal(signal.SIGINT)

seen = []
{call}
gc.callbacks.append(interrupted)
gc.collect()
time.sleep(1)
print("went on")
"""


def run(call):
    command = [sys.executable, "-c", SCRIPT.format(call=call)]
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)


def test_an_interrupt_that_is_ignored_comes_again():
    ended = run("never_ignored()")
    assert ended.returncode != 0 and "KeyboardInterrupt" in ended.stderr
    assert not ended.stdout and "Exception ignored" not in ended.stderr


def test_python_by_itself_ignores_it():
    """Where it no longer does, `never_ignored` is needless."""
    ended = run("")
    assert ended.returncode == 0 and ended.stdout == "went on\n" and "Exception ignored" in ended.stderr
