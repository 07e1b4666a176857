"""A mesh between file and body: plain arrays and what is known about their precision."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

Precision = Literal["written-digits", "float32", "float64"]


@dataclass(frozen=True, slots=True)
class RawMesh:
    """What a reader found, in file units, not welded.

    vertices: little-endian float64 x, y, z of each vertex; triangles: little-endian uint32 vertex
    numbers, three a triangle. decimals: most digits after the point in a coordinate written
    without exponent; significant: most significant digits in one written with an exponent.
    units: as the file declares them, or None. warnings: (code, message).
    """

    vertices: bytes = field(repr=False)
    triangles: bytes = field(repr=False)
    precision: Precision
    decimals: int = 0
    significant: int = 0
    units: str | None = None
    warnings: tuple[tuple[str, str], ...] = ()
