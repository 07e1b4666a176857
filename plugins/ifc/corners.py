"""Whether two joined walls can meet in a corner only."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from satcheck.core import Mesh
from satcheck.plugins.ifc.shape import Shape

Floats = NDArray[np.float64]
# Of the smaller box: less than what a wall shares with its duplicate.
_MOST_SHARED = 0.5
_ROUNDING = 1e-9  # of the size of the boxes
_TRIPLES = np.array(list(combinations(range(12), 3)))


def meet_in_a_corner(a: Shape, b: Shape) -> bool:
    """Whether the boxes of two bodies, each along the axes of its element, share at most half of
    the smaller box. The bodies lie in their boxes, so they share no more."""
    (low, high), (other_low, other_high) = _box(a), _box(b)
    turn = np.linalg.inv(_matrix(a)) @ _matrix(b)
    least = min(np.prod(high - low), np.prod(other_high - other_low) * abs(np.linalg.det(turn)))
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    back = np.linalg.inv(turn)
    normals = np.concatenate([normals, back[:3, :3], -back[:3, :3]])
    shift = back[:3, 3]
    limits = np.concatenate([high, -low, other_high - shift, shift - other_low])
    return bool(_volume(normals, limits) <= _MOST_SHARED * least)


def _box(shape: Shape) -> tuple[Floats, Floats]:
    points = np.frombuffer(shape.vertices, "<f8").reshape(-1, 3)
    return points.min(axis=0), points.max(axis=0)


def _matrix(shape: Shape) -> Floats:
    return np.eye(4) if shape.matrix is None else np.array(shape.matrix).reshape(4, 4)


def _volume(normals: Floats, limits: Floats) -> float:
    """Of the points x with normals @ x <= limits, twelve half spaces that bound a body."""
    planes, ends = normals[_TRIPLES], limits[_TRIPLES]
    sound = abs(np.linalg.det(planes)) > _ROUNDING
    corners = np.linalg.solve(planes[sound], ends[sound][..., None])[..., 0]
    slack = _ROUNDING * np.abs(limits).max()
    corners = corners[(corners @ normals.T <= limits + slack).all(axis=1)]
    if len(corners) < 4:
        return 0.0
    first = np.array([0, 1, 2], "<u4").tobytes()
    try:
        hull = Mesh.from_bytes(corners.astype("<f8").tobytes(), first).convex_hull().to_mesh()
    except ValueError:  # flat: the boxes touch
        return 0.0
    points = np.asarray(hull.vertices)
    faces = (points - points[0])[np.asarray(hull.triangles)]
    return float(abs(np.linalg.det(faces).sum()) / 6)
