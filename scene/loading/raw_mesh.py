"""The result of a reader: plain arrays, their placements, and their precision."""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING, Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.power_of_two import exponent_into_range, exponent_of, times_power
from satcheck.core.transform import Transform

Precision = Literal["written-digits", "float16", "float32", "float64"]
if TYPE_CHECKING:
    Block = bytes | memoryview
else:
    Block = memoryview  # what msgspec decodes to
NO_SURFACE = "no-surface"  # the code of a mesh of lines or points alone


class RawMesh(Struct, frozen=True, tag=True):
    """What a reader found, in file units, not welded.

    vertices: little-endian float64 x, y, z of each vertex; triangles: little-endian uint32 vertex
    numbers, three a triangle. exponent: vertices times 2**exponent are those of the file; 0 but
    where the core could not hold these. decimals: most digits after the point in a coordinate
    written without exponent; significant: most significant digits in one written with an exponent.
    units: as the file declares them, or None. warnings: (code, message).
    """

    vertices: Block
    triangles: Block
    precision: Precision
    decimals: int = 0
    significant: int = 0
    units: str | None = None
    warnings: tuple[tuple[str, str], ...] = ()
    exponent: int = 0


class Refusal(Struct, frozen=True, tag=True):
    """Why a mesh or a file cannot be used: the code and the message of a MeshFileError."""

    code: str
    message: str


class RawPart(Struct, frozen=True):
    """One mesh of a file in its own coordinates, or why it cannot be used. name: unique there."""

    name: str
    mesh: RawMesh | Refusal


class RawNode(Struct, frozen=True):
    """Part number `part` where the file places it. path: unique there; None: the whole file."""

    path: str | None
    part: int
    matrix: Transform | None = None


class RawScene(Struct, frozen=True, tag=True):
    """The meshes of a file and where they are placed; every part is placed at least once.

    warnings: (code, message) about what belongs to no part.
    """

    parts: tuple[RawPart, ...]
    nodes: tuple[RawNode, ...]
    warnings: tuple[tuple[str, str], ...] = ()


def alone(mesh: RawMesh) -> RawScene:
    """A file that holds one mesh and does not place it."""
    return RawScene((RawPart("", mesh),), (RawNode(None, 0),))


def into_range(raw: RawMesh) -> RawMesh:
    """The mesh times a power of two with which the core can hold it.

    Raises OverflowError where no power of two helps, or a coordinate would lose digits by it.
    """
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
