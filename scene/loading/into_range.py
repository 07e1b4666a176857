"""A mesh whose numbers the core cannot hold, times a power of two with which it can."""

from __future__ import annotations

from array import array

from msgspec.structs import replace

from satcheck.core.power_of_two import exponent_into_range, exponent_of, times_power
from satcheck.scene.loading.raw_mesh import RawMesh


def into_range(raw: RawMesh) -> RawMesh:
    """Raises OverflowError where no power of two helps, or a coordinate would lose digits by it."""
    coordinates = array("d")
    coordinates.frombytes(raw.vertices)
    size = max(_half_extent(coordinates[axis::3]) for axis in range(3))
    largest = max(map(abs, coordinates), default=0.0)
    exponent = exponent_into_range(exponent_of(size), exponent_of(largest)) if size > 0 else 0
    scaled = times_power(coordinates, exponent) if exponent else None
    if scaled is None:
        raise OverflowError(
            f"coordinates up to {largest:.3g} in a mesh {2 * size:.3g} across are out of range"
        )
    return replace(raw, vertices=array("d", scaled).tobytes(), exponent=-exponent)


def _half_extent(values: array[float]) -> float:
    return max(values, default=0.0) / 2 - min(values, default=0.0) / 2
