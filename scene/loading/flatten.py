"""From a graph of placed parts to one list of placed meshes: no circle, no explosion."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from satcheck.core import Mesh
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits

Matrix = tuple[float, ...]  # row-major 4x4 for column vectors
Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True, slots=True)
class Instance(Generic[Key]):
    """Part `key` at `matrix` (None: as it is)."""

    key: Key
    matrix: Matrix | None


def flatten(
    roots: Sequence[tuple[Key, Matrix | None]],
    *,
    children: Callable[[Key], Sequence[tuple[Key, Matrix | None]]],
    triangle_count: Callable[[Key], int],
    name: Callable[[Key], str],
) -> list[Instance[Key]]:
    """Every part under the roots with triangles of its own, once for each path that leads to it.

    children: the parts placed inside a part; triangle_count: its own triangles; name: for messages.
    Raises MeshFileError for a circle, and when the instances exceed the triangle limit.
    """
    total = _promised(roots, children, triangle_count, name)
    if total > limits.MAX_TRIANGLES:
        raise MeshFileError(
            "too-large", f"{total} triangles in all instances exceed {limits.MAX_TRIANGLES}"
        )
    instances = []
    stack = list(reversed(roots))
    while stack:
        key, matrix = stack.pop()
        if triangle_count(key) > 0:
            instances.append(Instance(key, matrix))
        stack.extend(
            (child, multiply(matrix, placement)) for child, placement in reversed(children(key))
        )
    return instances


def _promised(
    roots: Sequence[tuple[Key, Matrix | None]],
    children: Callable[[Key], Sequence[tuple[Key, Matrix | None]]],
    triangle_count: Callable[[Key], int],
    name: Callable[[Key], str],
) -> int:
    """Triangles and placements of all instances together, each part visited once."""
    totals: dict[Key, int] = {}
    open_: set[Key] = set()
    stack = [(root, False) for root, _ in roots]
    while stack:
        key, closing = stack.pop()
        if closing:
            open_.discard(key)
            below = sum(totals[child] for child, _ in children(key))
            totals[key] = 1 + triangle_count(key) + below
        elif key in open_:
            raise MeshFileError("reference-cycle", f"{name(key)} contains itself: a cycle")
        elif key not in totals:
            open_.add(key)
            stack.append((key, True))
            stack.extend((child, False) for child, _ in children(key))
    return sum(totals[root] for root, _ in roots)


def multiply(outer: Matrix | None, inner: Matrix | None) -> Matrix | None:
    """The placement of a part at `inner` inside a part at `outer`."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    return tuple(
        sum(outer[4 * row + k] * inner[4 * k + column] for k in range(4))
        for row in range(4)
        for column in range(4)
    )


def concatenate(parts: Iterable[tuple[bytes, bytes, Matrix | None]]) -> tuple[bytes, bytes]:
    """(vertices, triangles) of all parts together, each at its matrix.

    parts: float64 vertices and uint32 triangles as in RawMesh. A mirroring matrix flips the
    winding.
    """
    vertices: list[bytes] = []
    triangles = array("I")
    offset = 0
    for part_vertices, part_triangles, matrix in parts:
        if matrix is not None:
            part_vertices, part_triangles = _placed(part_vertices, part_triangles, matrix)
        vertices.append(part_vertices)
        triangles.extend(index + offset for index in array("I", part_triangles))
        offset += len(part_vertices) // 24
    return b"".join(vertices), triangles.tobytes()


def _placed(vertices: bytes, triangles: bytes, matrix: Matrix) -> tuple[bytes, bytes]:
    try:
        return Mesh.from_bytes(vertices, triangles).transformed(matrix).to_bytes()
    except ValueError as error:
        raise MeshFileError("singular-transform", f"a part cannot be placed: {error}") from None
