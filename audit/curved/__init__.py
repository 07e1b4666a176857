"""Bodies that are curved shapes and no meshes: spheres, capsules, cylinders, cones, ellipsoids.

Against convex bodies they are asked about as the shapes they are; against other meshes, triangle by
triangle; what bounds leave open is put to exact arithmetic. Figures that need a mesh of them come
from two, one inside the shape and one around it.
"""
