"""Forces without an integrator: drive forces, joint reactions and equilibria of a motion that is prescribed.

`masses` finds what parts weigh, by their `densities` where no file says it, `given` says what else acts on them, and
`acting` checks both. `changes` differentiates the motion by its inputs and by time, loop group by loop group;
`joint_screws` and `places` place joints and parts and compute their twists (`screws`), which are `moving_parts`
together; `inertia` and `wrenches` compute what acts on each part. All of it is computed by `pose_groups`.

`drive` pairs wrenches with the derivatives by each input (virtual work; of weights at rest it differentiates their
`potential`). `reactions` solves the `balance` of all parts for the wrenches of the joints, by the `joint_balance` of
each and the `balance_equations`, written in the `wrench_axes` of planar loops: two routes to the same drive force. What
the balance leaves open is `undetermined`. `friction` finds from the same balance the friction in joints, for both:
`friction_of` says of which, and `friction_result` what it does. `equilibrium` and `transmission` ask these two.

Forces are in newtons, torques in newton metres, masses in kilograms and inertias in kg m^2. Points and displacements
are in the unit of the mechanism, as everywhere; lengths without a unit are taken for metres.
"""
