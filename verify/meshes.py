"""What follows from the mesh of a file: whether it is closed, which parts are sheets, and whether
it is convex.

An open part in one plane is a sheet: nothing fills its boundary. With --allow-open every part with
a rim is a sheet. A sheet encloses nothing, because the winding numbers of a triangle and its
reverse cancel. Any other open part has holes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck.verify.exact import Floats, lattice
from satcheck.verify.world import (
    Exact,
    Indices,
    World,
    connected,
    count_by_triangle,
    is_flat,
    welded,
)

Mask = NDArray[np.bool_]


def is_convex(vertices: Floats, triangles: Indices) -> bool:
    """Whether a balanced surface winds around its hull and nothing else, outward.

    All vertices lie on one side of the plane of each face; for a sheet flush with the hull they lie
    in front. Such a surface wraps the hull a whole number of times. A volume above 0 proves that
    this number is not 0.
    """
    body = Exact(World(vertices, triangles, solid=True), lattice(vertices))
    for (x, y, z), height in body.planes():
        if body.extent((x, y, z)) > height and body.extent((-x, -y, -z)) > -height:
            return False
    return body.six_volumes > 0


def with_backs(vertices: Floats, triangles: Indices, *, allow_open: bool) -> Indices | None:
    """The triangles, then the reverse of those of sheets. None: the surface has holes."""
    _, corners = welded(vertices, triangles)
    sheets = _flat_parts(vertices, triangles, corners)
    if allow_open:
        sheets |= _flaps(corners)
    both = np.vstack([triangles, triangles[sheets][:, ::-1]])
    return both if is_balanced(vertices, both) else None


def is_balanced(vertices: Floats, triangles: Indices) -> bool:
    """Whether every edge, by the coordinates of its ends, is run as often as its reverse."""
    if not len(triangles):
        return False
    edges, runs = _edges(welded(vertices, triangles)[1])
    return not _balance(edges, runs).any()


def turns_around(corners: Floats, point: Floats) -> float:
    """The winding number of triangles (n, 3, 3) about a point on none of them, also of open ones.

    Their solid angle over 4 pi. A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle"
    (1983).
    """
    spokes = corners - point
    lengths = np.linalg.norm(spokes, axis=2)
    along = np.einsum("nij,nkj->nik", spokes, spokes)
    below = lengths.prod(axis=1) + along[:, 0, 1] * lengths[:, 2]
    below += along[:, 1, 2] * lengths[:, 0] + along[:, 2, 0] * lengths[:, 1]
    return float(np.arctan2(np.linalg.det(spokes), below).sum() / (2 * np.pi))


def bounds_nothing(vertices: Floats, triangles: Indices) -> bool:
    """Whether each triangle comes as often in one winding as in the other."""
    ways = (count_by_triangle(vertices, way, True) for way in (triangles, triangles[:, ::-1]))
    return next(ways) == next(ways)


def _flat_parts(vertices: Floats, triangles: Indices, corners: Indices) -> Mask:
    """Open parts, connected through vertices, that lie in one plane."""
    part = connected(corners, corners.max(initial=-1) + 1)[corners[:, 0]]
    edges, runs = _edges(corners)
    is_open = (_balance(edges, runs)[edges] != 0).any(axis=1)
    sheets = np.isin(part, part[is_open])
    order = np.flatnonzero(sheets)[np.argsort(part[sheets], kind="stable")]
    for members in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        sheets[members] = is_flat(vertices[np.unique(triangles[members])])
    return sheets


def _flaps(corners: Indices) -> Mask:
    """The patches that remain after removing, again and again, patches with a rim of their own: an
    open edge at which no other patch is left."""
    edges, runs = _edges(corners)
    # Patches of triangles are connected through edges of two triangles.
    of_two = np.bincount(edges.ravel())[edges] == 2
    joints = np.where(of_two, edges, edges.size + np.arange(edges.size).reshape(-1, 3))
    patch = connected(joints, 2 * edges.size)[joints[:, 0]]
    taken = np.zeros(len(corners), dtype=bool)
    while True:
        left, of = edges[~taken], patch[~taken]
        first, last = np.full(edges.max() + 1, len(runs) * 6), np.zeros(edges.max() + 1, dtype=int)
        np.minimum.at(first, left, of[:, None])
        np.maximum.at(last, left, of[:, None])
        rims = (first == last) & (_balance(edges, np.where(taken[:, None], 0, runs)) != 0)
        flaps = of[rims[left].any(axis=1)]
        if not len(flaps):
            return taken
        taken |= np.isin(patch, flaps)


def _edges(corners: Indices) -> tuple[Indices, Indices]:
    """The numbers of the three edges of each triangle, in whatever direction, and the direction: 1
    or -1, 0 of an edge without a length."""
    following = np.roll(corners, -1, axis=1)
    first, second = np.minimum(corners, following), np.maximum(corners, following)
    _, number = np.unique(first * (corners.max() + 1) + second, return_inverse=True)
    return number.reshape(-1, 3), np.sign(following - corners)


def _balance(edges: Indices, runs: Indices) -> Floats:
    """How much more often triangles run each edge in one direction."""
    return np.asarray(np.bincount(edges.ravel(), weights=runs.ravel()), dtype=np.float64)
