"""Solve the small linear systems of all poses at once: least norm, block after block; one algorithm a file."""
