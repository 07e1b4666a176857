"""Which rungs are worth their time: the Pareto front of error against time."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median, quantiles
from typing import Any, Protocol

from msgspec import Struct


class Times(Struct, frozen=True):
    """Seconds of every run, in the order in which they ran; one at least."""

    runs: tuple[float, ...]

    @property
    def median(self) -> float:
        return median(self.runs)

    def is_below(self, other: Times) -> bool:
        """By more than chance: each median lies outside of the middle half of the other's runs.
        Then a slow moment of the machine makes nothing faster or slower than something else."""
        return self.median < other._quartiles()[0] and self._quartiles()[1] < other.median

    def _quartiles(self) -> tuple[float, float]:
        if len(self.runs) == 1:
            return self.runs[0], self.runs[0]
        first, _, third = quantiles(self.runs, n=4, method="inclusive")
        return first, third

    def to_dict(self) -> dict[str, Any]:
        low, high = min(self.runs), max(self.runs)
        micro = {"median": self.median, "low": low, "high": high}
        return {key: 1e6 * value for key, value in micro.items()} | {"runs": len(self.runs)}


class Point(Protocol):
    """size_of_error: smaller is better. None: not known. standing: 0 for a proven answer that is
    right, 1 for a guess that is right, 2 for a wrong answer."""

    @property
    def cold(self) -> Times | None: ...
    @property
    def size_of_error(self) -> float | None: ...
    @property
    def standing(self) -> int: ...


_Answer = tuple[float, int]
_Key = tuple[Times, _Answer]


def front(points: Sequence[Point], pad: float) -> list[bool]:
    """Per point, whether no other beats it. pad: errors no farther apart than this are the same.

    One beats another that is nowhere better and somewhere worse: in time, in error, in standing. So
    a lucky guess takes no proven answer off the front, and a wrong answer no right one. Faster is
    what is so by more than chance (Times.is_below); of points as near and as sure that nothing else
    tells apart the first is on the front.
    """
    keys = _keys(points, pad)
    known = [key for key in keys if key is not None]
    answers: set[_Answer] = set()
    marks = []
    for key in keys:
        mark = key is not None and not any(_beats(other, key) for other in known)
        marks.append(mark and key is not None and key[1] not in answers)
        if mark and key is not None:
            answers.add(key[1])
    return marks


def _keys(points: Sequence[Point], pad: float) -> list[_Key | None]:
    sizes = sorted({p.size_of_error for p in points if p.size_of_error is not None})
    least: dict[float, float] = {}  # of the errors that are the same
    for before, size in zip((None, *sizes), sizes, strict=False):
        alike = before is not None and size - before <= pad
        least[size] = least[before] if alike and before is not None else size
    return [
        None
        if point.cold is None or point.size_of_error is None
        else (point.cold, (least[point.size_of_error], point.standing))
        for point in points
    ]


def _beats(point: _Key, rival: _Key) -> bool:
    """Of a ring of points that beat each other all would be as good, and each faster than the next:
    there is none, so the front of any points is not empty."""
    (time, answer), (rival_time, rival_answer) = point, rival
    as_good = all(p <= q for p, q in zip(answer, rival_answer, strict=True))
    better = answer != rival_answer or time.is_below(rival_time)
    return as_good and better and not rival_time.is_below(time)
