"""Contact points of two bodies whose surfaces are within a tolerance of each other.

Exact contacts do not suffice for forces: a turned box misses its table by 1e-17. So a contact is a
vertex near a face, or an edge near an edge across it, with a normal that separates the two bodies
there. A patch comes out as its extreme points, and forces at other points of a patch are mixtures
of theirs. Where edges are parallel, or corners meet, the vertices give the extreme normals.
"""

from __future__ import annotations

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.statics.features import Features
from satcheck.audit.statics.near import Flags, Floats, Indices, cross, near_boxes

# Edges whose directions differ by less than this sine are parallel: their vertices decide.
PARALLEL = 1e-6
# The contacts of a patch with no more than so many points stay as they are.
PLAIN_PATCH = 8
# With more pairs of near features the tolerance is not small beside the facets.
MOST_NEAR = 500_000


class Points(Struct, frozen=True):
    """Contact points of A and B. at: (n, 3) world. normals: (n, 3) unit, from B to A: a force along
    them pushes A away from B. heights: (n,) of A over B along the normal; below 0: an overlap.
    strict: (n,) the contact is as near as the nearest one, and no tolerance bends its normal or
    widens its place."""

    at: Floats
    normals: Floats
    heights: Floats
    strict: Flags

    def __len__(self) -> int:
        return len(self.at)

    def turned(self) -> Points:
        """The same contacts of B and A."""
        return replace(self, normals=-self.normals)

    def among(self, rows: Indices | Flags) -> Points:
        """Some of the contacts."""
        return Points(*(getattr(self, name)[rows] for name in self.__struct_fields__))


NOBODY = Points(np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0, dtype=bool))


def contact_points(a: Features, b: Features, tolerance: float, rounding: float) -> Points:
    """The contacts of two closed meshes within the tolerance. rounding: how far coordinates may be
    off by themselves; strict contacts are no farther than that beyond the nearest one. Raises
    TooManyNear if the tolerance is too large for meshes this fine."""
    parts = [
        _vertices_on_faces(a, b, tolerance, rounding),
        _vertices_on_faces(b, a, tolerance, rounding, turned=True),
        _edges_on_edges(a, b, tolerance, rounding),
    ]
    parts = [part for part in parts if len(part)]
    return extreme(joined(parts), rounding) if parts else NOBODY


def joined(parts: list[Points]) -> Points:
    """Contacts of one pair together; the nearest of all decides which are strict."""
    if not parts:
        return NOBODY
    columns = ([getattr(part, name) for part in parts] for name in Points.__struct_fields__)
    return Points(*map(np.concatenate, columns))


def extreme(points: Points, rounding: float) -> Points:
    """Each contact once, and only those as near as the nearest one strict."""
    nearest = points.heights[points.strict].min(initial=np.inf)
    strict = points.strict & (points.heights <= nearest + 2 * rounding)
    # Contacts of the same place and normal: the strict ones first.
    keys = np.column_stack(
        [np.round(points.at / (4 * rounding)), np.round(points.normals * 1e7), ~strict]
    )
    order = np.lexsort(keys.T[::-1])
    ordered = keys[order][:, :6]
    first = np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)]
    kept = _corners_of_patches(points, order[first], strict, rounding)
    return replace(points, strict=strict).among(kept)


def _corners_of_patches(points: Points, kept: Indices, strict: Flags, rounding: float) -> Indices:
    """Of contacts in one plane with one normal only the corners of their hull: forces at the others
    are mixtures of forces at these."""
    if len(kept) <= PLAIN_PATCH:
        return np.sort(kept)
    at, normals = points.at[kept], points.normals[kept]
    plane = np.einsum("ci,ci->c", at, normals)
    keys = np.column_stack(
        [np.round(normals * 1e7), np.round(plane / (4 * rounding)), strict[kept]]
    )
    _, patch = np.unique(keys, axis=0, return_inverse=True)
    order = np.argsort(patch.reshape(-1), kind="stable")
    starts = np.flatnonzero(np.diff(patch.reshape(-1)[order])) + 1
    corners = []
    for of_patch in np.split(kept[order], starts):
        if len(of_patch) > PLAIN_PATCH:
            of_patch = of_patch[_hull(points.at[of_patch], points.normals[of_patch[0]])]
        corners.append(of_patch)
    return np.sort(np.concatenate(corners))


def _hull(at: Floats, normal: Floats) -> Indices:
    """The corners of the hull of points in a plane: A. M. Andrew (1979). Near collinear points may
    stay."""
    u = cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    flat = np.column_stack([at @ u, at @ cross(normal, u)])
    order = np.lexsort(flat.T[::-1]).tolist()
    x, y = flat[:, 0].tolist(), flat[:, 1].tolist()
    corners: list[int] = []
    for run in (order, order[::-1]):
        chain: list[int] = []
        for k in run:
            while len(chain) > 1:
                i, j = chain[-2:]
                if (x[j] - x[i]) * (y[k] - y[i]) - (y[j] - y[i]) * (x[k] - x[i]) > 0:
                    break
                chain.pop()
            chain.append(k)
        corners += chain[:-1]
    return np.array(sorted(set(corners)), dtype=np.int64)


def _vertices_on_faces(
    a: Features, b: Features, tolerance: float, rounding: float, *, turned: bool = False
) -> Points:
    """Vertices of A over faces of B."""
    corners = b.corners
    used = a.neighbours[a.first[:-1][a.first[:-1] < a.first[1:]], 0]
    at = a.points[used]
    i, j = near_boxes(at, at, corners.min(axis=1), corners.max(axis=1), tolerance, MOST_NEAR)
    i = used[i]
    n = b.normals[j]
    facing = np.einsum("ci,ci->c", n, a.point_normals[i]) < 0
    i, j, n = i[facing], j[facing], n[facing]
    foot = nearest_on_triangles(a.points[i], corners[j])
    step = a.points[i] - foot
    height = np.einsum("ci,ci->c", n, step)
    aside = np.linalg.norm(step - n * height[:, None], axis=1)
    near = np.einsum("ci,ci->c", step, step) <= tolerance * tolerance
    i, n, foot, height, aside = i[near], n[near], foot[near], height[near], aside[near]
    lowest = _lowest_neighbour(a, i, n)
    kept = lowest >= -2 * tolerance
    strict = (lowest >= -2 * rounding) & (aside <= rounding)
    points = Points(foot, n, height, strict).among(kept)
    return points.turned() if turned else points


def _lowest_neighbour(a: Features, vertices: Indices, normals: Floats) -> Floats:
    """How far the lowest neighbour of each vertex lies over it, along the normal."""
    counts = a.first[vertices + 1] - a.first[vertices]
    if not len(vertices):
        return np.empty(0)
    starts = np.cumsum(counts) - counts
    place = np.repeat(a.first[vertices] - starts, counts) + np.arange(counts.sum())
    step = a.points[a.neighbours[place, 1]] - a.points[a.neighbours[place, 0]]
    heights = np.einsum("ci,ci->c", step, np.repeat(normals, counts, axis=0))
    lowest: Floats = np.minimum.reduceat(heights, starts)
    return lowest


def _edges_on_edges(a: Features, b: Features, tolerance: float, rounding: float) -> Points:
    """Convex edges of A across convex edges of B."""
    of_a, of_b = a.points[a.ends], b.points[b.ends]
    i, j = near_boxes(
        of_a.min(axis=1),
        of_a.max(axis=1),
        of_b.min(axis=1),
        of_b.max(axis=1),
        tolerance,
        MOST_NEAR,
    )
    if not i.size:
        return NOBODY
    p, q = of_a[i], of_b[j]
    u, v = p[:, 1] - p[:, 0], q[:, 1] - q[:, 0]
    lengths = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    n = cross(u, v)
    sine = np.linalg.norm(n, axis=1)
    crossing = sine > PARALLEL * lengths
    i, j, p, q, u, v = i[crossing], j[crossing], p[crossing], q[crossing], u[crossing], v[crossing]
    n = n[crossing] / sine[crossing, None]
    # The normal points from B to A, away from the material of both.
    out = np.einsum("ci,ci->c", n, b.edge_normals[j] - a.edge_normals[i])
    n = n * np.where(out < 0, -1.0, 1.0)[:, None]
    s, t = _nearest_on_lines(p[:, 0], u, q[:, 0], v)
    on_a = p[:, 0] + u * np.clip(s, 0.0, 1.0)[:, None]
    on_b = q[:, 0] + v * np.clip(t, 0.0, 1.0)[:, None]
    step = on_a - on_b
    height = np.einsum("ci,ci->c", n, step)
    aside = np.linalg.norm(step - n * height[:, None], axis=1)
    low_a = np.einsum("ckj,cj->ck", a.points[a.wings[i]] - p[:, :1], n).min(axis=1)
    high_b = np.einsum("ckj,cj->ck", b.points[b.wings[j]] - q[:, :1], n).max(axis=1)
    outward = (np.einsum("ci,ci->c", n, a.edge_normals[i]) < 0) & (
        np.einsum("ci,ci->c", n, b.edge_normals[j]) > 0
    )
    depth = np.maximum(-low_a, high_b)
    kept = outward & (np.einsum("ci,ci->c", step, step) <= tolerance**2) & (depth <= 2 * tolerance)
    strict = (depth <= 2 * rounding) & (aside <= rounding)
    return Points(0.5 * (on_a + on_b), n, height, strict).among(kept)


def _nearest_on_lines(p: Floats, u: Floats, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Where the lines p + s u and q + t v, which are not parallel, are nearest."""
    w = p - q
    uu, uv, vv = (np.einsum("ci,ci->c", x, y) for x, y in ((u, u), (u, v), (v, v)))
    uw, vw = np.einsum("ci,ci->c", u, w), np.einsum("ci,ci->c", v, w)
    across = cross(u, v)
    area = np.einsum("ci,ci->c", across, across)
    return np.asarray((uv * vw - vv * uw) / area), np.asarray((uu * vw - uv * uw) / area)


def nearest_on_triangles(points: Floats, corners: Floats) -> Floats:
    """The nearest point of triangle k to point k. points: (n, 3), corners: (n, 3, 3).

    C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5, for many triangles: the
    foot on the plane if it is inside, else the nearest of three edges.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac = b - a, c - a
    n = cross(ab, ac)
    step = points - a
    area = np.einsum("ci,ci->c", n, n)
    over = np.einsum("ci,ci->c", n, step) / area
    foot = points - n * over[:, None]
    inside = np.ones(len(points), dtype=bool)
    best, nearest = foot, np.full(len(points), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        along = q - p
        inside &= np.einsum("ci,ci->c", cross(along, foot - p), n) >= 0
        share = np.einsum("ci,ci->c", points - p, along) / np.einsum("ci,ci->c", along, along)
        on_edge = p + along * np.clip(share, 0.0, 1.0)[:, None]
        away = points - on_edge
        squared = np.einsum("ci,ci->c", away, away)
        closer = squared < nearest
        nearest = np.where(closer, squared, nearest)
        best = np.where(closer[:, None], on_edge, best)
    return np.asarray(np.where(inside[:, None], foot, best))


def ball_on_mesh(
    centre: Floats, radius: float, mesh: Features, tolerance: float, rounding: float
) -> Points:
    """Return the contacts of a ball (A) with a mesh (B), whose surface the centre is outside of:
    one for each nearest point of it. That needs no tolerance of place, because the normal is the
    line to the centre."""
    corners = mesh.corners
    reach = radius + tolerance
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = np.flatnonzero(((low <= centre + reach) & (high >= centre - reach)).all(axis=1))
    if not near.size:
        return NOBODY
    foot = nearest_on_triangles(np.broadcast_to(centre, (near.size, 3)), corners[near])
    step = centre - foot
    distance = np.linalg.norm(step, axis=1)
    outside = np.einsum("ci,ci->c", step, mesh.normals[near]) > 0
    kept = (np.abs(distance - radius) <= tolerance) & outside & (distance > 0)
    near, foot, step, distance = near[kept], foot[kept], step[kept], distance[kept]
    n = step / distance[:, None]
    # A foot on an edge or a vertex is nearest only if all faces there lie behind the normal.
    behind = np.ones(near.size, dtype=bool)
    for k in range(near.size):
        shares = np.linalg.norm(foot - foot[k], axis=1) <= rounding
        heights = np.einsum("tci,i->tc", corners[near[shares]] - foot[k], n[k])
        behind[k] = heights.max() <= 2 * rounding
    return extreme(_strict(foot[behind], n[behind], distance[behind] - radius), rounding)


def ball_on_ball(
    centre: Floats, radius: float, other: Floats, other_radius: float, tolerance: float
) -> Points:
    """The contact of two balls, the first of which is A."""
    step = centre - other
    distance = float(np.linalg.norm(step))
    height = distance - radius - other_radius
    if abs(height) > tolerance or distance == 0:
        return NOBODY
    n = step / distance
    at = other + n * (other_radius + 0.5 * height)
    return _strict(at[None], n[None], np.array([height]))


def _strict(at: Floats, normals: Floats, heights: Floats) -> Points:
    return Points(at, normals, heights, np.ones(len(at), dtype=bool))
