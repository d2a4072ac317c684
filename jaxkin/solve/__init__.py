"""Solve the closure equations of loops for many poses at once: closure, correctors, continuation, range, execution.

The route of one loop system (the loops and couplings of one loop group) through the solver, in order of calls: each
function is called by the nearest one above it that is indented less. What happens before and after is on the page
"Architecture", and what the words mean in the glossary (`docs/glossary.md`).

 1. `execution/programs.py` `solve`                         compile, or fetch, the program of the loop system
        `closed_form/range_by_formula.py` `find_poses_by_formula`   the route ends here where formulas prove all poses;
            if all loops have formulas, `jaxkin.mechanism.formula_sweep` calls it, in one program for all of them
 2.   `execution/known_numbers.py` `solve_numbers`          run the program that stops at limits (`follow_limits`)
          first; where it leaves poses open, the one that goes on beyond them
        `execution/cores.py` `run_on_cores`                 cut a range into shards, one for each core
          `_solve` of `execution/known_numbers.py` solves a shard: steps 3 and 18
 3.     `range/solve_range.py` `find_poses`                 find all poses of a shard
 4.       `closure/closure.py` `scaled_geometry`            scale lengths, compute constants of the loops from frames
 5.       `continuation/branch.py` `trace_branch`           trace the branch from the assembled pose to both ends
 6.         `continuation/step.py` `substep`                take one step: predict, correct, accept or refuse
 7.           `continuation/predictor.py` `predict_state`   extrapolate along the last slopes, by chord or tangent
 8.           `correctors/newton.py` `newton`               correct by Newton's method, all poses at once
 9.             `closure/closure.py` `closure`              evaluate residual and Jacobian (Eq. 10, 11): planar, spatial
10.             `linear/blocks.py` `solve_blocks`           solve J delta = -r, block after block
11.               `linear/least_norm.py` `factor_normal_equations`  solve a block: `ldl`, `gauss_jordan` or `cholesky`
12.           `correctors/levenberg_marquardt.py`           go on, damped, where Newton's method does not close
13.           `continuation/determinant_sign.py`            refuse a step across which a determinant changed its sign
14.         `continuation/branch_samples.py` `sample_rows`  keep the poses of the branch; `predict` those between them
15.       `range/polish.py` `correct_poses`                 predict (14) each pose of the range and correct it (8 to 12)
            `range/damped_poses.py` `correct_damped`        the damped steps (12) of poses left open, from neighbours
16.         `status.py` `classify`                          decide the status of each pose from its residual norm
17.       `range/interpolation.py` `interpolate`            correct (15) a few poses of a long range, and interpolate
          `range/other_paths.py`                            of several inputs, try what the branch does not reach,
            by `continuation/reach.py` `reach`              a path of its own from the assembled pose to each target (6)
18.     `range/solve_range.py` `displacements`              attach derivatives (`range/implicit_derivative.py`), then
19.       `closure/joint_coordinates.py`                    compute the displacements of all joints (Table 2)

So Newton's method runs for the two ends of the branch, step after step, and then once for all poses of the range.
"""
