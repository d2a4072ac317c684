"""Incidence, closed loops and the order in which they are solved: host code without JAX."""
