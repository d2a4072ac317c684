"""Forces without an integrator: drive forces, joint reactions and equilibria of a motion that is prescribed.

`masses` finds what parts weigh, `given` says what else acts on them. `wrenches` turns both into the work that they do
on a small displacement of each part. `drive` pairs this work with the derivatives of the sweep (virtual work),
`reactions` balances each part by the forces of its joints: two routes to the same drive force.
`friction` finds from the same balance what rubs in joints, and gives it to both.

Forces are in newtons, torques in newton metres, masses in kilograms and inertias in kg m^2. Points and displacements
are in the unit of the mechanism, as everywhere; lengths without a unit are taken for metres.
"""
