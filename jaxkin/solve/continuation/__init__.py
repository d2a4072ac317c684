"""Trace the branch of the assembled pose along the inputs, by continuation.

`branch` traces the branch in both directions, `step` takes one step, `fronts` holds the poses reached so far,
`predictor` extrapolates to the next pose, `branch_samples` predicts any pose between those traced, `input_path` is the
curve of several inputs, and `determinant_sign` tells whether a step crossed a singular pose.
"""
