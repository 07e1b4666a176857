"""The outline of a DXF entity: its corners, seen from above."""

from __future__ import annotations

import math
from typing import Any, Literal

from msgspec import Struct

from satcheck.scene.drawing.contour import FLATNESS, Affine, Contour, Point, refuse_non_finite
from satcheck.scene.drawing.joining import JOIN
from satcheck.scene.errors import MeshFileError

# Annotations: not geometry.
_MEASURES = frozenset(
    {"ARC_DIMENSION", "DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER", "MLEADER", "MULTILEADER"}
)
_WORDS = frozenset({"ACAD_TABLE", "ATTDEF", "ATTRIB", "MTEXT", "RTEXT", "TEXT", "TOLERANCE"})
_PICTURES = frozenset({"DGNUNDERLAY", "DWFUNDERLAY", "IMAGE", "OLE2FRAME", "PDFUNDERLAY"})
_HELP = frozenset({"CAMERA", "LIGHT", "POINT", "RAY", "SUN", "VIEWPORT", "XLINE"})
ANNOTATIONS = _MEASURES | _WORDS | _PICTURES | _HELP
_CURVES = frozenset({"LINE", "CIRCLE", "ARC", "ELLIPSE", "SPLINE"})
_ROUND = frozenset({"CIRCLE", "ARC", "ELLIPSE"})
_POLYLINES = frozenset({"LWPOLYLINE", "POLYLINE"})
_FILLED = frozenset({"SOLID", "TRACE", "3DFACE"})
_FITTED = 2 | 4  # of a POLYLINE: its vertices are not corners, or not all of them


class Outline(Struct, frozen=True):
    """closed: a line whose last point joins the first; open: a line; filled: an area. inscribed: as
    in Contour."""

    points: tuple[Point, ...]
    deviation: float
    kind: Literal["closed", "open", "filled"]
    inscribed: bool = False

    def mapped(self, affine: Affine) -> Outline:
        moved = Contour(self.points, self.deviation).mapped(affine)
        return Outline(moved.points, moved.deviation, self.kind, self.inscribed)


def outline_of(entity: Any) -> Outline | None:
    """None: the entity has no outline. Raises MeshFileError if it cannot be read."""
    kind = entity.dxftype()
    if kind in _POLYLINES:
        return _polyline(entity)
    if kind in _CURVES:
        return _curve(entity)
    if kind in _FILLED:
        points = tuple(_flat(corner) for corner in entity.wcs_vertices())
        return Outline(points, 0.0, "filled")
    raise _unread(kind)


def _unread(what: str) -> MeshFileError:
    message = f"{what} is not read: turn its layer off to leave it out"
    return MeshFileError("unsupported-feature", message)


def _polyline(entity: Any) -> Outline | None:
    kind = entity.dxftype()
    is_light = kind == "LWPOLYLINE"
    if not is_light:
        if not (entity.is_2d_polyline or entity.is_3d_polyline):
            raise _unread("a POLYLINE that is a mesh")
        if int(entity.dxf.flags) & _FITTED:
            raise _unread("a POLYLINE that is fitted with a curve")
    if entity.has_width:
        raise _unread(f"{kind} with a width, a filled band,")
    points: list[Point] = []
    deviation = 0.0
    for piece in entity.virtual_entities():
        corners, off = _corners(piece)
        if points and math.dist(points[-1], corners[0]) > math.dist(points[-1], corners[-1]):
            corners.reverse()  # ezdxf turns every arc counter-clockwise
        elif not points and is_light:
            first = _flat(next(iter(entity.vertices_in_wcs())))
            if math.dist(first, corners[0]) > math.dist(first, corners[-1]):
                corners.reverse()
        points += corners if not points else corners[1:]
        deviation = max(deviation, off)
    if len(points) < 2:
        return None
    return Outline(tuple(points), deviation, "closed" if entity.is_closed else "open")


def _curve(entity: Any) -> Outline:
    points, deviation = _corners(entity)
    size = max(math.dist(points[0], point) for point in points)
    is_closed = entity.dxftype() == "CIRCLE" or (
        entity.dxftype() != "LINE" and math.dist(points[0], points[-1]) <= JOIN * size
    )
    inscribed = is_closed and entity.dxftype() in _ROUND
    return Outline(tuple(points), deviation, "closed" if is_closed else "open", inscribed)


def _corners(entity: Any) -> tuple[list[Point], float]:
    """Corners on the entity, and the largest distance between it and the chords."""
    if entity.dxftype() == "LINE":
        return [_flat(entity.dxf.start), _flat(entity.dxf.end)], 0.0
    is_round = entity.dxftype() in ("CIRCLE", "ARC")
    rough = [_flat(point) for point in entity.flattening(math.inf if is_round else 1e9)]
    size = max((math.dist(rough[0], point) for point in rough), default=0.0)
    if is_round:
        size = max(size, float(entity.dxf.radius))
    if not (size > 0 and math.isfinite(size)):
        raise MeshFileError("bad-record", f"{entity.dxftype()} without size")
    deviation = FLATNESS * size
    # ezdxf measures the error at the middle of a chord, where a wavy curve may cross the chord.
    # Half of the allowed deviation leaves a margin.
    return [_flat(point) for point in entity.flattening(deviation / 2)], deviation


def _flat(point: Any) -> Point:
    flat = float(point[0]), float(point[1])
    refuse_non_finite([flat])
    return flat
