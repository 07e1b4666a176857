"""The flat facets of a mesh, and the ridges where two of them meet.

Neighbouring triangles in one plane are one facet, because the cut of a strip into triangles does
not change its shape.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from msgspec import Struct

from satcheck.core.rounding import rounding_pad

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

# A circle whose facets turn by this many radians is 1.25e-7 of its radius off them, about the
# precision of float32.
LEAST_TURN = 1e-3
# The error of a height above a plane through three points, in precisions. All four points are off
# by up to the precision in each coordinate, so the error is at most 4 sqrt(3), rounded up.
FLAT_STEPS = 8.0
# If the height of a triangle is less than this many precisions, its normal is mostly noise.
SLIVER_STEPS = 64.0
# Beyond this angle (57 degrees) a small triangle is a step, not an uneven spot.
MOST_UNEVEN = 1.0
# A strip of a curved surface has two neighbours, and a few more at trimmed ends. A facet with more
# neighbours than this is a face with rounded edges.
MOST_NEIGHBOURS = 64


class Facets(Struct, frozen=True):
    """Facets of a mesh, numbered from 0.

    points: (v, 3). triangles: (t, 3). of_triangle: (t,), the facet of each triangle. normals:
    (f, 3), unit length, or 0 if the facet has no area.
    """

    points: Floats
    triangles: Indices
    of_triangle: Indices
    normals: Floats

    @property
    def count(self) -> int:
        return len(self.normals)


class Ridges(Struct, frozen=True):
    """One ridge for each two facets that meet. It lies on one line and may consist of several
    edges.

    facets: (r, 2). angles: (r,) radians, between their normals. directions: (r, 3), unit length.
    widths: (r, 2), the extent of each facet from the ridge; inf for a face with too many neighbours
    to be a strip. edges: (e, 2), the vertices of the edges on ridges. of_edge: (e,).
    """

    facets: Indices
    angles: Floats
    directions: Floats
    widths: Floats
    edges: Indices
    of_edge: Indices


def facets_and_ridges(
    points: Floats, triangles: Indices, resolution: float
) -> tuple[Facets, Ridges]:
    """points: (v, 3) of a welded mesh, triangles: (t, 3). resolution: the precision of the
    coordinates, in their unit. An edge is on a ridge if it has two triangles with consistent
    orientation."""
    resolution = max(resolution, rounding_pad(float(np.abs(points).max(initial=0.0))))
    corners = points[triangles]
    edges, sides = _inner_edges(triangles)
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    sliver = np.linalg.norm(areas, axis=1) <= SLIVER_STEPS * resolution * longest
    normals = unit(areas)
    turns = angles_between(normals[sides[:, 0]], normals[sides[:, 1]])
    across = triangles[sides].sum(axis=2) - edges.sum(axis=1)[:, None]
    heights = (points[across] - points[edges[:, :1]]) * normals[sides[:, ::-1]]
    even = (np.abs(heights.sum(axis=2)) <= FLAT_STEPS * resolution).any(axis=1)
    flat = (turns <= LEAST_TURN) | (even & (turns <= MOST_UNEVEN))
    flat &= ~sliver[sides].any(axis=1)
    flat |= _at_longest_edge(points, edges, sides, sliver)
    of_triangle = components(len(triangles), sides[flat])
    facets = Facets(points, triangles, of_triangle, unit(sums_of(of_triangle, areas)))
    return facets, _ridges(facets, edges, sides)


def components(count: int, pairs: Indices) -> Indices:
    """(count,): the number of the connected component of each node, from 0. pairs: (n, 2)."""
    label = np.arange(count)
    while len(pairs):
        ends = label[pairs]
        np.minimum.at(label, ends, ends.min(axis=1, keepdims=True))
        while not np.array_equal(label, shorter := label[label]):
            label = shorter
        pairs = pairs[label[pairs[:, 0]] != label[pairs[:, 1]]]
    return np.unique(label, return_inverse=True)[1]


def unit(vectors: Floats) -> Floats:
    """(..., 3): the vectors scaled to length 1; zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    result = np.zeros_like(vectors)
    np.divide(vectors, lengths, out=result, where=lengths > 0)
    return result


def sums_of(group: Indices, vectors: Floats) -> Floats:
    """(g, 3): the sum of the vectors, (n, 3), of each group. group: (n,)."""
    sums = np.zeros((int(group.max(initial=-1)) + 1, 3))
    for k in range(3):
        sums[:, k] = np.bincount(group, vectors[:, k])
    return sums


def angles_between(first: Floats, second: Floats) -> Floats:
    """Angles between unit vectors, radians; accurate for small angles too."""
    half_sines = 0.5 * np.linalg.norm(first - second, axis=-1)
    angles: Floats = 2 * np.arcsin(np.minimum(half_sines, 1.0))
    return angles


def _inner_edges(triangles: Indices) -> tuple[Indices, Indices]:
    """Edges with two triangles that traverse them in opposite directions: (e, 2) vertices in the
    order of the first triangle, (e, 2) triangles."""
    half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    key = half.min(axis=1) * (int(triangles.max(initial=0)) + 1) + half.max(axis=1)
    order = np.argsort(key, kind="stable")
    _, starts, counts = np.unique(key[order], return_index=True, return_counts=True)
    first, second = order[starts[counts == 2]], order[starts[counts == 2] + 1]
    opposed = half[first, 0] == half[second, 1]
    first, second = first[opposed], second[opposed]
    return half[first], np.stack([first // 3, second // 3], axis=1)


def _at_longest_edge(points: Floats, edges: Indices, sides: Indices, sliver: Flags) -> Flags:
    """(e,): whether a sliver joins the facet of its neighbour at this edge, so that it hides no
    ridge."""
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    longest = np.zeros(len(sliver))
    np.maximum.at(longest, sides, lengths[:, None])
    at_longest: Flags = (sliver[sides] & (lengths[:, None] >= longest[sides])).any(axis=1)
    return at_longest


def _ridges(facets: Facets, edges: Indices, sides: Indices) -> Ridges:
    pairs = np.sort(facets.of_triangle[sides], axis=1)
    between = pairs[:, 0] != pairs[:, 1]
    pairs, edges = pairs[between], edges[between]
    lengths = np.linalg.norm(facets.points[edges[:, 0]] - facets.points[edges[:, 1]], axis=1)
    key = pairs[:, 0] * facets.count + pairs[:, 1]
    order = np.lexsort((-lengths, key))
    _, starts = np.unique(key[order], return_index=True)
    longest = order[starts]
    pairs, along = pairs[longest], facets.points[edges[longest]]
    directions = unit(along[:, 1] - along[:, 0])
    return Ridges(
        facets=pairs,
        angles=angles_between(facets.normals[pairs[:, 0]], facets.normals[pairs[:, 1]]),
        directions=directions,
        widths=_widths(facets, pairs, along[:, 0], directions),
        edges=edges,
        of_edge=np.searchsorted(key[longest], key),
    )


def _widths(facets: Facets, pairs: Indices, origins: Floats, directions: Floats) -> Floats:
    """(r, 2): the distance of the farthest corner of each facet from the line of the ridge."""
    order = np.argsort(facets.of_triangle, kind="stable")
    counts = np.bincount(facets.of_triangle)
    starts = np.cumsum(counts) - counts
    widths = np.full(pairs.shape, np.inf)
    neighbours = np.bincount(pairs.ravel(), minlength=facets.count)
    for side in (0, 1):
        # A row for each triangle of the facet.
        ridge = np.flatnonzero(neighbours[pairs[:, side]] <= MOST_NEIGHBOURS)
        facet = pairs[ridge, side]
        first = np.cumsum(counts[facet]) - counts[facet]
        row = np.repeat(np.arange(len(ridge)), counts[facet])
        triangle = order[np.arange(len(row)) - first[row] + starts[facet[row]]]
        of_row = ridge[row]
        offsets = facets.points[facets.triangles[triangle]] - origins[of_row, None]
        along = (offsets * directions[of_row, None]).sum(axis=2, keepdims=True)
        away = np.linalg.norm(offsets - along * directions[of_row, None], axis=2).max(axis=1)
        widths[ridge, side] = np.maximum.reduceat(away, first) if len(row) else 0.0
    return widths
