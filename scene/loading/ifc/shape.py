"""The mesh of a body as the kernel makes it."""

from __future__ import annotations

import numpy as np
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

    @property
    def volume(self) -> float:
        """Of a closed mesh, cubic metres: the sum of the tetrahedra from one of its vertices."""
        points = np.frombuffer(self.vertices, "<f8").reshape(-1, 3)
        corners = (points - points[0])[np.frombuffer(self.triangles, "<u4").reshape(-1, 3)]
        return float(abs(np.linalg.det(corners).sum()) / 6)

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
