"""Least-norm solutions of the small linear systems of all poses at once."""
