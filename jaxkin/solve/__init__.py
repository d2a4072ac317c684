"""Solve the closure equations of loops for many poses at once: closure, correctors, continuation, range, execution.

The route of one loop system (the loops of one structure element) through the solver, in order of calls. What happens
before and after is on the page "Architecture", and what the words mean in the glossary (`docs/glossary.md`).

 1. `execution/programs.py`          compile, or fetch, the program of the loop system (`solve`)
    `closed_form/range_by_formula.py`    where all groups have formulas and these prove their poses, the route ends here
 2. `execution/cores.py`             cut a long range into shards, one for each core
 3. `range/solve_range.py`           find all poses (`find_poses`), then their displacements (`displacements`)
 4. `closure/closure.py`             scale lengths, compute constants of the loops from joint frames (`loop_geometry`)
 5. `continuation/branch.py`         trace the branch from the assembled pose to both ends of the range
 6. `continuation/step.py`           take one step: predict, correct, accept or refuse
 7. `continuation/predictor.py`      extrapolate by a cubic through two poses, or along the tangent
 8. `correctors/newton.py`           correct by Newton's method, all poses at once
 9. `closure/planar.py`, `closure/spatial.py`    evaluate residual and Jacobian (Eq. 10, 11)
10. `linear/blocks.py`               solve J delta = -r, block after block
11. `linear/least_norm.py`           least-norm solution of a block, by `ldl`, `gauss_jordan` or `cholesky`
12. `correctors/levenberg_marquardt.py`          go on, damped, where Newton's method does not close
13. `continuation/determinant_sign.py`           refuse a step across which a determinant changed its sign
14. `continuation/branch_samples.py` keep the poses of the branch, and predict between them
15. `range/polish.py`                predict each pose of the range from the samples and correct it: steps 8 to 12
16. `range/interpolation.py`         of long ranges, correct a few poses and interpolate the others
17. `status.py`                      decide the status of each pose from its residual norm
18. `range/implicit_derivative.py`   attach derivatives by the implicit function theorem
19. `closure/joint_coordinates.py`   compute the displacements of all joints (Table 2) from the solved state
"""
