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
    outward. point_normals: (v, 3) outward, of those of the faces by their angles.
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
    """Edges that are not of two faces, or flat, or reflex are no edges."""
    from trimesh import Trimesh

    corners = points[triangles]
    across = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    sound = size > 0
    faces, normals = triangles[sound], across[sound] / size[sound, None]
    mesh = Trimesh(points, faces, face_normals=normals, process=False)
    ends, wings = mesh.face_adjacency_edges, mesh.face_adjacency_unshared
    n, m = normals[mesh.face_adjacency].swapaxes(0, 1)
    # Convex: the wing of the other face lies below this one. A face folded back is convex, too.
    height = np.einsum("ei,ei->e", n, points[wings[:, 1]] - points[ends[:, 0]])
    folded = np.einsum("ei,ei->e", n, m) < 0
    kept = (height < 0) & ((np.linalg.norm(cross(n, m), axis=1) > FLAT) | folded)
    total = (n + m)[kept]
    length = np.linalg.norm(total, axis=1, keepdims=True)
    both = np.unique(np.concatenate([mesh.edges, mesh.edges[:, ::-1]]), axis=0)
    return Features(
        points,
        faces,
        normals,
        ends[kept],
        wings[kept],
        total / np.where(length > 0, length, 1.0),
        mesh.vertex_normals,
        both,
        np.searchsorted(both[:, 0], np.arange(len(points) + 1)),
    )
