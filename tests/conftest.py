"""Tests run in float64, as the command line and the examples do; tests of float32 switch it off for themselves."""

import jax

jax.config.update("jax_enable_x64", True)
# most of the time goes into compiling: a third less of it. The command line is tested as users have it, in a process
jax.config.update("jax_disable_most_optimizations", True)
