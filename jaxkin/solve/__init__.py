"""Closure of loops: residual, Jacobian, batched solver, continuation, status, derivatives."""
