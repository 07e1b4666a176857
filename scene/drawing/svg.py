"""SVG through svgelements: every shape that is filled or closed is a body's outline.

Coordinates are the user units of the outermost element, y as in the file: no conversion to pixels,
which would round them. Sources: W3C, "Scalable Vector Graphics (SVG) 1.1".
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable, Iterator
from typing import Any
from xml.etree import ElementTree

from satcheck.scene.drawing.contour import Affine, Contour, Drawing, DrawnShape, FillRule, Tracer
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.xml_guard import guarded_parser, parse_xml

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_SEPARATOR = r"[\s,]*"
_ARGUMENTS = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7, "z": 0}
_LENGTH = re.compile(rf"\s*({_NUMBER})\s*(um|mm|cm|m|in|px|)\s*")
_DRAWN_ELSEWHERE = frozenset({"text", "image", "foreignObject", "switch"})
# Drawn only where something else refers to them.
_TEMPLATES = frozenset({"symbol", "marker", "pattern", "mask", "clipPath"})
_FULL_TURN = 2 * math.pi


def read_svg(data: bytes) -> Drawing:
    """The shapes of a drawing; raises MeshFileError without a file name."""
    _check_xml(data)
    import svgelements  # type: ignore[import-untyped]

    root = ElementTree.fromstring(data)
    if root.tag.rpartition("}")[2] != "svg":
        raise MeshFileError("not-this-format", "not an SVG file: its root is no svg element")
    units, warnings = _units(root), set[str]()
    for element in root.iter():
        name = str(element.tag).rpartition("}")[2]
        if name == "path":
            _check_path(element.get("d", ""))
        elif name in _DRAWN_ELSEWHERE:
            warnings.add(f"{name} elements are ignored")
        warnings |= {f"{key} is ignored: shapes are taken whole" for key in _cut_by(element)}
    _put_away_templates(root)
    for key in ("width", "height", "viewBox"):
        root.attrib.pop(key, None)
    # Not reified: that would bend arcs under a skewed transform. Corners are mapped instead.
    parsed = svgelements.SVG.parse(io.BytesIO(ElementTree.tostring(root)), reify=False)
    shapes = []
    names = _Names()
    for element in parsed.elements():
        if isinstance(element, svgelements.Shape) and _is_shown(element):
            contours, open_ = _contours(svgelements, element)
            if open_:
                warnings.add("open lines are ignored")
            if contours:
                shapes.append(DrawnShape(names.of(element), tuple(contours), _rule(element)))
    return Drawing(tuple(shapes), units, tuple(sorted(warnings)))


def _cut_by(element: ElementTree.Element) -> Iterator[str]:
    for key in ("clip-path", "mask"):
        style = re.search(rf"(?:^|[\s;]){key}\s*:\s*url", element.get("style", ""))
        if element.get(key, "none") != "none" or style:
            yield key


def _put_away_templates(root: ElementTree.Element) -> None:
    """Into <defs>: svgelements would draw some of them where they stand."""
    for parent in list(root.iter()):
        for place, child in enumerate(parent):
            space, _, name = str(child.tag).rpartition("}")
            if name in _TEMPLATES:
                parent[place] = ElementTree.Element(f"{space}}}defs" if space else "defs")
                parent[place].append(child)


def _check_xml(data: bytes) -> None:
    """No entities, and a line number for what is not well formed."""
    parser = guarded_parser()
    parse_xml(lambda: parser.Parse(data, True))


def _units(root: ElementTree.Element) -> str | None:
    """The unit of one user unit, where width and viewBox agree on one."""
    width, box = _LENGTH.fullmatch(root.get("width", "")), root.get("viewBox", "").split()
    if width is None or width[2] in ("", "px") or len(box) != 4:
        return None
    try:
        return width[2] if float(box[2]) == float(width[1]) else None
    except ValueError:
        return None


def _check_path(d: str) -> None:
    """svgelements stops without a word where path data is malformed."""
    rest = d.strip()
    while rest:
        letter = rest[0].lower()
        if letter not in _ARGUMENTS:
            raise MeshFileError("bad-record", f"path data: {rest[:12]!r} is no command")
        count = _ARGUMENTS[letter]
        if letter == "a":
            # Flags may stand without any space between them and the number that follows.
            one = _SEPARATOR.join((*[_NUMBER] * 3, "[01]", "[01]", *[_NUMBER] * 2))
        else:
            one = _SEPARATOR.join([_NUMBER] * count)
        pattern = rf"{_SEPARATOR}(?:{one}{_SEPARATOR})+" if count else _SEPARATOR
        found = re.compile(pattern).match(rest, 1)
        if found is None:
            raise MeshFileError("bad-record", f"path data: {rest[:12]!r} lacks numbers")
        rest = rest[found.end() :]


def _is_shown(element: Any) -> bool:
    values = element.values
    return bool(values.get("display") != "none" and values.get("visibility") != "hidden")


def _is_filled(element: Any) -> bool:
    return element.fill is not None and element.fill.value is not None


def _rule(element: Any) -> FillRule:
    return "evenodd" if element.values.get("fill-rule") == "evenodd" else "nonzero"


class _Names:
    def __init__(self) -> None:
        self._number = 0

    def of(self, element: Any) -> str:
        self._number += 1
        return str(element.values.get("id") or f"shape{self._number}")


def _contours(svg: Any, element: Any) -> tuple[list[Contour], bool]:
    """The closed contours, and whether an open line was left out; filling closes every one."""
    contours, left_out, filled = [], False, _is_filled(element)
    for segments in _subpaths(svg, element.segments(transformed=False)):
        is_closed = filled or isinstance(segments[-1], svg.Close)
        is_closed = is_closed or segments[-1].end == segments[0].end
        contour = _traced(svg, segments) if is_closed else None
        if contour is not None:
            contours.append(contour.mapped(_affine(element.transform)))
        left_out = left_out or not is_closed
    return contours, left_out


def _affine(matrix: Any) -> Affine:
    return tuple(float(getattr(matrix, key)) for key in "acebdf")  # type: ignore[return-value]


def _subpaths(svg: Any, path: Iterable[Any]) -> Iterator[list[Any]]:
    current: list[Any] = []
    for segment in path:
        if isinstance(segment, svg.Move) and current:
            yield current
            current = []
        current.append(segment)
    if current:
        yield current


def _traced(svg: Any, segments: list[Any]) -> Contour | None:
    tracer = Tracer(_point(segments[0].end))
    for segment in segments[1:]:
        if isinstance(segment, svg.QuadraticBezier):
            tracer.bezier([_point(segment.control), _point(segment.end)])
        elif isinstance(segment, svg.CubicBezier):
            controls = (segment.control1, segment.control2, segment.end)
            tracer.bezier([_point(control) for control in controls])
        elif isinstance(segment, svg.Arc):
            _trace_arc(tracer, segment)
        elif isinstance(segment, svg.Line | svg.Close):
            if segment.end is not None:
                tracer.line(_point(segment.end))
        else:
            raise MeshFileError("unsupported-feature", f"path segment {type(segment).__name__}")
    return tracer.closed()


def _trace_arc(tracer: Tracer, arc: Any) -> None:
    centre = _point(arc.center)
    major = (arc.prx.x - centre[0], arc.prx.y - centre[1])
    minor = (arc.pry.x - centre[0], arc.pry.y - centre[1])
    sweep = math.copysign(min(abs(arc.sweep), _FULL_TURN), arc.sweep)
    tracer.ellipse(centre, major, minor, float(arc.get_start_t()), sweep, _point(arc.end))


def _point(point: Any) -> tuple[float, float]:
    return float(point.x), float(point.y)
