"""What a report says about the support of bodies, checked from the mesh files without the solver.

Forces and weights are added up in rational numbers. `contacts` finds the contacts of bodies again,
from their triangles; `weights` weighs; `claims` takes the answers one by one, adds up forces and
judges motions.
"""
