"""jaxkin."""
