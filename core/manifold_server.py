"""The manifold3d server for core.worker: the only module that imports it, only in a child process.

Emmett Lalish's library computes Booleans of triangle meshes in float64, and its results are
manifolds. Vertices closer than its tolerance, about 1e-12 of the extent, may be merged, and thinner
parts may vanish.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, Literal

import msgspec

if TYPE_CHECKING:
    import manifold3d
    import numpy as np
    from numpy.typing import NDArray

# The largest change of a volume when manifold3d reads a mesh, in units of its tolerance times the
# area.
_SAME: Final = 4.0
Request = tuple[Literal["volume", "mesh"], list[bytes]]


def serve(request: bytes) -> bytes:
    """request: "volume" or "mesh", and two meshes as four blocks. The reply has `volume`, `error`,
    or the `mesh` of the overlap as two blocks, or `refused` and `which`.

    The pair is moved to the origin and scaled by a power of two to unit size, so that the tolerance
    is as small as possible. True lengths are those of the answer times 2^exponent. A mesh is moved
    back.
    """
    import numpy as np

    wanted, blocks = msgspec.msgpack.decode(request, type=Request)
    vertices = [np.frombuffer(block, dtype="<f8").reshape(-1, 3) for block in blocks[0::2]]
    triangles = [np.frombuffer(block, dtype="<u4").reshape(-1, 3) for block in blocks[1::2]]
    centre, exponent = _frame(vertices)
    solids, areas = [], []
    for which, (points, corners) in enumerate(zip(vertices, triangles, strict=True)):
        placed = np.ldexp(points - centre, -exponent)
        solid = _solid(placed, corners)
        if isinstance(solid, str):
            return _reply(refused=solid, which=which)
        solids.append(solid)
        areas.append(solid.surface_area())
    # A fault seldom hits two Booleans alike: then the parts of a solid do not make up the whole.
    for one, other in (solids, solids[::-1]):
        common = one ^ other
        if common.status().name != "NoError":
            return _reply(refused=common.status().name, which=None)
        if wanted == "mesh":
            mesh = common.to_mesh64()
            points = np.ldexp(np.asarray(mesh.vert_properties[:, :3]), exponent) + centre
            corners = np.asarray(mesh.tri_verts).astype("<u4")
            return _reply(mesh=[points.astype("<f8").tobytes(), corners.tobytes()])
        tolerance = max(common.get_tolerance(), *(solid.get_tolerance() for solid in solids))
        error = tolerance * sum(areas)
        if abs(common.volume() + (one - other).volume() - one.volume()) <= _SAME * error:
            return _reply(volume=common.volume(), error=error, exponent=exponent)
    return _reply(refused="volumes that contradict each other", which=None)


def _frame(vertices: list[NDArray[np.float64]]) -> tuple[NDArray[Any], int]:
    """(centre, e): the largest coordinate of (p - centre) / 2^e over all points p is in [1/2,
    1]."""
    import numpy as np

    low = np.min([points.min(axis=0) for points in vertices], axis=0) / 2.0
    high = np.max([points.max(axis=0) for points in vertices], axis=0) / 2.0
    return low + high, int(np.frexp((high - low).max())[1])


def _solid(points: NDArray[Any], corners: NDArray[Any]) -> manifold3d.Manifold | str:
    """The mesh as a Manifold, or the reason why it cannot be used."""
    import manifold3d
    import numpy as np

    points, corners = _one_edge_for_two(points, corners)
    solid = manifold3d.Manifold(manifold3d.Mesh64(points, corners.astype(np.uint64)))
    if solid.status().name != "NoError":
        return str(solid.status().name)
    p, q, r = (points[corners[:, k]] for k in range(3))
    volume = float(np.einsum("ij,ij->i", p, np.cross(q, r)).sum()) / 6.0
    if not volume > 0.0:
        return "InsideOut"
    # manifold3d may change a mesh while it reads it, but by no more than its tolerance.
    if abs(solid.volume() - volume) > _SAME * solid.get_tolerance() * solid.surface_area():
        return "Changed"
    return solid


def _one_edge_for_two(
    points: NDArray[Any], corners: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """The same solid, in which no edge has more than two triangles: manifold3d would pair those of
    a common edge by their numbers, so that surfaces cross there.

    Each wedge of material at such an edge gets a midpoint of its own, which cuts its two triangles.
    """
    import numpy as np

    starts, ends = corners.ravel(), corners[:, [1, 2, 0]].ravel()
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    edges, edge_of, uses = np.unique(
        low.astype(np.int64) << 32 | high, return_inverse=True, return_counts=True
    )
    if uses.max() <= 2:
        return points, corners
    midpoint: dict[int, int] = {}  # of a half-edge
    made: list[NDArray[Any]] = []
    order = np.argsort(edge_of, kind="stable")
    first = np.cumsum(uses) - uses
    for edge in np.flatnonzero(uses > 2):
        around = order[first[edge] : first[edge] + uses[edge]]
        for wedge in _wedges(points, corners, around, edges[edge] >> 32):
            for half_edge in wedge:
                midpoint[half_edge] = len(points) + len(made)
            made.append((points[low[wedge[0]]] + points[high[wedge[0]]]) / 2.0)
    cut = sorted({half_edge // 3 for half_edge in midpoint})
    pieces = []
    for t in cut:
        rim = []  # starts at a midpoint, so that no piece is a needle along an edge
        for k in range(3):
            rim.append(int(corners[t, k]))
            if 3 * t + k in midpoint:
                rim.append(midpoint[3 * t + k])
        while rim[0] < len(points):
            rim.append(rim.pop(0))
        pieces += [(rim[0], q, r) for q, r in pairwise(rim[1:])]
    whole = np.delete(corners, cut, axis=0)
    return np.vstack([points, made]), np.vstack([whole, np.array(pieces, dtype=corners.dtype)])


def _wedges(
    points: NDArray[Any], corners: NDArray[Any], around: NDArray[Any], low: int
) -> list[tuple[int, int]]:
    """The pairs of half-edges at one edge between which material lies. low: its first vertex."""
    import numpy as np

    triangle, side = np.divmod(around, 3)
    forward = corners[triangle, side] == low  # material ends here, seen with rising angle
    start, end = corners[triangle[0], side[0]], corners[triangle[0], (side[0] + 1) % 3]
    axis = (points[end] - points[start]) * (1.0 if forward[0] else -1.0)
    arms = points[corners[triangle, (side + 2) % 3]] - points[low]
    across = np.cross(axis, arms[0])
    angle = np.arctan2(arms @ across * np.linalg.norm(axis), arms @ np.cross(across, axis))
    # Where two walls lie in each other, the first one ends before the next begins.
    order = np.lexsort((~forward, angle))
    ways = [bool(forward[k]) for k in order]
    turn = next((k for k in range(len(ways)) if ways[k - 1] and not ways[k]), 0)
    open_, wedges = [], []
    for k in np.roll(order, -turn):
        if not forward[k]:
            open_.append(int(around[k]))
        elif open_:
            wedges.append((open_.pop(), int(around[k])))
    return wedges


def _reply(**answer: object) -> bytes:
    return msgspec.msgpack.encode(answer)
