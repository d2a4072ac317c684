"""Files in and out: STEP, tables, animation."""
