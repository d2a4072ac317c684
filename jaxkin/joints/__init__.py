"""Joints as chains of movements: by hand, from contacts, and several of one pair combined into one."""
