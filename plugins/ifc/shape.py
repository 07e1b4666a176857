"""The mesh of a body as the kernel makes it."""

from __future__ import annotations

from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.scene.loading.raw_mesh import RawMesh


class Shape(Struct, frozen=True):
    """vertices, triangles, decimals: as in RawMesh, in metres. matrix: the placement in the world;
    None: identity. tolerance: how far its facets may be off its surfaces, metres. warnings: (code,
    message)."""

    vertices: bytes
    triangles: bytes
    matrix: Transform | None
    decimals: int
    tolerance: float = 0.0
    warnings: tuple[tuple[str, str], ...] = ()

    def mesh(self, units: str) -> RawMesh:
        return RawMesh(
            vertices=self.vertices,
            triangles=self.triangles,
            number_format="written-digits",
            decimals=self.decimals,
            units=units,
            warnings=self.warnings,
            surface_tolerance=self.tolerance,
        )

    @property
    def key(self) -> tuple[object, ...]:
        """The same for bodies that share a mesh."""
        return self.vertices, self.triangles, self.tolerance
