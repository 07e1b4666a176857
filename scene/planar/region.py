"""The region that a mesh covers, seen along an axis: triangles in the plane."""

from __future__ import annotations

import numpy as np
from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.conventions import Plane, axes_of
from satcheck.scene.planar.turns import Floats, Indices, turns


class Region(Struct, frozen=True):
    """All points that triangles cover. points: (n, 2), each once, and each a corner; triangles:
    (m, 3), counter-clockwise."""

    points: Floats
    triangles: Indices


def region_of(mesh: Mesh, solid: bool, plane: Plane) -> Region:
    """The outline of a mesh, exactly: dropping one coordinate rounds nothing.

    For a solid, only the triangles that face the viewer: a line of sight enters the solid as often
    as it leaves it, so these triangles cover the whole outline. For other meshes, all triangles.
    """
    points, triangles = _merged(np.asarray(mesh.vertices)[:, axes_of(plane)], mesh.triangles)
    signs = turns(points, triangles)
    if solid:
        return _of_corners(points, triangles[signs > 0])
    turned = np.where(signs[:, None] < 0, triangles[:, ::-1], triangles)
    return _of_corners(points, turned[signs != 0])


def _of_corners(points: Floats, triangles: Indices) -> Region:
    """Without the points of no triangle, as the end of a spike that has no area."""
    corners, index = np.unique(triangles, return_inverse=True)
    return Region(points[corners], index.reshape(-1, 3))


def _merged(points: Floats, triangles: object) -> tuple[Floats, Indices]:
    """Merges points that coincide in the plane, so that walls between neighbours cancel."""
    unique, index = np.unique(points + 0.0, axis=0, return_inverse=True)
    return unique, index.reshape(-1)[np.asarray(triangles, dtype=np.int64)]


def convex_corners(region: Region) -> Floats | None:
    """The corners, counter-clockwise, of a region that is a convex polygon covered exactly once;
    None for any other region."""
    from satcheck.scene.planar.prism import prism

    if not len(region.triangles):
        return None
    mesh = prism(region.points, region.triangles, 1.0).welded()
    if not mesh.topology().solid or mesh.convexity_defect(0.0) != 0.0:
        return None
    return _outermost(region.points)


def convex_region(mesh: Mesh, plane: Plane) -> Region:
    """The outline of a convex mesh: the convex hull of its corners."""
    points = np.unique(np.asarray(mesh.vertices)[:, axes_of(plane)] + 0.0, axis=0)
    corners = _outermost(points)
    if corners is None:
        return Region(points, fan_of(0))
    return Region(corners, fan_of(len(corners)))


def _outermost(points: Floats) -> Floats | None:
    """The corners of the convex hull, counter-clockwise; None for points on a line."""
    flat = np.column_stack((points, np.zeros(len(points))))
    hull = Mesh(flat, np.array([(0, 0, 0)], dtype=np.uint32)).convex_hull()
    corners = np.array(hull.vertices)[:, :2]
    signs = turns(corners, fan_of(len(corners)))
    if not len(signs):
        return None
    if (signs < 0).all():
        return corners[::-1].copy()
    return corners if (signs > 0).all() else None


def fan_of(corners: int) -> Indices:
    """The triangles of a convex polygon, as a fan around its first corner."""
    return np.array([(0, k, k + 1) for k in range(1, corners - 1)], dtype=np.int64).reshape(-1, 3)
