"""The command line: `jaxkin demo`, `jaxkin inspect`, `jaxkin loops`, `jaxkin sweep`."""

from __future__ import annotations

import os
from pathlib import Path


def main() -> None:
    """Run the command line, in float64 and with compiled programs kept in the user's cache between runs."""
    import jax

    from jaxkin.cli.app import app
    from jaxkin.cli.threads import one_thread

    one_thread()
    jax.config.update("jax_enable_x64", True)
    if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
        jax.config.update("jax_compilation_cache_dir", str(cache_folder()))
        # a sweep is some ten small programs; JAX by itself keeps only those that took a second
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)
    app(prog_name="jaxkin")


def cache_folder() -> Path:
    """Tell where compiled programs are kept: `jaxkin` in $XDG_CACHE_HOME, which is `~/.cache` where it is not set."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "jaxkin"
