"""Compiled programs, and how they run: over cores, over designs, lanes in lockstep."""
