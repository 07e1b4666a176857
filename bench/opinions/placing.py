"""Where a second body is put beside the first: seeded, and in the ways that scenes are laid out."""

from __future__ import annotations

import numpy as np

from bench.opinions.surface import Mesh, Points, winding_numbers

# far: the boxes apart. beside: the copy moved along x by exactly its length, so that flush faces
# meet. graze: turned, hulls overlapping by a fiftieth of the size. overlap: turned and moved by 0.3
# of the size. within: turned, a fifth as large, about a point within the first. other: another
# file, as large, put as in overlap.
KINDS = ("far", "beside", "graze", "overlap", "within", "other")
SHRUNK = 0.2


def placement(kind: str, a: Mesh, b: Mesh, rng: np.random.Generator) -> Points:
    """The 4x4 matrix that puts B beside A, which stays where it is."""
    low, high = a.vertices.min(axis=0), a.vertices.max(axis=0)
    centre = (low + high) / 2
    if kind == "beside":
        return _affine(np.eye(3), np.array([high[0] - low[0], 0, 0]))
    turn = _rotation(rng)
    away = _direction(rng)
    scale = SHRUNK if kind == "within" else a.size / b.size if kind == "other" else 1.0
    linear = scale * turn
    own = linear @ ((b.vertices.min(axis=0) + b.vertices.max(axis=0)) / 2)
    if kind == "within":
        return _affine(linear, _point_within(a, rng) - own)
    if kind == "graze":
        reach = (a.vertices @ away).max() - ((b.vertices @ linear.T) @ away).min()
        return _affine(linear, (reach - a.size / 50) * away)
    shift = 3.0 if kind == "far" else 0.3
    return _affine(linear, centre + shift * a.size * away - own)


def _point_within(mesh: Mesh, rng: np.random.Generator) -> Points:
    """Of random points in the box one that the surface winds about; the centre where none is."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    some = rng.permutation(len(mesh.triangles))[:20_000]
    points = low + rng.random((64, 3)) * (high - low)
    wound = np.abs(winding_numbers(Mesh(mesh.vertices, mesh.triangles[some]), points))
    best = int(wound.argmax())
    return np.asarray(points[best] if wound[best] > 0.5 else (low + high) / 2)


def _affine(linear: Points, shift: Points) -> Points:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, shift
    return matrix


def _direction(rng: np.random.Generator) -> Points:
    v = rng.normal(size=3)
    return np.asarray(v / np.linalg.norm(v))


def _rotation(rng: np.random.Generator) -> Points:
    """Uniform: the unit quaternion of four normal numbers (Ken Shoemake, 1992)."""
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
