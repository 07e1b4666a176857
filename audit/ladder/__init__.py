"""The ladder: from boxes to triangles, each rung settles what it can prove."""
