"""The command line: `jaxkin demo`, `inspect`, `loops`, `accuracy` and `sweep`.

The commands are in `app`, their arguments with the help in `arguments`; `options` makes a study of these, `run` does
what commands share, `report` prints, `written` writes files of `inspect`.
"""

from __future__ import annotations

import os
from pathlib import Path


def main() -> None:
    """Run the command line, in float64 and with compiled programs kept in the user's cache between runs.

    JAX is not imported here, which takes longer than help and errors of arguments do: it reads the environment.
    """
    from jaxkin.cli.app import app
    from jaxkin.cli.interrupt import never_ignored
    from jaxkin.cli.threads import one_thread

    never_ignored()
    one_thread()
    os.environ["JAX_ENABLE_X64"] = "1"
    if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
        os.environ["JAX_COMPILATION_CACHE_DIR"] = str(cache_folder())
        # a sweep is some ten small programs; JAX by itself keeps only those that took a second
        os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.1")
    app(prog_name="jaxkin")


def cache_folder() -> Path:
    """Tell where compiled programs are kept: `jaxkin` in $XDG_CACHE_HOME, which is `~/.cache` where it is not set."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "jaxkin"
