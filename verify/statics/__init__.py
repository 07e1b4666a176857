"""What a report says about the support of bodies, checked from the mesh files without the solver.

Forces and weights are added up in rational numbers. `places` finds the contacts of two bodies
again, from their triangles, and `contacts` those of all bodies; `weights` weighs, adds up forces
and judges motions; `claims` takes the answers one by one.
"""
