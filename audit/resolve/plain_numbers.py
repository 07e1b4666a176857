"""Places in short decimal numbers, where these are free as well: -45 and not -45.00000000000442."""

from __future__ import annotations

import math
from collections.abc import Collection

from satcheck.audit.bodies.boxes import Box, largest_coordinate
from satcheck.audit.report.report import Vector
from satcheck.audit.resolve.crowd import ORIGIN, Crowd
from satcheck.audit.resolve.wall import BodyPair

# Digits that a place keeps, counted from the first of the largest coordinate of its body: fewer
# are tried first.
DIGITS = (9, 12)


def write_plainly(crowd: Crowd, left: Collection[BodyPair], longest: float) -> None:
    """Round where bodies were moved to, one after the other: to the nearest number, or away from
    home. left: pairs that need not be free."""
    moved = [i for i, offset in enumerate(crowd.offsets) if offset != ORIGIN]
    boxes = [body.bounds for body in crowd.placed]
    for i in moved:
        boxes[i] = _around(boxes[i], 2 * _grain(crowd, i, DIGITS[0]))
    close = crowd.close_pairs(boxes)
    for i in moved:
        offset = crowd.offsets[i]
        around = [pair for pair in close if i in pair and pair not in left]
        for plainer in _plainer(crowd, i):
            crowd.move({i: plainer})
            if math.hypot(*plainer) <= longest and _are_free(crowd, around):
                break
            crowd.move({i: offset})


def _are_free(crowd: Crowd, pairs: Collection[BodyPair]) -> bool:
    return all(said.kind == "free" for said in crowd.opinions(list(pairs)).values())


def _plainer(crowd: Crowd, i: int) -> list[Vector]:
    """Translations that end at shorter numbers, those with the fewest digits first."""
    offset, body = crowd.offsets[i], crowd.home[i].body
    start = (0.0, 0.0, 0.0) if body.transform is None else body.transform[3:12:4]
    found: list[Vector] = []
    for digits in DIGITS:
        grain = _grain(crowd, i, digits)
        decimals = -round(math.log10(grain))
        for away in (0.0, 0.5):
            x, y, z = (
                _rounded(at, way, decimals, away * math.copysign(grain, way))
                for at, way in zip(start, offset, strict=True)
            )
            if (x, y, z) != offset and (x, y, z) not in found:
                found.append((x, y, z))
    return found


def _grain(crowd: Crowd, i: int, digits: int) -> float:
    """The power of ten that is the last of so many digits of the body's largest coordinate."""
    return 10.0 ** (math.ceil(math.log10(largest_coordinate(crowd.home[i].bounds))) - digits)


def _around(box: Box, margin: float) -> Box:
    (a, b, c), (x, y, z) = box
    return (a - margin, b - margin, c - margin), (x + margin, y + margin, z + margin)


def _rounded(start: float, way: float, decimals: int, away: float) -> float:
    """The way to the number next to where it ends, if that is shorter; 0 stays 0."""
    plainer = round(start + way + away, decimals) - start
    is_shorter = len(repr(start + plainer)) < len(repr(start + way))
    return plainer if way and is_shorter else way
