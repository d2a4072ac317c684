"""Tests run in float64, as the command line and the examples do; tests of float32 switch it off for themselves."""

import jax

jax.config.update("jax_enable_x64", True)
