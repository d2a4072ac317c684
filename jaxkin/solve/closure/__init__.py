"""The closure equations (Eq. 10 to 12): residual, Jacobian, and coordinates read off a closed pose."""
