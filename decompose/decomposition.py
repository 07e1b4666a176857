"""A concave mesh as convex parts: short cuts first, CoACD in a child process for the rest."""

from __future__ import annotations

import hashlib
import time
from typing import Final

import msgspec
from msgspec.structs import replace

from satcheck.core import Mesh, Polytope
from satcheck.decompose import errors
from satcheck.decompose.cache import Cache
from satcheck.decompose.errors import DecompositionError
from satcheck.decompose.result import CACHE_UNAVAILABLE, Decomposition, Note, decode, encode
from satcheck.decompose.settings import DecompositionSettings

# Counted up when anything that decides the content of a cache entry changes, its layout included.
_SCHEMA: Final = b"satcheck-parts-3"


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

    mesh: is welded, and oriented where it is a closed manifold. Others are rebuilt from voxels by
        CoACD first, which is slow and thickens them; the notes say so.
    threshold, seed: see DecompositionSettings.
    seconds: limit of all that, CoACD and the measuring of its parts, and of the wait for another
        process that is computing the same parts. megabytes: of the child process that runs CoACD.
    cache: None computes.

    Exactly convex meshes and components never reach CoACD nor the cache. The same mesh, settings
    and version of CoACD give the same bits. Raises DecompositionError.
    """
    settings = DecompositionSettings(threshold=threshold, seed=seed)
    started = time.monotonic()
    mesh = mesh.welded()
    if mesh.topology().manifold:
        mesh = mesh.oriented()
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
        msgspec.msgpack.encode(settings),
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
    cached = _load(cache, key, settings)
    if cached is not None:
        return cached
    result = None
    try:
        with cache.single_flight(key, seconds):
            cached = _load(cache, key, settings)  # from the process we waited for
            if cached is not None:
                return cached
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
    from satcheck.decompose.computation import compute  # numpy, not on the path of a cache hit

    return compute(mesh, settings, seconds, megabytes)
