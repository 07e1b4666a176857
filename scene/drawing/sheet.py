"""Turns contours into a sheet: signed triangles in the plane.

The boundary of the triangles is exactly the edges of the contours. Therefore the number of
counter-clockwise triangles over a point minus the number of clockwise ones is the winding number of
the contours there. The sum of the signs is not 0 exactly where the non-zero rule fills, and no
areas have to be compared. No triangle may cover a place where the sum is 0 (`cancelled`).
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence

import manifold3d
import numpy as np
import numpy.typing as npt
from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Surface, covers_once
from satcheck.scene.drawing.cancelled import covers_empty_places
from satcheck.scene.drawing.contour import Contour, DrawnShape, Point
from satcheck.scene.errors import MeshFileError
from satcheck.scene.planar.prism import prism
from satcheck.scene.planar.turns import turns


class Sheet(Struct, frozen=True):
    """points: (n, 2); triangles: (m, 3), signed as above. deviation, inscribed: as in Contour, for
    the whole area."""

    name: str
    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int64]
    deviation: float
    inscribed: bool


def sheet_of(shape: DrawnShape) -> Sheet:
    """Raises MeshFileError if the contours are not the boundary of the triangles from the library,
    or if contours cross under the even-odd rule."""
    areas = [_sheet_of(shape)] if shape.contours else []
    for contour in shape.filled:
        areas.append(_sheet_of(DrawnShape(shape.name, (contour,), "nonzero")))
    return united(areas)


def united(sheets: list[Sheet]) -> Sheet:
    """The union of the sheets, named as the first. Raises MeshFileError if one winds in both
    directions, because another sheet could then cancel what it covers."""

    if len(sheets) == 1:
        return sheets[0]
    triangles: list[npt.NDArray[np.int64]] = []
    count = 0
    for sheet in sheets:
        triangles.append(_upward(sheet) + count)
        count += len(sheet.points)
    points = np.concatenate([sheet.points for sheet in sheets])
    deviation = max(sheet.deviation for sheet in sheets)
    inscribed = all(sheet.inscribed or not sheet.deviation for sheet in sheets)
    return Sheet(sheets[0].name, points, np.concatenate(triangles), deviation, inscribed)


def _upward(sheet: Sheet) -> npt.NDArray[np.int64]:
    """Its triangles, turned over if they cover points a negative number of times."""

    turned = sheet.triangles[:, ::-1]
    signs = turns(sheet.points, sheet.triangles)
    if (signs >= 0).all() or _covers_once(sheet.points, sheet.triangles):
        return sheet.triangles
    if (signs <= 0).all() or _covers_once(sheet.points, turned):
        return turned
    raise MeshFileError(
        "unsupported-feature",
        f"shape {sheet.name!r} winds both ways round: not read as a body with other shapes",
    )


def _sheet_of(shape: DrawnShape) -> Sheet:

    contours = _alternating(shape.contours) if shape.rule == "evenodd" else shape.contours
    polygons = _outward([np.array(contour.points, dtype=np.float64) for contour in contours])
    triangles = np.asarray(manifold3d.triangulate(polygons), dtype=np.int64).reshape(-1, 3)
    if _boundary(triangles) != _edges([len(polygon) for polygon in polygons]):
        raise MeshFileError("reader-failed", f"shape {shape.name!r} cannot be split into triangles")
    points = np.concatenate(polygons)
    if shape.rule == "evenodd" and not _covers_once(points, triangles):
        raise MeshFileError(
            "unsupported-feature",
            f"shape {shape.name!r}: outlines that cross under the even-odd rule are not read",
        )
    if covers_empty_places(points, triangles, polygons):
        raise MeshFileError(
            "unsupported-feature",
            f"shape {shape.name!r}: its outlines cross; unite its paths in the drawing program",
        )
    deviation = max(contour.deviation for contour in contours)
    inscribed = len(contours) == 1 and contours[0].inscribed  # polygons of holes lie within them
    return Sheet(shape.name, points, triangles, deviation, inscribed)


def _covers_once(points: npt.NDArray[np.float64], triangles: npt.NDArray[np.int64]) -> bool:
    solid = prism(points, triangles, 1.0).welded()
    return solid.topology().solid and covers_once(Surface(solid, True))


def _edges(sizes: list[int]) -> Counter[tuple[int, int]]:
    edges: Counter[tuple[int, int]] = Counter()
    first = 0
    for size in sizes:
        edges.update((first + k, first + (k + 1) % size) for k in range(size))
        first += size
    return edges


def _boundary(triangles: npt.NDArray[np.int64]) -> Counter[tuple[int, int]]:
    """Directed edges without an opposite edge, each with its multiplicity."""
    edges: Counter[tuple[int, int]] = Counter()
    for a, b, c in triangles.tolist():
        edges.update(((a, b), (b, c), (c, a)))
    return edges - Counter({(b, a): n for (a, b), n in edges.items()})


def _outward(polygons: list[npt.NDArray[np.float64]]) -> list[npt.NDArray[np.float64]]:
    """The polygons, turned over in groups, so that each group has an area of at least 0 in all.

    The library splits clockwise outlines into triangles that reach beyond them. Boxes of polygons
    of different groups have no common point, so what the non-zero rule fills stays the same.
    """
    low = np.array([polygon.min(axis=0) for polygon in polygons])
    high = np.array([polygon.max(axis=0) for polygon in polygons])
    group = np.arange(len(polygons))
    for k in range(len(polygons)):
        meets = (low[k] <= high[:k]).all(axis=1) & (high[k] >= low[:k]).all(axis=1)
        group[np.isin(group, group[:k][meets])] = k
    areas = np.array([_area(polygon.tolist()) for polygon in polygons])
    inward = np.bincount(group, areas, len(polygons)) < 0
    return [
        polygon[::-1] if inward[label] else polygon
        for polygon, label in zip(polygons, group, strict=True)
    ]


def _alternating(contours: tuple[Contour, ...]) -> list[Contour]:
    """Turns each contour: counter-clockwise if it lies within an even number of others, else
    clockwise.

    If contours do not cross, the non-zero rule then fills the same points as the even-odd rule. A
    later step checks that they do not cross: no point may be covered twice.
    """
    turned = []
    for contour in contours:
        corner = contour.points[0]
        depth = sum(other is not contour and _holds(other.points, corner) for other in contours)
        outward = _area(contour.points) > 0
        if outward != (depth % 2 == 0):
            contour = replace(contour, points=contour.points[::-1])
        turned.append(contour)
    return turned


def _holds(polygon: tuple[Point, ...], point: Point) -> bool:
    """Decides by the parity of the edges that a ray to the right crosses, in float64. A wrong
    answer leads to a shape with a coverage other than 0 or 1, which is refused."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in zip(polygon, (*polygon[1:], polygon[0]), strict=True):
        if (ay > y) != (by > y) and x < ax + (bx - ax) * (y - ay) / (by - ay):
            inside = not inside
    return inside


def _area(polygon: Sequence[Point]) -> float:
    """Signed, relative to the first corner, so that a shape far from the origin keeps its sign."""
    ox, oy = polygon[0]
    return sum(
        (ax - ox) * (by - oy) - (bx - ox) * (ay - oy)
        for (ax, ay), (bx, by) in itertools.pairwise(polygon)
    )
