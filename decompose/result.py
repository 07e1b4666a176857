"""The result of a decomposition, and its encoding in a cache entry."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import msgspec
from msgspec import Struct

from satcheck.core import Mesh, Polytope
from satcheck.decompose.settings import DecompositionSettings

if TYPE_CHECKING:
    import trimesh

NOT_SOLID: Final = "decomposition-not-solid"
REMESHED: Final = "decomposition-remeshed"
FLAT_PARTS_DROPPED: Final = "decomposition-flat-parts-dropped"
CACHE_UNAVAILABLE: Final = "decomposition-cache-unavailable"

MeshBytes = tuple[bytes, bytes]  # as from Mesh.to_bytes()


class Note(Struct, frozen=True):
    """A remark about the result; `code` is stable."""

    code: str
    message: str


class Decomposition(Struct, frozen=True):
    """A mesh as convex parts, in the mesh's frame and units, with their measured error.

    parts: solid convex polytopes. They cover both too much and too little of the mesh, so a
        statement about the mesh needs the two errors.
    inner: for each part a shrunken copy that is proven to lie inside the solid mesh; None: not
        found. A body that overlaps an inner part overlaps the mesh.
    outside: a proven upper bound of the largest distance of a point of the parts' surfaces from the
        mesh (0 inside a solid mesh; for other meshes, from the surface).
    missing: a proven upper bound of the largest distance of a point of the mesh's surface from the
        union of the parts (0 inside).
    seconds: wall clock of the computation, even if the result came from the cache.
    """

    parts: tuple[Polytope, ...]
    inner: tuple[Polytope | None, ...]
    outside: float
    missing: float
    seconds: float
    from_cache: bool
    settings: DecompositionSettings
    notes: tuple[Note, ...]

    def to_trimesh(self) -> list[trimesh.Trimesh]:
        """Return the parts as objects of trimesh, in the frame of the mesh."""
        import trimesh

        meshes = (part.to_mesh() for part in self.parts)
        return [trimesh.Trimesh(m.vertices, m.triangles, process=False) for m in meshes]


class _Entry(Struct, frozen=True):
    """The content of a cache entry: everything except `from_cache` and `settings`, which the reader
    knows."""

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
    """The inverse of encode(). Raises ValueError for other data."""
    entry = msgspec.msgpack.decode(data, type=_Entry)
    if len(entry.inner) != len(entry.parts) or any(not vertices for vertices, _ in entry.parts):
        raise ValueError("a part is empty, or its inner part is missing")
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
