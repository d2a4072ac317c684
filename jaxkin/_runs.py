"""Runs of true values in a row."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Int


def runs(mask: Bool[np.ndarray, " row"]) -> Int[np.ndarray, "runs 2"]:
    """Find the index of the first true value of each run, and the index behind its last one."""
    return np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int))).reshape(-1, 2)
