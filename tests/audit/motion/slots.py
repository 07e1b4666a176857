"""Slots along y that their sliders fit to the last bit, as outlines in x and z."""

from __future__ import annotations

from collections.abc import Sequence

from tests.audit.motion.pairs import Lists

Outline = Sequence[tuple[float, float]]

# A U: floor z < 0, walls x < 1 and x > 2.
CHANNEL: Outline = ((0, -1), (3, -1), (3, 1), (2, 1), (2, 0), (1, 0), (1, 1), (0, 1))
CHANNEL_PARTS = ((0, 1, 4, 5), (1, 2, 3, 4), (0, 5, 6, 7))


def channel(length: float = 5.0) -> Lists:
    return prism(CHANNEL, CHANNEL_PARTS, 0.0, length)


def tee(start: float, end: float) -> Lists:
    """A foot 3 wide and 1 high, and a stem 1 wide on it."""
    outline = ((1, 0), (4, 0), (4, 1), (3, 1), (3, 2), (2, 2), (2, 1), (1, 1))
    return prism(outline, ((0, 1, 2, 3, 6, 7), (3, 4, 5, 6)), start, end)


def tee_slot() -> Lists:
    outline = (
        *((0, -1), (5, -1), (5, 2), (3, 2), (3, 1), (4, 1)),
        *((4, 0), (1, 0), (1, 1), (2, 1), (2, 2), (0, 2)),
    )
    parts = ((0, 1, 6, 7), (1, 2, 5, 6), (2, 3, 4, 5), (0, 7, 8, 11), (8, 9, 10, 11))
    return prism(outline, parts, 0.0, 5.0)


def prism(outline: Outline, parts: Sequence[Sequence[int]], start: float, end: float) -> Lists:
    """outline: counter-clockwise seen against y. parts: convex pieces of it, by its corners."""
    n = len(outline)
    points = [(float(x), float(y), float(z)) for y in (start, end) for x, z in outline]
    walls = [(k, k + n, (k + 1) % n + n, (k + 1) % n) for k in range(n)]
    back = [tuple(k + n for k in reversed(face)) for face in parts]
    return points, [*walls, *map(tuple, parts), *back]
