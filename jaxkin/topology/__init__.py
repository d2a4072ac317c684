"""Incidence, independent loops and the tree of structure elements (Section 4): host code without JAX."""
