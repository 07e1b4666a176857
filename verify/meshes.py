"""What follows from the mesh of a file: whether it is closed, which parts are sheets, and whether
it is convex. Planes of triangles are computed in float64, with bounds of the rounding.

An open part in one plane is a sheet: nothing fills its boundary. With --allow-open every part with
a rim is a sheet. A sheet encloses nothing, because the winding numbers of a triangle and its
reverse cancel. Any other open part has holes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck.verify.exact import (
    Floats,
    IntVector,
    cross,
    dot,
    integers,
    lattice,
    normal_of,
    sign,
)
from satcheck.verify.world import Indices, connected, count_by_triangle, is_flat, welded

Mask = NDArray[np.bool_]
ROUNDOFF = 2.0**-53
TINY = 2.0**-1000  # more than what underflow takes
HUGE = 1e300  # sums of smaller terms do not overflow
# Sides of planes are found for so many planes and points at once.
AT_ONCE = 1 << 16


class Planes:
    """normal . x = height. error: how far rounding takes normal . x - height, for points that are
    nowhere farther than `size` from the origin along an axis, and whose coordinates are rounded.

    A normal is off by 5 roundoffs of the products that it is the difference of, times lines of
    twice that size; points, sums of products, their difference and half edges of boxes take 32.
    """

    def __init__(self, triangles: Floats, anchors: Floats, size: float) -> None:
        """anchors: a point of each plane, less the origin."""
        e, f = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
        with np.errstate(over="ignore", invalid="ignore"):
            self.normals = np.cross(e, f)
            self.heights = np.einsum("nk,nk->n", self.normals, anchors)
            e, f = np.abs(e), np.abs(f)
            products = e[:, [1, 2, 0]] * f[:, [2, 0, 1]] + e[:, [2, 0, 1]] * f[:, [1, 2, 0]]
            scale = size * products.sum(axis=1)
            error = 64 * ROUNDOFF * scale + (1 + size) * TINY
        self.error: Floats = np.where(scale < HUGE, error, np.inf)


def is_convex(vertices: Floats, triangles: Indices) -> bool:
    """Whether a balanced surface winds around its hull and nothing else, outward.

    All vertices lie on one side of the plane of each face; for a sheet flush with the hull they lie
    in front. Such a surface wraps the hull a whole number of times. A volume above 0 proves that
    this number is not 0.
    """
    points, corners = welded(vertices, triangles)
    local = points - (0.5 * points.min(axis=0) + 0.5 * points.max(axis=0))
    planes = Planes(points[corners], local[corners[:, 0]], float(np.abs(local).max()))
    return _are_on_one_side(points, local, corners, planes) and _has_volume(points, corners, planes)


def _are_on_one_side(points: Floats, local: Floats, corners: Indices, planes: Planes) -> bool:
    """Whether no face has points in front of its plane and behind it, exactly. local: the points
    less an origin."""
    exact: list[IntVector] = []
    decided = np.zeros(len(corners), dtype=bool)
    step = max(1, AT_ONCE // len(points))
    for start in range(0, len(corners), step):
        faces = slice(start, start + step)
        heights = planes.normals[faces] @ local.T - planes.heights[faces, None]
        error = planes.error[faces, None]
        behind, front = heights < -error, heights > error
        below, above = behind.any(axis=1), front.any(axis=1)
        if (below & above).any():
            return False
        left = len(points) - behind.sum(axis=1) - front.sum(axis=1)
        for row in np.flatnonzero(left > 3).tolist():  # more than its own corners
            if decided[start + row]:
                continue
            exact = exact or integers(points, lattice(points))
            of_face = [exact[v] for v in corners[start + row].tolist()]
            normal = normal_of(of_face)
            if not any(normal):
                continue
            height = dot(normal, of_face[0])
            close = np.flatnonzero(~(behind[row] | front[row])).tolist()
            sides = [sign(dot(normal, exact[v]) - height) for v in close]
            if (below[row] or -1 in sides) and (above[row] or 1 in sides):
                return False
            in_plane = [v for v, side in zip(close, sides, strict=True) if side == 0]
            decided |= np.isin(corners, in_plane).all(axis=1)
    return True


def _has_volume(points: Floats, corners: Indices, planes: Planes) -> bool:
    """Whether the volume of a balanced surface is above 0, exactly."""
    rounding = len(corners) * 2 * ROUNDOFF * np.abs(planes.heights).sum()
    if planes.heights.sum() > planes.error.sum() + rounding:
        return True
    exact = integers(points, lattice(points))
    triangles = ([exact[v] for v in face] for face in corners.tolist())
    return bool(sum(dot(a, cross(b, c)) for a, b, c in triangles) > 0)


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
    owner, _, balance = _balances(part, corners, _edges(corners))
    sheets = np.isin(part, owner[balance != 0])
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


def _balances(set_of: Indices, corners: Indices, edges: Indices) -> tuple[Indices, Indices, Floats]:
    """(set, edge, how much more often the set runs the edge in one direction), each once."""
    runs = np.sign(np.roll(corners, -1, axis=1) - corners)
    count = edges.max(initial=0) + 1
    at = np.repeat(set_of, 3) * count + edges.ravel()
    places, where = np.unique(at, return_inverse=True)
    balance = np.bincount(where.reshape(-1), weights=runs.ravel(), minlength=len(places))
    return places // count, places % count, balance.astype(np.float64)
