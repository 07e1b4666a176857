"""Labels beside the markers of a plot, clear of the markers and of each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

_CLEARANCE = 7.0  # points around a marker
_PIECES = 12  # of a line that labels keep clear of

# x and y, in the units of the axes.
Point = tuple[float, float]


class Labels:
    """Puts labels beside the markers of one panel, clear of the markers and of each other.

    Scales and limits of the axes have to be final.
    """

    # Offset in points, horizontal and vertical alignment: above, below, right, left, then further.
    _PLACES = tuple(
        (dx, dy, across, up)
        for away in (0.0, 13.0, 26.0)
        for dx, dy, across, up in (
            (0.0, 7.0 + away, "center", "bottom"),
            (0.0, -7.0 - away, "center", "top"),
            (9.0, away, "left", "center"),
            (-9.0, away, "right", "center"),
        )
    )

    def __init__(self, axes: Axes, markers: Sequence[Point]) -> None:
        """markers: in the units of the axes; labels keep clear of all of them."""
        self._axes = axes
        self._taken: list[Bbox] = []
        for marker in markers:
            at = axes.transData.transform(marker)
            self._taken.append(Bbox([at - _CLEARANCE, at + _CLEARANCE]))

    def keep_clear_of_line(self, start: Point, end: Point) -> None:
        ends = self._axes.transData.transform([start, end])
        for k in range(_PIECES):
            piece = [ends[0] + (ends[1] - ends[0]) * share / _PIECES for share in (k, k + 1)]
            low, high = np.minimum(*piece), np.maximum(*piece)
            self._taken.append(Bbox([low - 1.0, high + 1.0]))

    def place(self, words: str, markers: Sequence[Point]) -> None:
        """One label for markers of one height, where it covers least."""
        left, right = min(markers), max(markers)
        label = self._axes.annotate(words, left, xytext=(0, 0), textcoords="offset points")
        label.set_zorder(5)
        places = [
            (left if dx < 0 else right if dx > 0 else self._between(left, right), *place)
            for place in self._PLACES
            for dx in (place[0],)
        ]
        best = min(places, key=lambda place: self._cost(label, *place))
        self._cost(label, *best)
        self._taken.append(label.get_window_extent())

    def _between(self, left: Point, right: Point) -> Point:
        middle = self._axes.transData.transform([left, right]).mean(axis=0)
        x, _ = self._axes.transData.inverted().transform(middle)
        return float(x), left[1]

    def _cost(
        self, label: Annotation, at: Point, dx: float, dy: float, across: str, up: str
    ) -> float:
        """Move the label there; the area it then covers of what is taken, or lies outside."""
        label.xy = at
        label.set(position=(dx, dy), ha=across, va=up)
        box, frame = label.get_window_extent(), self._axes.bbox
        if across == "center":  # as far within the frame as it can be
            inwards = max(frame.x0 - box.x0, 0.0) + min(frame.x1 - box.x1, 0.0)
            label.set(position=(dx + inwards, dy))
            box = box.translated(inwards, 0.0)
        inside = Bbox.intersection(box, frame)
        outside = _area(box) - (0.0 if inside is None else _area(inside))
        covered = (Bbox.intersection(box, other) for other in self._taken)
        return outside + sum(_area(overlap) for overlap in covered if overlap is not None)


def _area(box: Bbox) -> float:
    return float(box.width * box.height)
