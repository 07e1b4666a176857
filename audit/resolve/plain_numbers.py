"""Short decimal numbers for places, if the bodies are free there too: -45 instead of
-45.00000000000442."""

from __future__ import annotations

import math
from collections.abc import Collection

from satcheck.audit.bodies.boxes import Box, largest_coordinate
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.walls import ORIGIN, BodyPair
from satcheck.core.conventions import Vector

# Digits that a place keeps, counted from the first of the largest coordinate of its body: fewer
# are tried first.
DIGITS = (9, 12)


def write_plainly(layout: Layout, left: Collection[BodyPair], longest: float) -> None:
    """Rounds the places of moved bodies, one body after another, to the nearest number or away from
    home. left: pairs that need not be free."""
    moved = [i for i, offset in enumerate(layout.offsets) if offset != ORIGIN]
    boxes = [body.bounds for body in layout.placed]
    for i in moved:
        boxes[i] = _around(boxes[i], 2 * _grain(layout, i, DIGITS[0]))
    close = layout.close_pairs(boxes)
    for i in moved:
        offset = layout.offsets[i]
        around = [pair for pair in close if i in pair and pair not in left]
        for plainer in _plainer(layout, i):
            layout.move({i: plainer})
            if math.hypot(*plainer) <= longest and _are_free(layout, around):
                break
            layout.move({i: offset})


def _are_free(layout: Layout, pairs: Collection[BodyPair]) -> bool:
    return all(state.kind == "free" for state in layout.states(list(pairs)).values())


def _plainer(layout: Layout, i: int) -> list[Vector]:
    """Translations that end at shorter numbers, those with the fewest digits first."""
    offset, body = layout.offsets[i], layout.home[i].body
    start = (0.0, 0.0, 0.0) if body.transform is None else body.transform[3:12:4]
    translations: list[Vector] = []
    for digits in DIGITS:
        grain = _grain(layout, i, digits)
        decimals = -round(math.log10(grain))
        for away in (0.0, 0.5):
            x, y, z = (
                _rounded(at, way, decimals, away * math.copysign(grain, way))
                for at, way in zip(start, offset, strict=True)
            )
            if (x, y, z) != offset and (x, y, z) not in translations:
                translations.append((x, y, z))
    return translations


def _grain(layout: Layout, i: int, digits: int) -> float:
    """The power of ten that is the last of so many digits of the body's largest coordinate."""
    return 10.0 ** (math.ceil(math.log10(largest_coordinate(layout.home[i].bounds))) - digits)


def _around(box: Box, margin: float) -> Box:
    (a, b, c), (x, y, z) = box
    return (a - margin, b - margin, c - margin), (x + margin, y + margin, z + margin)


def _rounded(start: float, way: float, decimals: int, away: float) -> float:
    """The way to the nearest short number, if that has fewer digits; 0 stays 0."""
    plainer = round(start + way + away, decimals) - start
    is_shorter = len(repr(start + plainer)) < len(repr(start + way))
    return plainer if way and is_shorter else way
