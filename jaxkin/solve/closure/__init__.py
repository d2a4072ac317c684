"""Evaluate the closure equations (Eq. 10 to 12): residual, Jacobian, and joint coordinates of a solved state."""
