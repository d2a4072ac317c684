"""Change the dimensions of a mechanism: link lengths by name, and frames of joints."""
