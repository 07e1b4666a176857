"""DXF through ezdxf: closed lines of the model space are contours.

A block reference is one shape, with the contours inside others as holes. A closed line outside any
block is a shape of its own: the format does not say whether one line within another is a hole or a
part put in the wrong place, and a hole taken for a part is found out, a part taken for a hole not.
Separate lines and arcs that join end to end make a contour.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable
from typing import Any

from satcheck.scene.drawing.contour import FLATNESS, Contour, Drawing, DrawnShape, Tracer
from satcheck.scene.errors import MeshFileError

_CURVES = frozenset({"CIRCLE", "ARC", "ELLIPSE", "SPLINE"})
_POLYLINES = frozenset({"LWPOLYLINE", "POLYLINE"})
_ANNOTATIONS = frozenset({"TEXT", "MTEXT", "DIMENSION", "POINT", "LEADER", "ATTRIB", "VIEWPORT"})
# Ends of lines that meet lie within this of each other, relative to the drawing: a rounding of
# the written digits, no gap.
_JOIN = 1e-9
_UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 13: "um"}


def read_dxf(data: bytes) -> Drawing:
    """The shapes of a drawing; raises MeshFileError without a file name."""
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    if not data.rstrip(b"\0 \r\n\t").endswith(b"EOF"):  # ezdxf mends what is cut off, unasked
        raise MeshFileError("bad-record", "not a DXF file, or truncated: it does not end with EOF")
    try:
        document, auditor = recover.read(io.BytesIO(data))
    except (DXFError, OSError, ValueError) as error:
        raise MeshFileError("bad-record", f"not readable as DXF: {error}") from None
    if auditor.has_errors:
        raise MeshFileError("bad-record", f"damaged: {auditor.errors[0].message}")
    warnings: set[str] = set()
    loose = _Contours(warnings)
    shapes = []
    for entity in document.modelspace():
        if entity.dxftype() == "INSERT":
            inner = _Contours(warnings)
            inner.add(_exploded(entity))
            if contours := inner.all():
                name = f"{entity.dxf.name}/{entity.dxf.handle}"
                shapes.append(DrawnShape(name, tuple(contours), "evenodd"))
        else:
            loose.add([entity])
    shapes += [
        DrawnShape(f"contour{number}", (contour,), "nonzero")
        for number, contour in enumerate(loose.all(), 1)
    ]
    units = _UNITS.get(int(document.header.get("$INSUNITS", 0)))
    return Drawing(tuple(shapes), units, tuple(sorted(warnings)))


def _exploded(insert: Any, depth: int = 0) -> Iterable[Any]:
    if depth > 32:
        raise MeshFileError("reference-cycle", f"blocks are nested too deeply: {insert.dxf.name}")
    for entity in insert.virtual_entities():
        if entity.dxftype() == "INSERT":
            yield from _exploded(entity, depth + 1)
        else:
            yield entity


class _Contours:
    """Closed lines as they come, and open ones until they are joined."""

    def __init__(self, warnings: set[str]) -> None:
        self._closed: list[Contour] = []
        self._open: list[tuple[list[tuple[float, float]], float]] = []
        self._warnings = warnings

    def add(self, entities: Iterable[Any]) -> None:
        for entity in entities:
            kind = entity.dxftype()
            if kind in _POLYLINES:
                self._add_polyline(entity)
            elif kind == "LINE":
                self._open.append(([_flat(entity.dxf.start), _flat(entity.dxf.end)], 0.0))
            elif kind in _CURVES:
                self._add_curve(entity)
            else:
                what = "annotations are" if kind in _ANNOTATIONS else f"{kind} entities are"
                self._warnings.add(f"{what} ignored")

    def _add_polyline(self, entity: Any) -> None:
        if entity.dxftype() == "POLYLINE" and not entity.is_2d_polyline:
            self._warnings.add("polylines in space and meshes are ignored")
            return
        points: list[tuple[float, float]] = []
        deviation = 0.0
        for piece in entity.virtual_entities():
            corners, off = _line_or_curve(piece)
            if points and math.dist(points[-1], corners[0]) > math.dist(points[-1], corners[-1]):
                corners.reverse()  # ezdxf turns every arc counter-clockwise
            elif not points and entity.dxftype() == "LWPOLYLINE":
                first = _first_corner(entity)
                if math.dist(first, corners[0]) > math.dist(first, corners[-1]):
                    corners.reverse()
            points += corners if not points else corners[1:]
            deviation = max(deviation, off)
        if len(points) < 2:
            return
        if entity.is_closed:
            self._close(points, deviation)
        else:
            self._open.append((points, deviation))

    def _add_curve(self, entity: Any) -> None:
        points, deviation = _line_or_curve(entity)
        size = max(math.dist(points[0], point) for point in points)
        if entity.dxftype() == "CIRCLE" or math.dist(points[0], points[-1]) <= _JOIN * size:
            self._close(points, deviation)
        else:
            self._open.append((points, deviation))

    def _close(self, points: list[tuple[float, float]], deviation: float) -> None:
        if math.dist(points[0], points[-1]) <= _JOIN * max(math.dist(points[0], p) for p in points):
            points = points[:-1]
        tracer = Tracer(points[0])
        tracer.points(points[1:], deviation)
        contour = tracer.closed()
        if contour is not None:
            self._closed.append(contour)

    def all(self) -> list[Contour]:
        self._join()
        if self._open:
            self._warnings.add("open lines are ignored")
        return self._closed

    def _join(self) -> None:
        """Chains of open lines that come back to their start; branches are left open."""
        corners = [abs(c) for points, _ in self._open for p in points for c in p]
        gap = _JOIN * max(corners, default=0.0)
        waiting, self._open = self._open, []
        while waiting:
            chain, deviation = waiting.pop()
            while math.dist(chain[0], chain[-1]) > gap:
                near = [
                    (k, end)
                    for k, (points, _) in enumerate(waiting)
                    for end in (0, -1)
                    if math.dist(points[end], chain[-1]) <= gap
                ]
                if len(near) != 1:
                    break
                points, off = waiting.pop(near[0][0])
                chain = chain + (points if near[0][1] == 0 else points[::-1])[1:]
                deviation = max(deviation, off)
            if math.dist(chain[0], chain[-1]) <= gap:
                self._close(chain, deviation)
            else:
                self._open.append((chain, deviation))


def _first_corner(polyline: Any) -> tuple[float, float]:
    return _flat(next(iter(polyline.vertices_in_wcs())))


def _line_or_curve(entity: Any) -> tuple[list[tuple[float, float]], float]:
    """Corners on the entity, and how far it may be off the chords between them."""
    if entity.dxftype() == "LINE":
        return [_flat(entity.dxf.start), _flat(entity.dxf.end)], 0.0
    rough = [_flat(point) for point in entity.flattening(math.inf if _is_round(entity) else 1e9)]
    size = max((math.dist(rough[0], point) for point in rough), default=0.0)
    if _is_round(entity):
        size = max(size, float(entity.dxf.radius))
    if not (size > 0 and math.isfinite(size)):
        raise MeshFileError("bad-record", f"{entity.dxftype()} without size")
    deviation = FLATNESS * size
    # ezdxf measures in the middle of a chord, where a curve of many bends may cross it: half of
    # what is granted leaves room.
    return [_flat(point) for point in entity.flattening(deviation / 2)], deviation


def _is_round(entity: Any) -> bool:
    return entity.dxftype() in ("CIRCLE", "ARC")


def _flat(point: Any) -> tuple[float, float]:
    return float(point[0]), float(point[1])
