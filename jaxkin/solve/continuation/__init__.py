"""Trace the branch of the assembled pose along the inputs, by continuation.

`branch` traces the branch in both directions, and `reach` moves inputs to single targets. `step` takes one step of
either, `fronts` holds the poses reached so far, `predictor` extrapolates to the next pose by the slopes of
`input_slopes`, and `determinant_sign` tells whether a step crossed a singular pose. `branch_samples` predicts any pose
between those traced, and `input_path` is the curve of several inputs.
"""
