"""The result of a decomposition, and its encoding in a cache entry."""

from __future__ import annotations

from math import inf
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


class Stored(Struct, frozen=True):
    """The content of a cache entry. As anybody may have written it, its reader measures the errors,
    and checks that the inner parts lie inside."""

    parts: tuple[Polytope, ...]
    inner: tuple[Polytope | None, ...]
    seconds: float
    notes: tuple[Note, ...]


class _Entry(Struct, frozen=True):
    parts: tuple[MeshBytes, ...]
    inner: tuple[MeshBytes | None, ...]
    seconds: float
    notes: tuple[Note, ...]


def encode(result: Decomposition) -> bytes:
    entry = _Entry(
        parts=tuple(part.to_mesh().to_bytes() for part in result.parts),
        inner=tuple(part.to_mesh().to_bytes() if part else None for part in result.inner),
        seconds=result.seconds,
        notes=result.notes,
    )
    return msgspec.msgpack.encode(entry)


def decode(data: bytes) -> Stored:
    """Read what encode() wrote: the parts are the hulls of their vertices, whatever these are.
    Raises ValueError for other data."""
    entry = msgspec.msgpack.decode(data, type=_Entry)
    if not entry.parts or len(entry.inner) != len(entry.parts):
        raise ValueError("there is no part, or its inner part is missing")
    if not 0.0 <= entry.seconds < inf:
        raise ValueError("no such time")
    parts = tuple(_hull(part) for part in entry.parts)
    inner = tuple(part and _hull(part) for part in entry.inner)
    return Stored(parts, inner, entry.seconds, entry.notes)


def _hull(part: MeshBytes) -> Polytope:
    if not part[0]:
        raise ValueError("a part has no vertex")
    hull = Mesh.from_bytes(*part).convex_hull()
    if hull.dimension < 3:
        raise ValueError("a part is flat")
    return hull
