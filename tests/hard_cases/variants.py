"""Motions that float64 does exactly: the truth stays, so the answer has to.

Each maps a pair to a pair; only `swapped` exchanges A and B.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tests.hard_cases.case import ConvexPair, Vertices

SCALE = 2.0**-9


def mapped(pair: ConvexPair, change: Callable[[Vertices], Vertices]) -> ConvexPair:
    return replace(pair, a=change(pair.a), b=change(pair.b))


def swapped(pair: ConvexPair) -> ConvexPair:
    return replace(pair, a=pair.b, b=pair.a)


def turned(pair: ConvexPair) -> ConvexPair:
    """Axes permuted: a rotation by 120 degrees."""
    return mapped(pair, lambda points: tuple((z, x, y) for x, y, z in points))


def mirrored(pair: ConvexPair) -> ConvexPair:
    """Two axes exchanged, one negated."""
    return mapped(pair, lambda points: tuple((y, x, 0.0 - z) for x, y, z in points))


def scaled(pair: ConvexPair) -> ConvexPair:
    return mapped(
        pair, lambda points: tuple((x * SCALE, y * SCALE, z * SCALE) for x, y, z in points)
    )


def reordered(pair: ConvexPair) -> ConvexPair:
    """The vertices in another order."""
    return mapped(pair, lambda points: tuple(sorted(points, key=lambda p: (p[2], -p[0], p[1]))))


VARIANTS: dict[str, Callable[[ConvexPair], ConvexPair]] = {
    "swapped": swapped,
    "turned": turned,
    "mirrored": mirrored,
    "scaled": scaled,
    "reordered": reordered,
}
