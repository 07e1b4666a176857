"""The planes of triangles in float64, with bounds of the rounding, and what follows exactly:
whether a body is convex."""

from __future__ import annotations

import numpy as np

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
from satcheck.verify.world import Indices, welded

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
