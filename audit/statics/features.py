"""What a closed mesh can touch others with: its vertices, its convex edges, its faces."""

from __future__ import annotations

import numpy as np
from msgspec import Struct

from satcheck.audit.statics.near import Floats, Indices, cross

FLAT = 1e-9  # the sine of an angle below which two faces are one plane


class Features(Struct, frozen=True):
    """World frame. points: (v, 3). faces: (t, 3) indices of points, without those that have no
    area. normals: (t, 3) unit, outward. ends: (e, 2) points of the edges between two faces that are
    convex. wings: (e, 2) the points of both faces opposite to the edge. edge_normals: (e, 3)
    outward. point_normals: (v, 3) outward, the sum of those of the faces by their angles.
    neighbours: (h, 2) each point with each of its neighbours, sorted; first: (v + 1,) where those
    of a point begin."""

    points: Floats
    faces: Indices
    normals: Floats
    ends: Indices
    wings: Indices
    edge_normals: Floats
    point_normals: Floats
    neighbours: Indices
    first: Indices

    @property
    def corners(self) -> Floats:
        """(t, 3, 3)"""
        return self.points[self.faces]


def features_of(points: Floats, triangles: Indices) -> Features:
    corners = points[triangles]
    across = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    sound = size > 0
    faces, normals = triangles[sound], across[sound] / size[sound, None]
    ends, wings, edge_normals = _convex_edges(points, faces, normals)
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    both = np.unique(np.concatenate([pairs, pairs[:, ::-1]]), axis=0)
    return Features(
        points,
        faces,
        normals,
        ends,
        wings,
        edge_normals,
        _point_normals(points, faces, normals),
        both,
        np.searchsorted(both[:, 0], np.arange(len(points) + 1)),
    )


def _convex_edges(
    points: Floats, faces: Indices, normals: Floats
) -> tuple[Indices, Indices, Floats]:
    """Edges that are not of two faces, or flat, or reflex are none."""
    half = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    opposite = np.concatenate([faces[:, 2], faces[:, 0], faces[:, 1]])
    face = np.tile(np.arange(len(faces)), 3)
    key = np.sort(half, axis=1)
    order = np.lexsort((half[:, 0], key[:, 1], key[:, 0]))
    key = key[order]
    starts = np.flatnonzero(np.r_[True, (key[1:] != key[:-1]).any(axis=1)])
    twice = starts[np.diff(np.r_[starts, len(key)]) == 2]
    one, other = order[twice], order[twice + 1]
    wings = np.column_stack([opposite[one], opposite[other]])
    n, m = normals[face[one]], normals[face[other]]
    ends = key[twice]
    # Convex: the wing of the other face lies below this one. A face folded back is convex, too.
    height = np.einsum("ei,ei->e", n, points[wings[:, 1]] - points[ends[:, 0]])
    sine = np.linalg.norm(cross(n, m), axis=1)
    folded = np.einsum("ei,ei->e", n, m) < 0
    kept = (height < 0) & ((sine > FLAT) | folded)
    total = (n + m)[kept]
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return ends[kept], wings[kept], total / np.where(length > 0, length, 1.0)


def _point_normals(points: Floats, faces: Indices, normals: Floats) -> Floats:
    """G. Thuermer, C. A. Wuethrich, "Computing vertex normals from polygonal facets" (1998)."""
    total = np.zeros_like(points)
    for k in range(3):
        u = points[faces[:, (k + 1) % 3]] - points[faces[:, k]]
        v = points[faces[:, (k + 2) % 3]] - points[faces[:, k]]
        sine = np.linalg.norm(cross(u, v), axis=1)
        angle = np.arctan2(sine, np.einsum("ti,ti->t", u, v))
        np.add.at(total, faces[:, k], normals * angle[:, None])
    return total
