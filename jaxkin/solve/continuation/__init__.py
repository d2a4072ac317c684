"""Continuation: the branch of the assembled pose is traced along the inputs.

`branch` traces, `step` takes one step, `fronts` holds the ends, `predictor` says where the next pose is expected,
`branch_samples` predicts any pose between those traced, `input_path` is the curve of several inputs, and
`determinant_sign` tells that a step crossed a singular pose.
"""
