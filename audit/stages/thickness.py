"""How thick an overlap is: the diameter of the largest ball that lies in both bodies.

The core narrows a proven interval (`core.search_thickness`). Bodies that are not closed have no
inside that holds a ball for certain, so that their overlaps have no thickness. The search runs in a
thread beside that for the depth, if the pair is the only one: other pairs leave no core to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import AbstractContextManager, closing, nullcontext
from time import perf_counter_ns
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.draft import Draft, Thickness
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import OVERLAPS, Ball

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.audit.pair import Pair


STAGE = "thickness"
# Both searches need memory for each triangle. If the bodies have more triangles, one search runs
# after the other.
MOST_TRIANGLES = 1_000_000
_NOTHING_AHEAD = nullcontext()


def why_not_thick(pair: Pair) -> str | None:
    """Why an overlap has no thickness; None: it has one."""
    if pair.curved:
        return "a curved shape has no triangles"
    if not pair.may("exact") and not (pair.may("hull") and pair.both_convex):
        return f"found on triangles: not at --accuracy {pair.settings.accuracy}"
    return _open(pair.a) or _open(pair.b)


def _open(body: PlacedBody) -> str | None:
    """Why the body is not closed; None: it is."""
    health = body.body.file.health
    if health.doubtful:
        return f"{body.id} has parts that may be solid or cavities"
    if not body.solid:
        return f"{body.id} has {'holes' if health.holes else 'no inside'}"
    return f"{body.id} has sheets" if body.shared.has_sheets() else None


def measure_thickness(draft: Draft) -> None:
    """Measure an overlap of closed bodies. No overlap is thicker than it is deep."""
    pair, depth = draft.pair, draft.depth
    if draft.exact not in OVERLAPS:
        return
    if (why_not := why_not_thick(pair)) is not None:
        draft.record(STAGE, "not known", why_not)
        draft.reason = draft.reason or f"no thickness: {why_not}"
        return
    work, limit = pair.thickness_work, pair.request.max_thickness
    known = _known_bound(draft)
    if draft.ahead is None:
        interval = _search(pair, pair.settings.width, work, None, most=known)
        draft.record(STAGE, *_outcome_of(interval))
    else:
        interval, nanoseconds = draft.ahead()
        draft.add(STAGE, *_outcome_of(interval), nanoseconds)
    draft.work += interval.work
    thickness = _thickness_of(interval)
    if limit is not None and thickness.lower <= limit < thickness.upper and interval.work < work:
        closer = _search(pair, EXACT_WIDTH, work - interval.work, limit, most=known)
        draft.work += closer.work
        draft.record(STAGE, *_outcome_of(closer))
        thickness = _narrower(thickness, _thickness_of(closer))
    if pair.closer:
        thickness = _of_curves(pair, thickness)
    most = math.inf if depth is None else max(depth.upper, thickness.lower)
    draft.thickness = replace(thickness, upper=min(thickness.upper, most))


def _known_bound(draft: Draft) -> float:
    """Return the depth as a bound of the thickness, if it is known before the search whatever the
    number of jobs. A proof is of the search alone."""
    pair, depth = draft.pair, draft.depth
    if depth is None or pair.triangles <= MOST_TRIANGLES or pair.settings.certificate:
        return math.inf
    return depth.upper


def first_search(pair: Pair, go_on: Callable[[], None] | None = None) -> core.ThicknessInterval:
    """To the width of the settings. go_on: called now and then; what it raises ends the search."""
    return _search(pair, pair.settings.width, pair.thickness_work, None, go_on)


def _search(
    pair: Pair,
    width: float,
    work: int,
    limit: float | None,
    go_on: Callable[[], None] | None = None,
    most: float = math.inf,
) -> core.ThicknessInterval:
    """limit: the search ends once the interval lies on one side of it. most: a known bound."""
    with pair.searching(STAGE) as show:

        def progress(lower: float, upper: float, share: float) -> None:
            if go_on is not None:
                go_on()
            show(lower, upper, share)

        return core.search_thickness(
            pair.a.surface(),
            pair.b.surface(),
            width=width,
            work=work,
            limit=limit,
            most=most,
            across=across(pair, prove=pair.settings.certificate),
            prove=pair.settings.certificate,
            threads=pair.settings.jobs if pair.alone else 1,
            progress=progress,
        )


def _outcome_of(interval: core.ThicknessInterval) -> tuple[str, str]:
    """The result and the details of a search, for the trace."""
    by = f"from {interval.lower:.6g} to {interval.upper:.6g} by {interval.boxes} boxes of space"
    if interval.stop == "work spent":
        return "budget spent", f"{by}; the budget ended the search"
    return interval.stop, by


def across(pair: Pair, *, prove: bool) -> int:
    """The axis to search along. What is to be proven is searched in space: prisms are higher than
    they are wide, so that the largest ball in both has the diameter of the largest disc."""
    return -1 if prove else pair.settings.across


def _thickness_of(interval: core.ThicknessInterval) -> Thickness:
    ball = None
    if interval.centre is not None and interval.lower > 0:
        ball = Ball(interval.centre, interval.radius)
    return Thickness(max(interval.lower, 0.0), max(interval.upper, 0.0), ball, interval.proof)


def _narrower(one: Thickness, other: Thickness) -> Thickness:
    thicker = max(one, other, key=lambda thickness: thickness.lower)
    thinner = min(one, other, key=lambda thickness: thickness.upper)
    return Thickness(thicker.lower, thinner.upper, thicker.ball, thinner.proof)


def _of_curves(pair: Pair, thickness: Thickness) -> Thickness:
    """In a check in a plane: of curves, from that of the polygons within them."""
    more = max(body.body.file.deviation for body in (pair.a, pair.b))
    return Thickness(thickness.lower, thickness.upper + 2 * more, thickness.ball)


class StoppedError(Exception):
    """Ends a search that nobody waits for."""


class _Ahead:
    """The first search for the thickness of a pair, in a thread of its own. Raises RuntimeError if
    the system grants no more threads."""

    def __init__(self, pair: Pair) -> None:
        from threading import Thread

        self._pair = pair
        self._stopped = False
        self._outcome: tuple[core.ThicknessInterval, int] | BaseException | None = None
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def result(self) -> tuple[core.ThicknessInterval, int]:
        """Wait for the search, and return its nanoseconds, too. Raises what it raised."""
        self._thread.join()
        if isinstance(self._outcome, BaseException):
            raise self._outcome
        assert self._outcome is not None
        return self._outcome

    def close(self) -> None:
        self._stopped = True
        self._thread.join()

    def _run(self) -> None:
        began = perf_counter_ns()
        try:
            self._outcome = first_search(self._pair, self._go_on), perf_counter_ns() - began
        except BaseException as error:  # noqa: BLE001 result() raises it
            self._outcome = error

    def _go_on(self) -> None:
        if self._stopped:
            raise StoppedError


def thickness_ahead(draft: Draft) -> AbstractContextManager[object]:
    """Begin to search the thickness of an overlap of which the depth is searched, if the pair is
    the only one, and long to search."""
    pair, wants = draft.pair, draft.pair.request.wants
    both = pair.alone and wants("depth") and wants("thickness")
    if not (both and draft.exact in OVERLAPS and _is_worth_a_thread(pair)):
        return _NOTHING_AHEAD
    pair.a.surface(), pair.b.surface()  # made once, for both searches
    try:
        ahead = _Ahead(pair)
    except RuntimeError:  # the system grants no more threads
        return _NOTHING_AHEAD
    draft.ahead = ahead.result
    return closing(ahead)


def _is_worth_a_thread(pair: Pair) -> bool:
    if pair.both_convex or pair.settings.jobs == 1 or pair.triangles > MOST_TRIANGLES:
        return False
    return why_not_thick(pair) is None
