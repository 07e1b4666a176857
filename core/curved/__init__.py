"""Curved shapes in the world: spheres, capsules, cylinders, cones, ellipsoids, placed by a matrix.

placed -> signed -> triangles -> exact -> nesting -> in_mesh -> freeing. A pair with a convex body
is decided for the true shape. A pair with another mesh is decided triangle by triangle. `exact/`
decides pairs that float64 bounds leave open.
"""
