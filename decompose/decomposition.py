"""A concave mesh as convex parts: short cuts first, CoACD in a child process for the rest."""

from __future__ import annotations

import hashlib
import time
from dataclasses import replace
from typing import Final

from satcheck.core import Mesh, Polytope, Surface
from satcheck.core.worker import (
    WorkerError,
    WorkerOutOfMemory,
    WorkerTimeout,
    run_isolated,
)
from satcheck.decompose import errors
from satcheck.decompose.cache import Cache
from satcheck.decompose.coacd_server import decode_reply, encode_request
from satcheck.decompose.components import diagonal, independent_pieces
from satcheck.decompose.errors import DecompositionError
from satcheck.decompose.inner_parts import inner_parts
from satcheck.decompose.measure import missing_error, outside_error
from satcheck.decompose.result import (
    CACHE_UNAVAILABLE,
    FLAT_PARTS_DROPPED,
    OPEN_MESH,
    Decomposition,
    Note,
    decode,
    encode,
)
from satcheck.decompose.settings import DecompositionSettings

_SERVER: Final = "satcheck.decompose.coacd_server"
# Counted up when anything that decides the content of a cache entry changes, its layout included.
_SCHEMA: Final = b"satcheck-parts-1"
# A piece this close to its hull, in diagonals of its bounding box, is one part: CoACD's own cuts
# are no better (it moves them by up to 1e-4 to keep off vertices).
_CONVEX_ENOUGH: Final = 1e-4


def decompose(
    mesh: Mesh,
    *,
    threshold: float = 0.05,
    seed: int = 0,
    seconds: float = 120.0,
    megabytes: int = 4096,
    cache: Cache | None = None,
) -> Decomposition:
    """Splits a mesh into convex parts and measures by how much the two differ.

    mesh: a solid one, welded and oriented. Others are rebuilt from voxels by CoACD first, which is
        slow and thickens them; the notes say so.
    threshold, seed: see DecompositionSettings.
    seconds, megabytes: limits of the child process that runs CoACD, and of the wait for another
        process that is computing the same parts.
    cache: None computes.

    Exactly convex meshes and components never reach CoACD nor the cache. The same mesh, settings
    and version of CoACD give the same bits. Raises DecompositionError.
    """
    settings = DecompositionSettings(threshold=threshold, seed=seed)
    started = time.monotonic()
    mesh = mesh.welded()
    hull = _checked_hull(mesh)
    solid = mesh.topology().solid
    if solid and mesh.convexity_defect(0.0) == 0.0:
        parts = (hull,)
        return Decomposition(
            parts, parts, 0.0, 0.0, time.monotonic() - started, False, settings, ()
        )
    if cache is None:
        return _compute(mesh, settings, seconds, megabytes)
    return _cached(mesh, settings, seconds, megabytes, cache)


def cache_key(mesh: Mesh, settings: DecompositionSettings) -> bytes:
    """SHA-256 over everything that decides the parts: 32 bytes.

    The order of vertices and triangles counts, because CoACD's result depends on it.
    """
    from importlib.metadata import version  # not on the path of convex meshes

    digest = hashlib.sha256()
    for block in (
        _SCHEMA,
        version("coacd").encode(),
        settings.to_bytes(),
        *mesh.to_bytes(),
    ):
        digest.update(len(block).to_bytes(8, "little"))
        digest.update(block)
    return digest.digest()


def _checked_hull(mesh: Mesh) -> Polytope:
    if mesh.triangle_count == 0:
        raise DecompositionError(
            errors.EMPTY, "a mesh without triangles has no convex parts; check the file"
        )
    hull = mesh.convex_hull()
    if hull.dimension < 3:
        raise DecompositionError(
            errors.FLAT, "all points of the mesh lie in one plane, so it has no solid convex parts"
        )
    return hull


def _cached(
    mesh: Mesh, settings: DecompositionSettings, seconds: float, megabytes: int, cache: Cache
) -> Decomposition:
    key = cache_key(mesh, settings)
    found = _load(cache, key, settings)
    if found is not None:
        return found
    result = None
    try:
        with cache.single_flight(key, seconds):
            found = _load(cache, key, settings)  # from the process we waited for
            if found is not None:
                return found
            result = _compute(mesh, settings, seconds, megabytes)
            cache.store(key, encode(result))
            return result
    except OSError as error:  # TimeoutError included
        note = Note(CACHE_UNAVAILABLE, f"the parts were not cached: {error}")
    if result is None:
        result = _compute(mesh, settings, seconds, megabytes)
    return replace(result, notes=(*result.notes, note))


def _load(cache: Cache, key: bytes, settings: DecompositionSettings) -> Decomposition | None:
    payload = cache.load(key)
    if payload is None:
        return None
    try:
        return decode(payload, settings)
    except ValueError:  # written by something else under our key: a miss, replaced by the result
        return None


def _compute(
    mesh: Mesh, settings: DecompositionSettings, seconds: float, megabytes: int
) -> Decomposition:
    started = time.monotonic()
    notes = []
    solid = mesh.topology().solid
    if solid:
        parts, dropped = _parts_of_solid(mesh, settings, seconds, megabytes)
    else:
        notes.append(
            Note(
                OPEN_MESH,
                "the mesh is not a closed, consistently oriented surface: the parts are those of "
                "a thickened copy rebuilt from voxels, their error is measured against the surface",
            )
        )
        parts, dropped = _run_coacd([mesh], settings, seconds, megabytes, remesh=True)
    if not parts:
        raise DecompositionError(errors.BAD_OUTPUT, "CoACD returned no solid convex part")
    if dropped:
        notes.append(Note(FLAT_PARTS_DROPPED, f"{dropped} flat parts of CoACD's were dropped"))
    surface = Surface(mesh, solid)
    return Decomposition(
        parts=tuple(parts),
        inner=inner_parts(parts, surface) if solid else (None,) * len(parts),
        outside=outside_error(parts, surface, settings.threshold),
        missing=missing_error(mesh, parts),
        seconds=time.monotonic() - started,
        from_cache=False,
        settings=settings,
        notes=tuple(notes),
    )


def _parts_of_solid(
    mesh: Mesh, settings: DecompositionSettings, seconds: float, megabytes: int
) -> tuple[list[Polytope], int]:
    """(parts, number of flat ones dropped): convex pieces as they are, the others by CoACD."""
    parts, concave = [], []
    for piece in independent_pieces(mesh):
        limit = _CONVEX_ENOUGH * diagonal(piece)
        if piece.convexity_defect(limit) <= limit:
            parts.append(piece.convex_hull())
        else:
            concave.append(piece)
    if not concave:
        return parts, 0
    found, dropped = _run_coacd(concave, settings, seconds, megabytes, remesh=False)
    return parts + found, dropped


def _run_coacd(
    meshes: list[Mesh],
    settings: DecompositionSettings,
    seconds: float,
    megabytes: int,
    *,
    remesh: bool,
) -> tuple[list[Polytope], int]:
    """(parts, number of flat ones dropped)."""
    request = encode_request(settings, [mesh.to_bytes() for mesh in meshes], remesh=remesh)
    try:
        reply = run_isolated(_SERVER, request, seconds=seconds, megabytes=megabytes)
    except WorkerError as error:
        raise _explained(error) from error
    try:
        hulls = [Mesh.from_bytes(*part).convex_hull() for part in decode_reply(reply)]
    except ValueError as error:
        raise DecompositionError(
            errors.BAD_OUTPUT, f"CoACD returned parts that are no meshes: {error}"
        ) from error
    parts = [hull for hull in hulls if hull.dimension == 3]
    return parts, len(hulls) - len(parts)


def _explained(error: WorkerError) -> DecompositionError:
    """What became of the child, as a failure of the decomposition."""
    if isinstance(error, WorkerTimeout):
        return DecompositionError(
            errors.TIMEOUT,
            f"no convex parts after {error.seconds:g} s; raise the limit or the threshold",
        )
    if isinstance(error, WorkerOutOfMemory):
        return DecompositionError(
            errors.OUT_OF_MEMORY,
            f"the convex parts need more than {error.megabytes} MiB; raise the limit or the "
            "threshold",
        )
    code = errors.FAILED if error.code == "worker-failed" else errors.CRASHED
    return DecompositionError(code, f"CoACD gave no convex parts: {error.message}")
