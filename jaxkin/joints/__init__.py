"""Joints as chains of movements: written by hand, from single contacts, and from several contacts combined."""
