"""Brute-force signed distance of two convex point sets, in float64, sharing no code with the core.

Penetration: the least overlap over every candidate axis, each projected in full over all vertices:
the face normals of both hulls and every edge-edge cross product, both signs, nothing pruned.
Every axis bounds the penetration from above, so a spare or badly rounded axis can do no harm.
Distance: every vertex against every face of the other, every edge against every edge.

Faces come from qhull (`scipy.spatial.ConvexHull`). Triangles that qhull gives one plane are one
face here; their inner diagonals are dropped. Flat inputs (point, segment, planar polygon) are
hulled in their own dimension.

World frame, lengths in the units of the points. Signed distance > 0 is a gap, < 0 a penetration.
The normal points from A to B.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

Points = NDArray[np.float64]

# Thinner than this fraction of the largest coordinate is flat. Test shapes are either flat to
# rounding (1e-16) or thicker than 1e-6.
FLAT = 1e-12


@dataclass(frozen=True, slots=True)
class Features:
    """What a convex point set has to offer as axes and as contact features.

    vertices (n, 3); normals (f, 3) unit, both signs for a flat set; edges (e, 2, 3) end points;
    triangles (t, 3, 3). A point has one edge of length zero.
    """

    vertices: Points
    normals: Points
    edges: Points
    triangles: Points


@dataclass(frozen=True, slots=True)
class SignedDistance:
    """distance > 0: gap, < 0: minus the penetration depth; normal: unit, from A to B."""

    distance: float
    normal: Points


def features(points: Points) -> Features:
    """Features of the convex hull of `points` (n, 3), n >= 1."""
    points = np.asarray(points, dtype=np.float64)
    centred = points - points[0]
    _, spread, axes = np.linalg.svd(centred, full_matrices=True)
    size = max(float(np.abs(points).max()), float(np.abs(centred).max()))
    dimension = int((spread > FLAT * size).sum())
    if dimension == 3:
        return _solid_features(points)
    if dimension == 2:
        return _polygon_features(points, centred @ axes[:2].T, axes[2])
    ends = points[[0, 0]]
    if dimension == 1:
        along = centred @ axes[0]
        ends = points[[int(along.argmin()), int(along.argmax())]]
    empty = np.empty((0, 3))
    return Features(ends, empty, ends[None], np.empty((0, 3, 3)))


def _solid_features(points: Points) -> Features:
    hull = ConvexHull(points)
    planes, plane_of = np.unique(hull.equations, axis=0, return_inverse=True)
    owner: dict[tuple[int, int], set[int]] = {}
    for triangle, plane in zip(hull.simplices, np.ravel(plane_of), strict=True):
        for i in range(3):
            tail, head = sorted((int(triangle[i]), int(triangle[i - 1])))
            owner.setdefault((tail, head), set()).add(int(plane))
    edges = [ends for ends, faces in owner.items() if len(faces) > 1]
    return Features(
        points[hull.vertices], planes[:, :3], points[np.array(edges)], points[hull.simplices]
    )


def _polygon_features(points: Points, flat: Points, normal: Points) -> Features:
    loop = points[ConvexHull(flat).vertices]
    edges = np.stack([loop, np.roll(loop, -1, axis=0)], axis=1)
    fan = np.stack([np.stack([loop[0], loop[i], loop[i + 1]]) for i in range(1, len(loop) - 1)])
    return Features(loop, np.stack([normal, -normal]), edges, fan)


def penetration(a: Features, b: Features) -> SignedDistance | None:
    """The least overlap over all axes, or None when some axis shows a gap (or just contact).

    A Minkowski difference without volume (two parallel polygons, two segments, ...) has no
    interior: its penetration is never positive, None is returned.
    """
    edge_a = a.edges[:, 1] - a.edges[:, 0]
    edge_b = b.edges[:, 1] - b.edges[:, 0]
    spread = np.linalg.svd(np.concatenate([edge_a, edge_b]), compute_uv=False)
    if len(spread) < 3 or spread[2] <= FLAT * spread[0]:
        return None
    crosses = np.cross(edge_a[:, None], edge_b[None]).reshape(-1, 3)
    axes = np.concatenate([a.normals, b.normals, crosses])
    length = np.linalg.norm(axes, axis=1)
    axes = axes[length > 0] / length[length > 0, None]
    if len(axes) == 0:
        return None
    axes = np.concatenate([axes, -axes])
    origin = a.vertices[0]
    overlap = ((a.vertices - origin) @ axes.T).max(0) - ((b.vertices - origin) @ axes.T).min(0)
    best = int(overlap.argmin())
    if overlap[best] <= 0:
        return None
    return SignedDistance(-float(overlap[best]), axes[best])


def _point_segment(points: Points, segments: Points) -> tuple[Points, Points]:
    """Squared distances (n, e) and closest points (n, e, 3)."""
    tail = segments[None, :, 0]
    along = segments[None, :, 1] - tail
    squared = (along**2).sum(-1)
    t = ((points[:, None] - tail) * along).sum(-1) / np.where(squared > 0, squared, 1)
    closest = tail + np.clip(t, 0, 1)[..., None] * along
    return ((points[:, None] - closest) ** 2).sum(-1), closest


def _point_face(points: Points, triangles: Points) -> tuple[Points, Points]:
    """Squared distances (n, t), inf where the foot lies outside the triangle, and feet."""
    p, q, r = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(q - p, r - p)
    area = np.linalg.norm(normal, axis=1)
    unit = normal / area[:, None]
    height = ((points[:, None] - p) * unit).sum(-1)
    foot = points[:, None] - height[..., None] * unit
    inside = np.ones(height.shape, dtype=bool)
    for u, v in ((p, q), (q, r), (r, p)):
        inside &= (np.cross(v - u, foot - u) * unit).sum(-1) >= 0
    return np.where(inside, height**2, np.inf), foot


def _edge_edge(a: Points, b: Points) -> tuple[Points, Points, Points]:
    """Squared distances (e, f) of the inner closest points of line pairs, inf where not inner."""
    tail_a, tail_b = a[:, None, 0], b[None, :, 0]
    u, v, w = a[:, None, 1] - tail_a, b[None, :, 1] - tail_b, tail_b - tail_a
    uu, vv, uv = (u * u).sum(-1), (v * v).sum(-1), (u * v).sum(-1)
    uw, vw = (u * w).sum(-1), (v * w).sum(-1)
    det = uu * vv - uv * uv
    safe = np.where(det > 0, det, 1)
    s, t = (uw * vv - vw * uv) / safe, (uw * uv - vw * uu) / safe
    inner = (det > 0) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    on_a = tail_a + s[..., None] * u
    on_b = tail_b + t[..., None] * v
    return np.where(inner, ((on_b - on_a) ** 2).sum(-1), np.inf), on_a, on_b


def distance(a: Features, b: Features) -> tuple[float, Points, Points]:
    """Smallest distance between features, its points on A and on B. The sets must not overlap."""
    origin = a.vertices[0]  # everything relative to a nearby point: no digits lost far away
    va, vb = a.vertices - origin, b.vertices - origin
    ea, eb = a.edges - origin, b.edges - origin
    candidates: list[tuple[float, Points, Points]] = []

    def offer(squared: Points, on_a: Points, on_b: Points) -> None:
        if squared.size:
            i = np.unravel_index(int(squared.argmin()), squared.shape)
            candidates.append((float(squared[i]), on_a[i], on_b[i]))

    for points, edges, swap in ((vb, ea, False), (va, eb, True)):
        squared, closest = _point_segment(points, edges)
        own = np.broadcast_to(points[:, None], closest.shape)
        offer(squared, *((own, closest) if swap else (closest, own)))
    for points, triangles, swap in ((vb, a.triangles, False), (va, b.triangles, True)):
        if len(triangles):
            squared, closest = _point_face(points, triangles - origin)
            own = np.broadcast_to(points[:, None], closest.shape)
            offer(squared, *((own, closest) if swap else (closest, own)))
    offer(*_edge_edge(ea, eb))
    squared_distance, on_a, on_b = min(candidates, key=lambda candidate: candidate[0])
    return float(np.sqrt(squared_distance)), on_a + origin, on_b + origin


def signed_distance(points_a: Points, points_b: Points) -> SignedDistance:
    """Signed distance of the convex hulls of two point sets (n, 3), (m, 3)."""
    a, b = features(points_a), features(points_b)
    overlap = penetration(a, b)
    if overlap is not None:
        return overlap
    gap, on_a, on_b = distance(a, b)
    normal = (on_b - on_a) / gap if gap > 0 else np.zeros(3)
    return SignedDistance(gap, normal)
