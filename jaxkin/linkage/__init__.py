"""Describe a linkage by joints, structure and loop classes: all that computing its motion needs."""
