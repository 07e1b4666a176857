"""Splits a mesh into convex parts: convex meshes directly, others with CoACD in a child process."""

from __future__ import annotations

import hashlib
import time
from typing import Final

import msgspec
from msgspec.structs import replace

from satcheck.core import Mesh, Polytope
from satcheck.core.mesh_arrays import MeshLike, arrays_of, require_usable
from satcheck.decompose import errors
from satcheck.decompose.cache import Cache
from satcheck.decompose.components import oriented
from satcheck.decompose.computation import compute, held_against
from satcheck.decompose.errors import DecompositionError
from satcheck.decompose.result import CACHE_UNAVAILABLE, Decomposition, Note, decode, encode
from satcheck.decompose.settings import DecompositionSettings

# Increase it if the content or the layout of cache entries changes.
_SCHEMA: Final = b"satcheck-parts-4"


def decompose(
    mesh: Mesh | MeshLike,
    *,
    threshold: float = 0.05,
    seed: int = 0,
    seconds: float = 120.0,
    megabytes: int = 4096,
    cache: Cache | None = None,
) -> Decomposition:
    """Splits a mesh into convex parts and measures their error.

    mesh: of the core, or any that `satcheck.check_meshes` takes. It is welded; a closed manifold is
        also oriented. CoACD rebuilds other meshes from voxels first, which is slow and thickens
        them; a note says so.
    threshold, seed: see DecompositionSettings.
    seconds: limit for CoACD and the measurement of its parts together, and for the wait for another
        process that computes the same parts. megabytes: limit of the child process of CoACD.
    cache: None: always compute.

    Exactly convex meshes and components use neither CoACD nor the cache. The same mesh, settings
    and version of CoACD give the same bits. Raises DecompositionError.
    """
    settings = DecompositionSettings(threshold=threshold, seed=seed)
    started = time.monotonic()
    mesh = oriented(mesh if isinstance(mesh, Mesh) else _mesh_of(mesh))
    hull = _checked_hull(mesh)
    solid = mesh.topology().solid
    if solid and mesh.convexity_defect(0.0) == 0.0:
        parts = (hull,)
        return Decomposition(
            parts, parts, 0.0, 0.0, time.monotonic() - started, False, settings, ()
        )
    if cache is None:
        return compute(mesh, settings, seconds, megabytes)
    return _cached(mesh, settings, seconds, megabytes, cache)


def _mesh_of(mesh: MeshLike) -> Mesh:
    vertices, faces = arrays_of(mesh)
    require_usable(vertices, faces)
    return Mesh(vertices.astype("<f8"), faces.astype("<u4"))


def cache_key(mesh: Mesh, settings: DecompositionSettings) -> bytes:
    """SHA-256 of everything that the parts depend on: 32 bytes.

    The order of vertices and triangles counts, because CoACD's result depends on it.
    """
    from importlib.metadata import version  # slow import, which convex meshes do not need

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
    cached = _load(cache, key, mesh, settings, seconds)
    if cached is not None:
        return cached
    result = None
    try:
        with cache.single_flight(key, seconds):
            # Written by the process that held the lock.
            cached = _load(cache, key, mesh, settings, seconds)
            if cached is not None:
                return cached
            result = compute(mesh, settings, seconds, megabytes)
            cache.store(key, encode(result))
            return result
    except OSError as error:  # includes TimeoutError
        note = Note(CACHE_UNAVAILABLE, f"the parts were not cached: {error}")
    if result is None:
        result = compute(mesh, settings, seconds, megabytes)
    return replace(result, notes=(*result.notes, note))


def _load(
    cache: Cache, key: bytes, mesh: Mesh, settings: DecompositionSettings, seconds: float
) -> Decomposition | None:
    """None: there is no entry, or one that is not of this mesh, which is replaced."""
    payload = cache.load(key)
    if payload is None:
        return None
    try:
        stored = decode(payload)
    except (ValueError, OverflowError):  # not written by satcheck
        return None
    return held_against(mesh, stored, settings, seconds)
