"""Builds a mesh from pieces whose coordinates are written in decimal digits."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Sequence
from itertools import pairwise

from satcheck.scene.loading.raw_mesh import RawMesh


class WrittenMesh:
    """Vertices and triangles of several pieces, and the number of digits in their coordinates."""

    def __init__(self) -> None:
        self.vertices = array("d")
        self.triangles = array("I")
        self._decimals = self._significant = 0

    def add(
        self, words: Iterable[str], coordinates: Sequence[float], corners: Iterable[int]
    ) -> None:
        """words: the coordinates as written. corners: vertex numbers within this piece."""
        offset = len(self.vertices) // 3
        self.vertices.extend(coordinates)
        self.triangles.extend(corner + offset for corner in corners)
        for word in words:
            decimals, significant = digits_of(word)
            self._decimals = max(self._decimals, decimals)
            self._significant = max(self._significant, significant)

    def raw(self, units: str | None) -> RawMesh:
        return RawMesh(
            vertices=self.vertices.tobytes(),
            triangles=self.triangles.tobytes(),
            number_format="written-digits",
            decimals=self._decimals,
            significant=self._significant,
            units=units,
        )


def digits_of(number: str) -> tuple[int, int]:
    """(digits after the point, 0); for a number with an exponent (0, its significant digits)."""
    mantissa, exponent, _ = number.lower().partition("e")
    if exponent:
        return 0, len(mantissa.lstrip("+-0.").replace(".", ""))
    return len(mantissa.rstrip().partition(".")[2]), 0


def strip_triangles(strip: Sequence[int]) -> list[int]:
    """Corners of the triangles of a strip. Every other triangle is turned over."""
    corners: list[int] = []
    for k, (a, b, c) in enumerate(zip(strip, strip[1:], strip[2:], strict=False)):
        corners += (b, a, c) if k % 2 else (a, b, c)
    return corners


def fan_triangles(fan: Sequence[int]) -> list[int]:
    corners: list[int] = []
    for b, c in pairwise(fan[1:]):
        corners += (fan[0], b, c)
    return corners
