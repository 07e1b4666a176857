"""What a decomposition is, and how it is written to a cache entry."""

from __future__ import annotations

from typing import Final

import msgspec
from msgspec import Struct

from satcheck.core import Mesh, Polytope
from satcheck.decompose.settings import DecompositionSettings

NOT_SOLID: Final = "decomposition-not-solid"
REMESHED: Final = "decomposition-remeshed"
FLAT_PARTS_DROPPED: Final = "decomposition-flat-parts-dropped"
CACHE_UNAVAILABLE: Final = "decomposition-cache-unavailable"

MeshBytes = tuple[bytes, bytes]  # as of Mesh.to_bytes()


class Note(Struct, frozen=True):
    """Something a reader of the result should know; `code` is stable."""

    code: str
    message: str


class Decomposition(Struct, frozen=True):
    """A mesh as convex parts, in the mesh's frame and units, with their measured error.

    parts: solid convex polytopes. They over- and under-cover the mesh: nothing about the mesh
        follows from them without the two errors.
    inner: for each part a copy shrunk until it is proven to lie inside the solid mesh, or None
        where none was found. What overlaps an inner part overlaps the mesh.
    outside: max over points of the parts' surfaces of the distance to the mesh (0 inside a solid
        one; to its surface where it is not solid); a proven upper bound.
    missing: max over points of the mesh's surface of the distance to the union of the parts (0
        inside); a proven upper bound.
    seconds: wall clock of the computation, also when the result came from the cache.
    """

    parts: tuple[Polytope, ...]
    inner: tuple[Polytope | None, ...]
    outside: float
    missing: float
    seconds: float
    from_cache: bool
    settings: DecompositionSettings
    notes: tuple[Note, ...]


class _Entry(Struct, frozen=True):
    """What a cache entry holds: all but `from_cache` and `settings`, which the reader knows."""

    parts: tuple[MeshBytes, ...]
    inner: tuple[MeshBytes | None, ...]
    outside: float
    missing: float
    seconds: float
    notes: tuple[Note, ...]


def encode(result: Decomposition) -> bytes:
    entry = _Entry(
        parts=tuple(part.to_mesh().to_bytes() for part in result.parts),
        inner=tuple(part.to_mesh().to_bytes() if part else None for part in result.inner),
        outside=result.outside,
        missing=result.missing,
        seconds=result.seconds,
        notes=result.notes,
    )
    return msgspec.msgpack.encode(entry)


def decode(data: bytes, settings: DecompositionSettings) -> Decomposition:
    """Raises ValueError unless `data` is what encode() makes."""
    entry = msgspec.msgpack.decode(data, type=_Entry)
    if len(entry.inner) != len(entry.parts) or any(not vertices for vertices, _ in entry.parts):
        raise ValueError("a part is empty, or has no inner part beside it")
    return Decomposition(
        parts=tuple(Mesh.from_bytes(*part).convex_hull() for part in entry.parts),
        inner=tuple(part and Mesh.from_bytes(*part).convex_hull() for part in entry.inner),
        outside=entry.outside,
        missing=entry.missing,
        seconds=entry.seconds,
        from_cache=True,
        settings=settings,
        notes=entry.notes,
    )
