"""Bodies in the world as core.curved sees them, without files and settings."""

from __future__ import annotations

from satcheck import core
from satcheck.core.conventions import Bounds, Vector
from satcheck.core.curved.placed import CurvedShape, curved_shape
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Primitive


class World:
    """A closed mesh, and the curved shape that it is within."""

    def __init__(self, mesh: core.Mesh, curved: CurvedShape | None = None) -> None:
        self.mesh, self.curved = mesh, curved
        self.bounds: Bounds = mesh.bounds if curved is None else curved.bounds()
        self.convex = mesh.convexity_defect(0.0) == 0.0

    def surface(self) -> core.Surface:
        return core.Surface(self.mesh, True)

    def hull(self) -> core.Polytope:
        return self.mesh.convex_hull()

    def hull_shape(self) -> core.Shape:
        return core.Hull(self.hull())


def at(primitive: Primitive, place: Vector) -> World:
    x, y, z = place
    matrix = (1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)
    return World(mesh_of(primitive).transformed(matrix), curved_shape(primitive, matrix))
