"""The mesh of a body as the kernel makes it."""

from __future__ import annotations

from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.scene.loading.raw_mesh import RawMesh


class Shape(Struct, frozen=True):
    """vertices, triangles, decimals: as in RawMesh, in metres. matrix: the placement in the world;
    None: identity. warnings: (code, message)."""

    vertices: bytes
    triangles: bytes
    matrix: Transform | None
    decimals: int
    warnings: tuple[tuple[str, str], ...] = ()

    def mesh(self, units: str) -> RawMesh:
        return RawMesh(
            vertices=self.vertices,
            triangles=self.triangles,
            number_format="written-digits",
            decimals=self.decimals,
            units=units,
            warnings=self.warnings,
        )
