"""Forces without an integrator: drive forces, joint reactions and equilibria of a motion that is prescribed.

`masses` finds what parts weigh, `given` says what else acts on them, and `acting` checks both. `changes` differentiates
the motion by its inputs and by time, loop group by loop group; `joint_screws` and `places` place joints and parts and
compute their twists (`screws`), which are `moving_parts` together; `inertia` and `wrenches` compute what acts on each
part.
`drive` pairs wrenches with the derivatives by each input (virtual work; of weights at rest it differentiates their
`potential`). `reactions` solves the `balance` of all parts for the wrenches of the joints: two routes to the same drive
force. `friction` finds from the same balance the friction in joints, for both.

Forces are in newtons, torques in newton metres, masses in kilograms and inertias in kg m^2. Points and displacements
are in the unit of the mechanism, as everywhere; lengths without a unit are taken for metres.
"""
