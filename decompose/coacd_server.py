"""CoACD behind core.worker: the only module that imports coacd, and only ever in a child process.

Xinyue Wei, Minghua Liu, Zhan Ling, Hao Su, "Approximate Convex Decomposition for 3D Meshes with
Collision-Aware Concavity and Tree Search" (2022), in the authors' implementation.

CoACD aborts on very small meshes and its search depends on the scale, so each mesh is moved to the
origin and scaled by a power of two to unit size. The scaling is exact both ways: a mesh scaled by
2^k gives parts scaled by exactly 2^k.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from satcheck.core import Mesh
from satcheck.core.blocks import pack_blocks, unpack_blocks
from satcheck.decompose.settings import DecompositionSettings

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_MANIFOLD: Final = b"manifold"
_NOT_MANIFOLD: Final = b"not manifold"


def encode_request(settings: DecompositionSettings, meshes: Sequence[Mesh]) -> bytes:
    """Meshes that are no closed manifolds are rebuilt from voxels by CoACD: it crashes on them."""
    blocks = [settings.to_bytes()]
    for mesh in meshes:
        blocks += [_MANIFOLD if mesh.topology().manifold else _NOT_MANIFOLD, *mesh.to_bytes()]
    return pack_blocks(blocks)


def decode_reply(reply: bytes) -> list[tuple[bytes, bytes]]:
    """The parts of all meshes, in order. Raises ValueError on a malformed reply."""
    blocks = unpack_blocks(reply)
    return list(zip(blocks[0::2], blocks[1::2], strict=True))


def serve(request: bytes) -> bytes:
    import coacd  # type: ignore[import-untyped]
    import numpy as np

    coacd.set_log_level("off")
    settings_block, *mesh_blocks = unpack_blocks(request)
    settings = DecompositionSettings.from_bytes(settings_block)
    blocks = []
    for kind, vertex_block, triangle_block in zip(
        mesh_blocks[0::3], mesh_blocks[1::3], mesh_blocks[2::3], strict=True
    ):
        vertices = np.frombuffer(vertex_block, dtype="<f8").reshape(-1, 3)
        triangles = np.frombuffer(triangle_block, dtype="<u4").reshape(-1, 3)
        centre, exponent = _unit_frame(vertices)
        parts = coacd.run_coacd(
            coacd.Mesh(np.ldexp(vertices - centre, -exponent), triangles.astype(np.int32)),
            threshold=settings.threshold,
            preprocess_mode="off" if kind == _MANIFOLD else "auto",
            resolution=settings.resolution,
            mcts_nodes=settings.mcts_nodes,
            mcts_iterations=settings.mcts_iterations,
            seed=settings.seed,
        )
        for part_vertices, part_triangles in parts:
            blocks.append((np.ldexp(part_vertices, exponent) + centre).astype("<f8").tobytes())
            blocks.append(part_triangles.astype("<u4").tobytes())
    return pack_blocks(blocks)


def _unit_frame(vertices: NDArray[np.float64]) -> tuple[NDArray[Any], int]:
    """(centre, e): (vertices - centre) / 2^e has its largest coordinate in [1/2, 1]."""
    import numpy as np

    # Halves first, so that no coordinate can overflow.
    low, high = vertices.min(axis=0) / 2.0, vertices.max(axis=0) / 2.0
    exponent = int(np.frexp((high - low).max())[1])
    return high + low, exponent
