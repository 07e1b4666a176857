"""Plain facts of a triangle surface in numpy: closed, cracked or holed; winding numbers; distances.

Alec Jacobson, Ladislav Kavan, Olga Sorkine-Hornung, "Robust Inside-Outside Segmentation using
Generalized Winding Numbers" (2013); the solid angle by Adriaan van Oosterom, Jan Strackee (1983).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]
Rim = Literal["closed", "mixed winding", "cracked", "holed"]

# A rim that lies within this part of the size of another stretch of rim bounds no area. Exporters
# that write six digits leave cracks as wide as that.
CRACK = 1e-5
_RIM_EDGES = 3000
_BLOCK = 2_000_000


@dataclass(frozen=True)
class Mesh:
    """vertices (n, 3), triangles (m, 3) as indices."""

    vertices: Points
    triangles: Triangles

    @property
    def corners(self) -> Points:
        """(m, 3, 3): triangle, corner, coordinate."""
        return self.vertices[self.triangles]

    @property
    def size(self) -> float:
        """The diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    def moved(self, matrix: Points) -> Mesh:
        """matrix: 4x4, world = matrix * point."""
        return Mesh(self.vertices @ matrix[:3, :3].T + matrix[:3, 3], self.triangles)


def area(mesh: Mesh) -> float:
    a, b, c = (mesh.corners[:, k] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def winding_numbers(mesh: Mesh, points: Points) -> Points:
    """(k,) for points (k, 3): 1 within a closed surface, 0 outside, between where it has holes."""
    totals = np.zeros(len(points))
    corners = mesh.corners
    step = max(1, _BLOCK // max(1, len(points)))
    for start in range(0, len(corners), step):
        block = corners[start : start + step]
        a, b, c = (block[None, :, k] - points[:, None] for k in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=2) for side in (a, b, c))
        top = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        bottom = (
            la * lb * lc
            + np.einsum("ijk,ijk->ij", a, b) * lc
            + np.einsum("ijk,ijk->ij", b, c) * la
            + np.einsum("ijk,ijk->ij", c, a) * lb
        )
        totals += np.arctan2(top, bottom).sum(axis=1)
    return totals / (2 * np.pi)


def distances(mesh: Mesh, points: Points) -> Points:
    """(k,): how far points (k, 3) are from the surface."""
    nearest = np.full(len(points), np.inf)
    corners = mesh.corners
    step = max(1, _BLOCK // max(1, len(points)))
    for start in range(0, len(corners), step):
        triangles = corners[start : start + step]
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        normals /= np.where(lengths > 0, lengths, 1)[:, None]
        height = np.abs(_dot(points[:, None] - triangles[:, 0], normals))
        over = np.broadcast_to(lengths > 0, height.shape)
        for k in range(3):
            tail, head = triangles[:, k], triangles[:, (k + 1) % 3]
            outward = np.cross(head - tail, normals)
            over = over & (_dot(points[:, None] - tail, outward) <= 0)
            nearest = np.minimum(nearest, _to_segments(points, tail, head).min(axis=1))
        nearest = np.minimum(nearest, np.where(over, height, np.inf).min(axis=1))
    return nearest


def _dot(u: Points, v: Points) -> Points:
    return np.asarray((u * v).sum(axis=-1))


def _to_segments(points: Points, tails: Points, heads: Points) -> Points:
    """(k, m): of points (k, 3) to segments (m, 3)."""
    along = heads - tails
    square = _dot(along, along)
    t = _dot(points[:, None] - tails, along) / np.where(square > 0, square, 1)
    nearest = tails + np.clip(t, 0, 1)[..., None] * along
    return np.asarray(np.linalg.norm(points[:, None] - nearest, axis=2))


def rim(mesh: Mesh) -> Points:
    """(k, 2, 3): the edges that are not run as often one way as the other, equal points as one."""
    edges, balance, _ = _edges(mesh)
    return np.asarray(edges[balance != 0])


def _edges(mesh: Mesh) -> tuple[Points, NDArray[np.int64], NDArray[np.int64]]:
    """Each edge (k, 2, 3), how much more often it is run one way, its number of triangles."""
    points, names = np.unique(mesh.vertices, axis=0, return_inverse=True)
    corners = names.reshape(-1)[mesh.triangles]
    runs = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    runs = runs[runs[:, 0] != runs[:, 1]]
    edges, which, counts = np.unique(
        np.sort(runs, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    ways = np.where(runs[:, 0] < runs[:, 1], 1, -1)
    balance = np.bincount(which.reshape(-1), ways, len(edges)).astype(np.int64)
    return points[edges], balance, counts


def rim_kind(mesh: Mesh) -> Rim:
    """`cracked`: there is a rim, and all of it runs along another stretch of rim. `mixed winding`:
    neighbours disagree about the side, and nothing else is wrong.

    An estimate by sampled points; of a rim of many thousand edges some are sampled.
    """
    every, balance, counts = _edges(mesh)
    loose = balance != 0
    if not loose.any():
        return "closed"
    if not (counts[loose] % 2).any():
        return "mixed winding"
    edges = every[loose]
    reach = CRACK * mesh.size
    for k in range(0, len(edges), max(1, len(edges) // _RIM_EDGES)):
        tail, head = edges[k]
        samples = tail + np.array([[0.2], [0.5], [0.8]]) * (head - tail)
        gaps = _to_segments(samples, edges[:, 0], edges[:, 1])
        gaps[:, k] = np.inf
        if float(gaps.min(axis=1).max()) > reach:
            return "holed"
    return "cracked"
