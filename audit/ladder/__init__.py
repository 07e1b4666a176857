"""The ladder, from boxes to triangles: each rung settles the pairs that it can decide."""
