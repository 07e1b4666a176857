"""The parts of an open surface that are sheets; the others may be a solid.

An open part in one plane is a sheet: nothing fills its boundary. With --allow-open every part with
a rim is a sheet. A sheet encloses nothing, because the winding numbers of a triangle and its
reverse cancel. Any other open part has holes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck.verify.exact import Floats
from satcheck.verify.world import Indices, connected, count_by_triangle, is_flat, welded

Mask = NDArray[np.bool_]


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
    return _are_run_both_ways(triangles) or _are_run_both_ways(welded(vertices, triangles)[1])


def _are_run_both_ways(corners: Indices) -> bool:
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    count = corners.max() + 1
    forth, back = np.sort(start * count + end), np.sort(end * count + start)
    return np.array_equal(forth, back)


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
    sheets = np.isin(part, _open_sets(part, corners, _edges(corners)))
    order = np.flatnonzero(sheets)[np.argsort(part[sheets], kind="stable")]
    for members in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        sheets[members] = is_flat(vertices[np.unique(triangles[members])])
    return sheets


def _flaps(corners: Indices) -> Mask:
    """The patches that remain after removing, again and again, patches with a rim of their own: an
    open edge at which no other patch is left."""
    edges = _edges(corners)
    patch = _patches(edges)
    taken = np.zeros(len(corners), dtype=bool)
    while True:
        left = np.flatnonzero(~taken)
        owner, edge, balance = _balances(patch[left], corners[left], edges[left])
        alone = np.bincount(edge, minlength=edges.size)[edge] == 1
        flaps = np.unique(owner[alone & (balance != 0)])
        if not len(flaps):
            return taken
        taken |= np.isin(patch, flaps)


def _patches(edges: Indices) -> Indices:
    """Of each triangle the patch, connected through edges of two triangles."""
    of_two = np.bincount(edges.ravel())[edges] == 2
    own = edges.size + np.arange(edges.size).reshape(-1, 3)
    joints = np.where(of_two, edges, own)
    return connected(joints, 2 * edges.size)[joints[:, 0]]


def _edges(corners: Indices) -> Indices:
    """The numbers of the three edges of each triangle, in whatever direction."""
    following = np.roll(corners, -1, axis=1)
    first, second = np.minimum(corners, following), np.maximum(corners, following)
    _, number = np.unique(first * (corners.max() + 1) + second, return_inverse=True)
    return number.reshape(-1, 3)


def _open_sets(set_of: Indices, corners: Indices, edges: Indices) -> Indices:
    """Sets of triangles that run some edge more often in one direction than in the other."""
    owner, _, balance = _balances(set_of, corners, edges)
    return np.unique(owner[balance != 0])


def _balances(set_of: Indices, corners: Indices, edges: Indices) -> tuple[Indices, Indices, Floats]:
    """(set, edge, how much more often the set runs the edge in one direction), each once."""
    runs = np.sign(np.roll(corners, -1, axis=1) - corners)
    count = edges.max(initial=0) + 1
    at = np.repeat(set_of, 3) * count + edges.ravel()
    places, where = np.unique(at, return_inverse=True)
    balance = np.bincount(where.reshape(-1), weights=runs.ravel(), minlength=len(places))
    return places // count, places % count, balance.astype(np.float64)
