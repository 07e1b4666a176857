"""Which rungs are worth their time: the Pareto front of error against time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol


class Point(Protocol):
    """time, error: smaller is better; None: not known. standing: 0 for a proven answer that is
    right, 1 for a guess that is right, 2 for a wrong answer."""

    @property
    def time(self) -> float | None: ...
    @property
    def size_of_error(self) -> float | None: ...
    @property
    def standing(self) -> int: ...


def front(points: Sequence[Point]) -> list[bool]:
    """Per point, whether no other beats it.

    One beats another that is nowhere better and somewhere worse: in time, in error, in standing. So
    a lucky guess takes no proven answer off the front, and a wrong answer no right one.
    """
    keys = [_key(point) for point in points]
    return [
        key is not None and not any(_beats(other, key) for other in keys if other is not None)
        for key in keys
    ]


def _key(point: Point) -> tuple[float, float, int] | None:
    if point.time is None or point.size_of_error is None:
        return None
    return point.time, point.size_of_error, point.standing


def _beats(one: tuple[float, float, int], other: tuple[float, float, int]) -> bool:
    return one != other and all(p <= q for p, q in zip(one, other, strict=True))
