"""Reads SVG: every shape that is filled or closed is the outline of a body.

Coordinates are user units of the outermost element, in the unit that its width and height state
(`svg_size`). They are not converted to pixels, because that would round them. y points as in the
file. If an element cannot be read, the element and all its children become one refused shape.
Source: W3C, "Scalable Vector Graphics (SVG) 1.1".
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from msgspec import Struct
from msgspec.structs import replace

from satcheck.scene.drawing.contour import Affine, Drawing, DrawnShape, RefusedShape
from satcheck.scene.drawing.svg_shapes import SHAPES, outlines
from satcheck.scene.drawing.svg_size import drawn_size
from satcheck.scene.drawing.svg_style import Style, StyleSheets
from satcheck.scene.drawing.svg_values import (
    Viewport,
    bad,
    compose,
    fitted,
    transform,
    translation,
    unread,
    view_box,
)
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.limits import MAX_DEPTH
from satcheck.scene.loading.placing import refuse_explosion
from satcheck.scene.loading.xml_tree import guarded_parser, parse_xml

_NAMESPACE = "http://www.w3.org/2000/svg"
_HREFS = ("href", "{http://www.w3.org/1999/xlink}href")
_SIZE = frozenset({"width", "height"})
_GROUPS = frozenset({"a", "g"})
_ANIMATIONS = frozenset({"animate", "animateMotion", "animateTransform", "set"})
# Drawn only if another element refers to them, or never.
_APART = frozenset(
    {"clipPath", "cursor", "defs", "desc", "filter", "font", "font-face", "linearGradient"}
    | {"marker", "mask", "metadata", "pattern", "radialGradient", "style", "symbol", "title"}
    | {"view", *_ANIMATIONS}
)
_HARMLESS = re.compile(r"color|opacity|fill-opacity|stop-|stroke")  # if animated
_DRAWN = SHAPES | _GROUPS | {"svg", "switch", "symbol", "use"}


def read_svg(data: bytes) -> Drawing:
    """The shapes of a drawing; raises MeshFileError without a file name."""
    _check_xml(data)
    root = ElementTree.fromstring(data)
    if _kind(root) != "svg":
        raise MeshFileError("not-this-format", "not an SVG file: its root is not an svg element")
    reading = _Reading(root)
    shapes = tuple(reading.shapes())
    return Drawing(shapes, reading.drawn.units, tuple(sorted(reading.warnings)))


def _check_xml(data: bytes) -> None:
    """Refuses entities, external style sheets, and XML that is not well formed, with the line."""
    parser = guarded_parser()

    def check_instruction(target: str, _: str) -> None:
        if target == "xml-stylesheet":
            raise unread("a style sheet in another file is not read")

    parser.ProcessingInstructionHandler = check_instruction
    parse_xml(lambda: parser.Parse(data, True))


def _kind(element: Element) -> str:
    """Its local name; "" if it is not an element of SVG."""
    space, _, name = str(element.tag).rpartition("}")
    return name if space in ("", "{" + _NAMESPACE) else ""


def _describe(element: Element) -> str:
    id_ = element.get("id")
    return f"<{_kind(element)} id={id_!r}>" if id_ else f"<{_kind(element)}>"


class _Place(Struct, frozen=True):
    """Where and how an element is drawn. caller: the <use> that draws it."""

    affine: Affine
    viewport: Viewport
    style: Style
    caller: Element | None = None


class _Reading:
    def __init__(self, root: Element) -> None:
        self._root = root
        self._by_id = {e.get("id", ""): e for e in reversed(list(root.iter())) if e.get("id")}
        sheets = (e for e in root.iter() if _kind(e) == "style" and _is_css(e))
        self._sheets = StyleSheets(("".join(e.itertext()) for e in sheets), root)
        styled = not _SIZE.isdisjoint(self._sheets.values_of(root))
        self.drawn = drawn_size(root.attrib, styled)
        self._number = 0
        self.warnings: set[str] = set()

    def shapes(self) -> Iterator[DrawnShape | RefusedShape]:
        refuse_explosion([self._root], self._held, lambda _: 1, _describe, MAX_DEPTH)
        style = self._sheets.style_of(self._root, Style(), True)
        if self._root.get("transform"):
            raise unread("<svg>: a transform of the whole drawing is not read")
        _check_still(self._root)
        outermost = _Place(self.drawn.affine, self._outermost(), style)
        waiting = self._children(self._root, outermost)
        if not style.is_displayed:
            return
        while waiting:
            element, place = waiting.pop()
            try:
                if _is_chosen(element):
                    drawn = self._drawn(element, place)
                    if isinstance(drawn, DrawnShape):
                        yield drawn
                    else:
                        waiting += drawn
            except MeshFileError as error:
                message = f"{_describe(element)}: {error.message}"
                yield RefusedShape(self._name(element, place), error.code, message)

    def _outermost(self) -> Viewport:
        box = view_box(self._root.get("viewBox", ""))
        if box is not None:
            return Viewport(box[2], box[3])
        unknown = Viewport(None, None)
        sides = []
        for key, along in (("width", "x"), ("height", "y")):
            text = self._root.get(key, "100%")
            styled = key in self._sheets.values_of(self._root)
            sides.append(
                None
                if "%" in text or "auto" in text or styled
                else unknown.length(text, along, key)
            )
        return Viewport(*sides)

    def _held(self, element: Element) -> Iterator[tuple[Element, int]]:
        """The elements drawn with an element, once each."""
        yield from ((child, 1) for child in element if _kind(child) not in _APART | {""})
        if _kind(element) == "use":
            target = self._by_id.get(_href(element)[1:])
            if target is not None:
                yield target, 1

    def _drawn(self, element: Element, place: _Place) -> DrawnShape | list[tuple[Element, _Place]]:
        """A shape, or the elements to draw instead of this one, the last first."""
        kind = _kind(element)
        if kind in _APART and not (kind == "symbol" and place.caller is not None):
            return []
        if kind not in _DRAWN:
            self.warnings.add(f"{kind} elements are ignored")
            return []
        _check_still(element)
        style = self._sheets.style_of(element, place.style, False)
        if not style.is_displayed:
            return []
        if style.is_cut:
            self.warnings.add("clip paths and masks are ignored: shapes are taken whole")
        affine = compose(place.affine, transform(element.get("transform", "")))
        here = replace(place, affine=affine, style=style)
        if kind in SHAPES:
            return self._shape(kind, element, here) if style.is_visible else []
        if kind in _GROUPS:
            return self._children(element, here)
        if kind == "use":
            return self._used(element, here)
        if kind == "switch":
            chosen = [pair for pair in self._children(element, here) if _is_chosen(pair[0])]
            return chosen[-1:]
        return self._children(element, self._inner(element, here))

    @staticmethod
    def _children(element: Element, place: _Place) -> list[tuple[Element, _Place]]:
        return [(child, replace(place, caller=None)) for child in reversed(element)]

    def _used(self, element: Element, place: _Place) -> list[tuple[Element, _Place]]:
        href = _href(element)
        target = self._by_id.get(href[1:]) if href.startswith("#") else None
        if target is None:
            raise MeshFileError("index-out-of-range", f"it refers to the missing {href!r}")
        moved = self._offset(element, place)
        return [(target, replace(place, affine=compose(place.affine, moved), caller=element))]

    @staticmethod
    def _offset(element: Element, place: _Place) -> Affine:
        length = place.viewport.length
        x, y = (length(element.get(key, "0"), key, key) for key in ("x", "y"))
        return translation(x, y)

    def _inner(self, element: Element, place: _Place) -> _Place:
        """Within an inner <svg>, or a <symbol> that is used."""
        if element.get("refX") or element.get("refY"):
            raise unread("refX and refY are not read")
        sizes = {"width": element.get("width", "100%"), "height": element.get("height", "100%")}
        if place.caller is not None:
            sizes = {key: place.caller.get(key, size) for key, size in sizes.items()}
        box = view_box(element.get("viewBox", ""))
        affine = compose(place.affine, self._offset(element, place))
        lengths = {
            key: place.viewport.length(size.replace("auto", "100%"), along, key)
            for (key, size), along in zip(sizes.items(), "xy", strict=True)
            if box is not None or "%" not in size
        }
        if any(length < 0 for length in lengths.values()):
            raise bad("a negative size")
        width = lengths.get("width", place.viewport.width)
        height = lengths.get("height", place.viewport.height)
        self.warnings.add("inner viewports cut nothing: shapes are taken whole")
        if box is None:
            return replace(place, affine=affine, viewport=Viewport(width, height))
        assert width is not None
        assert height is not None
        inner = fitted(box, width, height, element.get("preserveAspectRatio", ""))
        return replace(place, affine=compose(affine, inner), viewport=Viewport(box[2], box[3]))

    def _shape(
        self, kind: str, element: Element, place: _Place
    ) -> DrawnShape | list[tuple[Element, _Place]]:
        contours, left_out = outlines(kind, element, place.viewport, place.style.is_filled)
        if left_out:
            self.warnings.add("open lines are ignored")
        if not contours:
            return []
        moved = tuple(contour.mapped(place.affine) for contour in contours)
        return DrawnShape(self._name(element, place), moved, place.style.rule)

    def _name(self, element: Element, place: _Place) -> str:
        self._number += 1
        caller = place.caller.get("id") if place.caller is not None else None
        return element.get("id") or caller or f"shape{self._number}"


def _href(element: Element) -> str:
    return next((element.get(key, "").strip() for key in _HREFS if key in element.attrib), "")


def _check_still(element: Element) -> None:
    """Refuses animations that move, show or hide the element."""
    for child in element:
        if _kind(child) in _ANIMATIONS and not _HARMLESS.match(child.get("attributeName", "")):
            raise unread("animations are not read")


def _is_css(element: Element) -> bool:
    if element.get("media", "all").strip() not in ("", "all", "screen"):
        raise unread("a style sheet for some media only is not read")
    return element.get("type", "text/css").strip() in ("", "text/css")


def _is_chosen(element: Element) -> bool:
    """Whether its conditions hold. No extensions are supported."""
    if element.get("systemLanguage") or element.get("requiredFeatures"):
        raise unread("drawn for some languages or features only: not read")
    return _kind(element) != "" and not element.get("requiredExtensions")
