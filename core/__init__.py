"""Geometry on arrays: meshes, convex shapes, exact relations, distances."""

from satcheck.core._native import Mesh, Polytope, Surface, Topology

__all__ = ["Mesh", "Polytope", "Surface", "Topology"]
