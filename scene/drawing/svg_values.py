"""Numbers, lengths, transforms and viewports of SVG. Source: W3C, "SVG 1.1", chapter 7."""

from __future__ import annotations

import math
import re
from functools import reduce

from msgspec import Struct

from satcheck.core.transform import cos_sin
from satcheck.scene.drawing.contour import Affine
from satcheck.scene.errors import MeshFileError

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
IDENTITY: Affine = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)

_ONE = re.compile(NUMBER)
_BETWEEN = re.compile(r"[\s,]*")
LONGEST_LENGTH = 64  # characters
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([a-z%]*)\s*")
# User units in one of a unit, if the drawing is not scaled.
PIXELS = {
    "": 1.0,
    "px": 1.0,
    "in": 96.0,
    "cm": 96 / 2.54,
    "mm": 96 / 25.4,
    "pt": 96 / 72,
    "pc": 16.0,
}
_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")
_ALIGNED = re.compile(r"\s*x(Min|Mid|Max)Y(Min|Mid|Max)(?:\s+(meet|slice))?\s*")
_SHARE = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


def bad(message: str) -> MeshFileError:
    return MeshFileError("bad-record", message)


def unread(message: str) -> MeshFileError:
    return MeshFileError("unsupported-feature", message)


def skip(text: str, place: int) -> int:
    """The place after spaces and commas."""
    match = _BETWEEN.match(text, place)
    return place if match is None else match.end()


def number_at(text: str, place: int, what: str) -> tuple[float, int] | None:
    """The longest number that starts at `place`, and the place after it; None: there is none.

    Raises MeshFileError for a number that is not finite.
    """
    match = _ONE.match(text, place)
    if match is None:
        return None
    value = float(match[0])
    if not math.isfinite(value):
        raise MeshFileError("non-finite", f"{what}: non-finite number")
    return value, match.end()


def numbers(text: str, what: str) -> list[float]:
    """All numbers of a text. A space, a comma or a character that cannot continue a number ends a
    number. Raises MeshFileError."""
    values = []
    place = skip(text, 0)
    while place < len(text):
        parsed = number_at(text, place, what)
        if parsed is None:
            raise bad(f"{what}: {text[place : place + 40]!r} is not a number")
        values.append(parsed[0])
        place = skip(text, parsed[1])
    return values


class Viewport(Struct, frozen=True):
    """The lengths that percentages refer to, user units; None: not stated."""

    width: float | None
    height: float | None

    def length(self, text: str, along: str, what: str) -> float:
        """A length in user units. along: "x", "y", or "d" for the diagonal. Raises
        MeshFileError."""
        match = _LENGTH.fullmatch(text) if len(text) <= LONGEST_LENGTH else None
        if match is None:
            raise bad(f"{what}: {text[:40]!r} is not a length")
        if match[2] == "%":
            return float(match[1]) / 100 * self._whole(along, what)
        if match[2] not in PIXELS:
            raise unread(f"{what}: the unit of {text[:40]!r} is not read")
        value = float(match[1]) * PIXELS[match[2]]
        if not math.isfinite(value):
            raise MeshFileError("non-finite", f"{what}: non-finite length")
        return value

    def _whole(self, along: str, what: str) -> float:
        sides = {"x": (self.width,), "y": (self.height,), "d": (self.width, self.height)}[along]
        known = [side for side in sides if side is not None]
        if len(known) < len(sides):
            raise unread(f"{what}: a percentage of a drawing whose size is not given")
        return math.hypot(*known) / math.sqrt(len(known)) if len(known) > 1 else known[0]


def compose(outer: Affine, inner: Affine) -> Affine:
    """First `inner`, then `outer`."""
    a, b, c, d, e, f = outer
    g, h, i, j, k, m = inner
    return (
        a * g + b * j,
        a * h + b * k,
        a * i + b * m + c,
        d * g + e * j,
        d * h + e * k,
        d * i + e * m + f,
    )


def translation(x: float, y: float) -> Affine:
    return (1.0, 0.0, x, 0.0, 1.0, y)


def transform(text: str) -> Affine:
    """A transform attribute. Raises MeshFileError."""
    affines, end = [IDENTITY], 0
    while call := _FUNCTION.match(text, end):
        end = call.end()
        affines.append(_function(call[1], numbers(call[2], call[1])))
    if text[end:].strip(" \t\r\n,") not in ("", "none"):
        raise bad(f"transform: {text[end : end + 40]!r} is not read")
    return reduce(compose, affines)


def _function(name: str, given: list[float]) -> Affine:
    match name, given:
        case "matrix", [a, b, c, d, e, f]:
            return (a, c, e, b, d, f)
        case "translate", [x]:
            return translation(x, 0.0)
        case "translate", [x, y]:
            return translation(x, y)
        case "scale", [x]:
            return (x, 0.0, 0.0, 0.0, x, 0.0)
        case "scale", [x, y]:
            return (x, 0.0, 0.0, 0.0, y, 0.0)
        case "rotate", [angle]:
            c, s = cos_sin(angle)
            return (c, -s, 0.0, s, c, 0.0)
        case "rotate", [angle, x, y]:
            turn = _function("rotate", [angle])
            return compose(compose(translation(x, y), turn), translation(-x, -y))
        case "skewX", [angle]:
            return (1.0, math.tan(math.radians(angle)), 0.0, 0.0, 1.0, 0.0)
        case "skewY", [angle]:
            return (1.0, 0.0, 0.0, math.tan(math.radians(angle)), 1.0, 0.0)
        case _:
            raise bad(f"transform: {name} does not take {len(given)} numbers")


def view_box(text: str) -> tuple[float, float, float, float] | None:
    """min x, min y, width, height; None if the attribute is empty. Raises MeshFileError."""
    if not text.strip():
        return None
    sides = numbers(text, "viewBox")
    if len(sides) != 4 or sides[2] <= 0 or sides[3] <= 0:
        raise bad(f"viewBox: {text[:40]!r} is not a rectangle")
    return (sides[0], sides[1], sides[2], sides[3])


class AspectRatio(Struct, frozen=True):
    """left, top: the share of the free space before the drawing. slices: the larger scale is used,
    and the drawing reaches beyond its frame."""

    left: float
    top: float
    slices: bool


def aspect_ratio(text: str) -> AspectRatio | None:
    """A preserveAspectRatio; None: it is not preserved. Raises MeshFileError."""
    if text.strip() == "none":
        return None
    match = _ALIGNED.fullmatch(text.strip() or "xMidYMid")
    if match is None:
        raise bad(f"preserveAspectRatio: {text[:40]!r} is not read")
    return AspectRatio(_SHARE[match[1]], _SHARE[match[2]], match[3] == "slice")


def fitted(
    box: tuple[float, float, float, float], width: float, height: float, aligned: str
) -> Affine:
    """From the coordinates of a viewBox to (0, 0, width, height), by preserveAspectRatio."""
    x, y = width / box[2], height / box[3]
    ratio = aspect_ratio(aligned)
    if ratio is None:
        return (x, 0.0, -box[0] * x, 0.0, y, -box[1] * y)
    scale = max(x, y) if ratio.slices else min(x, y)
    left = (width - box[2] * scale) * ratio.left - box[0] * scale
    top = (height - box[3] * scale) * ratio.top - box[1] * scale
    return (scale, 0.0, left, 0.0, scale, top)
