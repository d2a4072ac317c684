"""Solve small linear systems, and least squares under linear constraints, at all poses: one algorithm a file."""
