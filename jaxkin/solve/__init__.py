"""Solve the closure equations of loops for many poses at once: closure, correctors, continuation, range, execution.

The route of one sweep, straight down:

 1. `mechanism/sweep.py`             check the drive, and solve each driven structure element
 2. `execution/programs.py`          compile, or fetch, the program of one element (`solve`)
 3. `execution/cores.py`             cut a long range into shards, one for each core
 4. `range/solve_range.py`           find all poses (`find_poses`), then their displacements (`displacements`)
 5. `closure/closure.py`             constants of the loops from the frames of the joints (`loop_geometry`)
 6. `continuation/branch.py`         trace the branch from the assembled pose to both ends of the range
 7. `continuation/step.py`           take one step: predict, correct, accept or refuse
 8. `continuation/predictor.py`      extrapolate by a cubic through two poses, or along the tangent
 9. `correctors/newton.py`           correct by Newton's method, all poses at once
10. `closure/planar.py`, `closure/spatial.py`   evaluate residual and Jacobian (Eq. 10, 11)
11. `linear/blocks.py`               solve J delta = -r, block after block
12. `linear/least_norm.py`           least-norm solution of a block, by `ldl`, `gauss_jordan` or `cholesky`
13. `correctors/levenberg_marquardt.py`         go on, damped, where Newton's method does not close
14. `continuation/determinant_sign.py`          refuse a step that changed the sign of a determinant
15. `continuation/branch_samples.py` keep the poses of the branch, and predict between them
16. `range/polish.py`                predict each asked pose from the samples and correct it: steps 9 to 13
17. `range/interpolation.py`         of long ranges, correct a few poses and interpolate the others
18. `range/implicit_derivative.py`   attach derivatives by the implicit function theorem
19. `closure/joint_coordinates.py`   displacements of all joints (Table 2) from the solved state
20. `status.py`                      status of each pose from its residual norm

Glossary:

- *pose*: the coordinates of all joints at one value of the inputs; arrays over the poses have them as last axis.
- *closure residual*: what the loops leave of Eq. 10; its norm is the square root of Eq. 12 (`residual_norm`), with
  lengths over the *characteristic length*, the root-mean-square distance of the joints from their centroid.
- *merit*: half the sum of squares that the damped corrector reduces; near closure half the square of the residual.
- *state*: the solver's own coordinates: displacements, and quaternions of balls in place of three angles.
- *branch*: the poses that a continuous motion reaches from the assembled pose.
- *limit*: a pose beyond which the input cannot go on along the branch; the Jacobian is singular there.
- *front*: the pose that the continuation has reached on one side of the assembled pose.
- *sample*: a pose of the branch that is kept, with its tangent, to predict its neighbours.
- *equation block*: equations solved together, for unknowns that the blocks before do not hold.
- *passive spin*: the rotation of a rod about the line between its two balls, which moves nothing else.
"""
