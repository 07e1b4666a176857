"""Where labels go in a drawing of points: beside their own, off the others and off each other."""

from __future__ import annotations

from collections.abc import Sequence

# Left, top, right, bottom, in pixels, y down.
Box = tuple[float, float, float, float]

_LETTER, _HEIGHT = 6.3, 13.0  # what a label takes at most
_REACH = 7.0  # a marker and the air around it
_AIR = 5.0  # to the left and the right of a label
_BASELINE = 3.0  # of a label, above its bottom


def around(x: float, y: float) -> Box:
    """What a marker takes."""
    return x - _REACH, y - _REACH, x + _REACH, y + _REACH


def baseline(box: Box) -> tuple[float, float]:
    """Where the text of a placed label starts."""
    return box[0], box[3] - _BASELINE


def place(text: str, beside: tuple[float, float, float], taken: Sequence[Box], frame: Box) -> Box:
    """Above, below, right, left, or so farther away: the first place within the frame with least in
    the way. Above and below it is moved sideways where it would leave the frame.

    beside: the leftmost and the rightmost of the points, and their height.
    """
    left, right, y = beside
    wide = _LETTER * len(text)
    middle = min(max(0.5 * (left + right - wide), frame[0]), frame[2] - wide)
    corners = [
        (x, y + dy)
        for away in (0.0, _HEIGHT, 2 * _HEIGHT)
        for x, dy in (
            (middle, -_REACH - _HEIGHT - away),
            (middle, _REACH + away),
            (right + _REACH + 1, -0.5 * _HEIGHT - away),
            (left - _REACH - 1 - wide, -0.5 * _HEIGHT - away),
        )
    ]
    boxes = [(x, top, x + wide, top + _HEIGHT) for x, top in corners]
    within = [box for box in boxes if _is_within(box, frame)]
    return min(within or boxes, key=lambda box: sum(_common(_aired(box), one) for one in taken))


def _aired(box: Box) -> Box:
    return box[0] - _AIR, box[1], box[2] + _AIR, box[3]


def _is_within(box: Box, frame: Box) -> bool:
    low = box[0] >= frame[0] and box[1] >= frame[1]
    return low and box[2] <= frame[2] and box[3] <= frame[3]


def _common(one: Box, other: Box) -> float:
    """The area that two boxes have in common."""
    wide = min(one[2], other[2]) - max(one[0], other[0])
    high = min(one[3], other[3]) - max(one[1], other[1])
    return max(wide, 0.0) * max(high, 0.0)
