"""Correct poses near closure to closed ones.

Newton's method, and Gauss-Newton's with or without damping, is written once for each row, since each needs what the
others must not have:

| where | damping | why it is not one of the others |
|---|---|---|
| `correctors.newton` | none | the common case, at a fraction of the cost of the damped corrector |
| `correctors.chord_newton` | none | many neighbours share one inverse: no Jacobian, no elimination per pose |
| `correctors.levenberg_marquardt` | vanishes with the residual | safe from afar and at singular poses |
| `correctors.least_residual` | cutoff at the play | loops do not close: a damped step would follow the play |
| `correctors.nearest_pose` | none | to the nearest of all closed poses: also along these, and with weights |
| `correctors.turning_point` | none | one pose, whose unknowns hold the driven coordinate: where its rate is zero |
| `linkage.host_closure` | as `levenberg_marquardt` | numpy, one pose: analyses before a sweep compile nothing |
| `mobility.consistency` | as `least_residual` | the same in numpy, with a cutoff from the noise of the frames |
| `dimensions.placement` | its own | unknowns are positions of features, not coordinates of joints |
| `design.least_squares` | Nielsen's rule, within bounds | unknowns are dimensions; a residual is a whole sweep |
| `mobility.other_modes` | steps are shortened | within the freedoms of closed loops, towards given places |
| `mechanism.inverse.step` | rises after a poor step | closure first, then targets, more or fewer than the freedoms |
| `effects.rank_deficient_fit` | rises after a refused step | unknowns that the measurements do not tell stay at rest |
| `joints.screws.misfit` | cutoff at 1e-10 | one chain that is to make a given displacement: there is no loop |
| `effects.extended` | none | fifty digits, with a Jacobian in float64 |

The first three take a `problem.ClosureProblem`: loops, their constants, options. The host versions are kept apart
because compiling a corrector takes longer than all host analyses of a mechanism.
"""
