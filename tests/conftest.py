"""Tests run in float64, as the command line and the examples do; tests of float32 switch it off for themselves.

Programs once compiled are kept beside pytest's own cache: the processes of a run share them, and the next run has them.
`pytest --cache-clear` begins anew.
"""

import jax

jax.config.update("jax_enable_x64", True)


def pytest_configure(config):
    folder = config.cache.mkdir("compiled") if hasattr(config, "cache") else None
    if folder is not None:
        jax.config.update("jax_compilation_cache_dir", str(folder))
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)
