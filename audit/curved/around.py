"""A mesh around a curved shape: the one inside it, grown until nothing sticks out."""

from __future__ import annotations

import numpy as np

from satcheck.audit.curved.shape import support
from satcheck.core import Mesh
from satcheck.scene.primitives import DEFAULT_SEGMENTS, Primitive, mesh_of

# Covers the rounding of face normals, supports and scaled corners.
_ROUNDED_UP = 1 + 2.0**-40


def mesh_around(shape: Primitive, segments: int = DEFAULT_SEGMENTS) -> Mesh:
    """Contains the shape. Each face plane of the inner mesh, grown by s, is s times as far from the
    origin, which lies inside; the shape reaches as far as its support along the face's normal."""
    inner = mesh_of(shape, segments)
    vertices = np.asarray(inner.vertices)
    a, b, c = (vertices[np.asarray(inner.triangles)[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = np.einsum("ij,ij->i", normals, a)
    reaches = np.array([support(shape, tuple(normal)) for normal in normals.tolist()])
    growth = float((reaches / offsets).max()) * _ROUNDED_UP
    return Mesh(vertices * growth, inner.triangles)
