"""The drawn size of the outermost element: the scale of its user units, and the unit it states.

`width` and `height` are the drawn size of the viewBox. `preserveAspectRatio` chooses the scale: the
smaller one (meet), the larger one (slice), or a separate one for each side (none). A missing side
follows from the other by the proportions of the viewBox. Source: W3C, "Scalable Vector Graphics
(SVG) 2", chapter 8.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal

from msgspec import Struct

from satcheck.scene.drawing.contour import Affine
from satcheck.scene.drawing.svg_values import (
    IDENTITY,
    LONGEST_LENGTH,
    NUMBER,
    PIXELS,
    aspect_ratio,
    bad,
    unread,
    view_box,
)

# Unit in a length -> (unit of length, how many of the written ones make one of it).
_STATED = {
    "um": ("um", 1.0),
    "mm": ("mm", 1.0),
    "cm": ("cm", 1.0),
    "m": ("m", 1.0),
    "in": ("in", 1.0),
    "pt": ("in", 72.0),
    "pc": ("in", 6.0),
}
_PIXELS_IN = {**PIXELS, "um": 96 / 25400, "m": 96 / 0.0254}
_SIDE = re.compile(rf"\s*({NUMBER})\s*([a-z]*)\s*")


class Drawn(Struct, frozen=True):
    """affine: from user units to coordinates. units: of the coordinates; None: not stated."""

    affine: Affine = IDENTITY
    units: str | None = None


class _Side(Struct, frozen=True):
    value: float
    written: str  # its unit


def drawn_size(attributes: Mapping[str, str], styled: bool) -> Drawn:
    """The size of the outermost element. styled: a style sets its size; such a size is not read.
    Raises MeshFileError if it has no size, or if it is stretched unevenly by an unknown amount."""
    box = view_box(attributes.get("viewBox", ""))
    if box is None:
        return Drawn()
    ways = aspect_ratio(attributes.get("preserveAspectRatio", ""))
    sides = [_side(attributes.get(key, "auto"), key) for key in ("width", "height")]
    if styled or "open" in sides:
        if ways is None:
            raise unread(
                'preserveAspectRatio "none" stretches the drawing, and width and height do not say '
                "how far: give both as lengths"
            )
        return Drawn()
    given = [side if isinstance(side, _Side) else None for side in sides]
    stated = (_STATED[side.written][0] for side in given if side and side.written in _STATED)
    units = next(stated, None)
    scales = [
        _length(side, units) / whole
        for side, whole in zip(given, box[2:], strict=True)
        if side is not None
    ]
    if not scales:
        return Drawn()
    x, y = scales[0], scales[-1]
    if ways is not None:
        x = y = max(x, y) if ways.slices else min(x, y)
    if units is None and x == y:
        return Drawn()
    return Drawn((x, 0.0, 0.0, 0.0, y, 0.0), units)


def _side(text: str, key: str) -> _Side | Literal["auto", "open"]:
    """ "open": it depends on something outside of the file."""
    if text.strip() in ("auto", ""):
        return "auto"
    match = _SIDE.fullmatch(text) if len(text) <= LONGEST_LENGTH else None
    if match is None or match[2] not in _PIXELS_IN:
        return "open"
    value = float(match[1])
    if not value > 0:
        raise bad(f"{key}: {text.strip()} is not positive")
    return _Side(value, match[2])


def _length(side: _Side, units: str | None) -> float:
    """The length in these units; None: in pixels."""
    if units is None:
        return side.value * _PIXELS_IN[side.written]
    unit, parts = _STATED.get(side.written, (None, 1.0))
    if unit == units:
        return side.value / parts
    return side.value * _PIXELS_IN[side.written] / _PIXELS_IN[units]
