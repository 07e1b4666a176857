"""What a decomposition is, and how it is written to a cache entry."""

from __future__ import annotations

import struct
from typing import Final

from msgspec import Struct

from satcheck.core import Mesh, Polytope
from satcheck.core.blocks import pack_blocks, unpack_blocks
from satcheck.decompose.settings import DecompositionSettings

NOT_SOLID: Final = "decomposition-not-solid"
REMESHED: Final = "decomposition-remeshed"
FLAT_PARTS_DROPPED: Final = "decomposition-flat-parts-dropped"
CACHE_UNAVAILABLE: Final = "decomposition-cache-unavailable"

_NUMBERS: Final = struct.Struct("<ddd")
_COUNTS: Final = struct.Struct("<QQ")


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


def encode(result: Decomposition) -> bytes:
    """Everything but `from_cache` and `settings`, which the reader knows."""
    blocks = [
        _NUMBERS.pack(result.outside, result.missing, result.seconds),
        _COUNTS.pack(len(result.parts), len(result.notes)),
    ]
    for polytope in result.parts + result.inner:
        blocks += (b"", b"") if polytope is None else polytope.to_mesh().to_bytes()
    for note in result.notes:
        blocks += [note.code.encode(), note.message.encode()]
    return pack_blocks(blocks)


def decode(data: bytes, settings: DecompositionSettings) -> Decomposition:
    """Raises ValueError unless `data` is what encode() makes."""
    blocks = unpack_blocks(data)
    try:
        outside, missing, seconds = _NUMBERS.unpack(blocks[0])
        part_count, note_count = _COUNTS.unpack(blocks[1])
    except (IndexError, struct.error) as error:
        raise ValueError("the head of the entry is malformed") from error
    if len(blocks) != 2 + 4 * part_count + 2 * note_count:
        raise ValueError(f"{len(blocks)} blocks for {part_count} parts and {note_count} notes")
    bodies = [
        Mesh.from_bytes(blocks[index], blocks[index + 1]).convex_hull() if blocks[index] else None
        for index in range(2, 2 + 4 * part_count, 2)
    ]
    parts = tuple(part for part in bodies[:part_count] if part is not None)
    if len(parts) != part_count:
        raise ValueError("a part is empty")
    notes = blocks[2 + 4 * part_count :]
    return Decomposition(
        parts=parts,
        inner=tuple(bodies[part_count:]),
        outside=outside,
        missing=missing,
        seconds=seconds,
        from_cache=True,
        settings=settings,
        notes=tuple(
            Note(code.decode(), message.decode())
            for code, message in zip(notes[0::2], notes[1::2], strict=True)
        ),
    )
