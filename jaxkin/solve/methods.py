"""The methods that find poses, by name."""

from __future__ import annotations

CONTINUATION = "continuation"
"""Ours: followed from the assembled pose, then all poses at once by damped least-norm Newton steps."""
METHODS = (CONTINUATION, "gauss-newton", "levenberg-marquardt", "bfgs", "dfp", "dfp-autodiff")
"""The others minimise Eq. 12 one pose after the other, for comparison: see `minimise`. "dfp" is the paper's own."""
