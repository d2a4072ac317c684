"""Runs a reader for as long as somebody waits for it: `python guardian.py FOLDER COMMAND...`.

Whoever waits holds the other end of standard input. When that end closes, because the time is over, or because the
process that waited was interrupted or killed, the reader is killed and FOLDER, where its files are, is removed. The
reader cannot watch for this itself: native code that does not return keeps the lock of Python.
"""

import os
import signal
import subprocess
import sys
import threading


def main(folder: str, command: list[str]) -> int:
    """Run the command; its exit status, in the range of exit statuses."""
    # Ctrl-C goes to all programs of a terminal: the one that waits decides, and this one is needed to the end
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    reader = subprocess.Popen(command, stdin=subprocess.DEVNULL)
    abandoned = threading.Event()

    def watch() -> None:
        os.read(0, 1)  # nothing is ever written: it returns when the other end closes
        abandoned.set()
        reader.kill()

    threading.Thread(target=watch, daemon=True).start()
    status = reader.wait()
    if abandoned.is_set():
        import shutil  # takes a third of the time to start

        shutil.rmtree(folder, ignore_errors=True)
    return status & 255  # of a reader that a signal ended, Popen gives its number with a minus


if __name__ == "__main__":
    os._exit(main(sys.argv[1], sys.argv[2:]))  # the thread may still be waiting
