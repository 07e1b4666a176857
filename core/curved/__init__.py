"""Curved shapes in the world: spheres, capsules, cylinders, cones, ellipsoids, placed by a matrix.

placed -> signed -> triangles -> exact -> nesting -> in_mesh -> freeing. Against convex bodies they
are decided as the shapes they are; against other meshes, triangle by triangle. `exact/` decides
what bounds leave open.
"""
