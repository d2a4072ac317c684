"""Formulas for the poses of single loops, solved one after another: no iteration, one evaluation a pose.

| module | loop | unknown coordinates |
|---|---|---|
| `complex_numbers`, `coordinate` | | turns as complex numbers; a coordinate known as a number or as a turn |
| `vectors` | | products of vectors of space, and their turns about axes |
| `equations` | A cos x + B sin x = C; (s + b)^2 = c | one angle; one displacement |
| `planar_dyad` | planar, of turns R and slides P: RRR; RRP, RPR, PRR; RPP, PRP, PPR | three |
| `planar_derivative` | the same, and planar loops without a formula | their derivatives, by the screws of a pose |
| `planar_twists`, `planar_least_norm` | | what `planar_derivative` adds up and solves |
| `spherical_triangle` | turns about axes through one point: RRR | three angles |
| `rod` | a rod between two balls, whose other joints are known but for one | one angle or displacement |

`group_formulas` tells which formula a group of loops has; `solve_groups` evaluates those of all groups of a system, one
after another, with the axes of `assembled_axes` and the links of `chain_motions`. `range_by_formula` finds the poses
of a range, and their statuses by the proof of `branch_certificate` along the nodes of `input_line`; `poses_on_grid`
those of a range that is a `turn_grid`, whose poses are the nodes, with fewer arc tangents by `loop_angles`;
`formula_displacements` and `known_poses_in_plane` give displacements with derivatives.

A loop is written as a product of displacements in world coordinates, each about its axis in the assembled pose,

    U_1(q_1) K_1 U_2(q_2) K_2 ... U_n(q_n) K_n = 1,

where the `U` are the elementary motions of unknown coordinates in order of travel, and `K` is what lies behind each of
them and is known. All `q` are displacements from the assembled pose, in which the `U` are 1. A product that is 1 stays
1 when it is begun at another factor, so RRP, RPR and PRR are one case.

Every formula takes the sign of the branch, that of its signed root in the assembled pose, and returns the motions of
the unknowns (turns as complex numbers of absolute value 1, from which angles in (-pi, pi] are computed where they are
asked for, and displacements) with the discriminant over its largest possible value. The discriminant is positive where
two poses exist, zero at a limit, negative where the loop cannot close; there the root is taken as zero. Coordinates are
right to some roundings over the root of the discriminant.
"""
