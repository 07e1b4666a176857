"""The CoACD server for core.worker: the only module that imports coacd, only in a child process.

Xinyue Wei, Minghua Liu, Zhan Ling, Hao Su, "Approximate Convex Decomposition for 3D Meshes with
Collision-Aware Concavity and Tree Search" (2022), in the authors' implementation.

CoACD aborts on very small meshes and its search depends on the scale, so each mesh is moved to the
origin and scaled by a power of two to unit size. The scaling is exact both ways: a mesh scaled by
2^k gives parts scaled by exactly 2^k.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core import Mesh
from satcheck.decompose.result import MeshBytes
from satcheck.decompose.settings import DecompositionSettings


class _Piece(Struct, frozen=True):
    """manifold: closed, and each edge has two triangles. CoACD would crash on other meshes, so they
    are rebuilt from voxels first."""

    mesh: MeshBytes
    manifold: bool


class _Request(Struct, frozen=True):
    settings: DecompositionSettings
    pieces: list[_Piece]


def encode_request(settings: DecompositionSettings, meshes: Sequence[Mesh]) -> bytes:
    pieces = [_Piece(mesh.to_bytes(), mesh.topology().manifold) for mesh in meshes]
    return msgspec.msgpack.encode(_Request(settings, pieces))


def decode_reply(reply: bytes) -> list[MeshBytes]:
    """The parts of all meshes, in order. Raises ValueError on a malformed reply."""
    return msgspec.msgpack.decode(reply, type=list[MeshBytes])


def serve(message: bytes) -> bytes:
    import coacd  # type: ignore[import-untyped]

    coacd.set_log_level("off")
    request = msgspec.msgpack.decode(message, type=_Request)
    settings = request.settings
    parts: list[MeshBytes] = []
    for piece in request.pieces:
        vertices = np.frombuffer(piece.mesh[0], dtype="<f8").reshape(-1, 3)
        triangles = np.frombuffer(piece.mesh[1], dtype="<u4").reshape(-1, 3)
        centre, exponent = _unit_frame(vertices)
        hulls = coacd.run_coacd(
            coacd.Mesh(np.ldexp(vertices - centre, -exponent), triangles.astype(np.int32)),
            threshold=settings.threshold,
            preprocess_mode="off" if piece.manifold else "auto",
            resolution=settings.resolution,
            mcts_nodes=settings.mcts_nodes,
            mcts_iterations=settings.mcts_iterations,
            seed=settings.seed,
        )
        for points, corners in hulls:
            placed = np.ldexp(points, exponent) + centre
            parts.append((placed.astype("<f8").tobytes(), corners.astype("<u4").tobytes()))
    return msgspec.msgpack.encode(parts)


def _unit_frame(vertices: NDArray[np.float64]) -> tuple[NDArray[Any], int]:
    """(centre, e): the largest coordinate of (vertices - centre) / 2^e is in [1/2, 1]."""
    # Halved first, so that no coordinate can overflow.
    low, high = vertices.min(axis=0) / 2.0, vertices.max(axis=0) / 2.0
    exponent = int(np.frexp((high - low).max())[1])
    return high + low, exponent
