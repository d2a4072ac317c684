"""Solids in their assembled pose, and the way from their contacts to a mechanism."""
