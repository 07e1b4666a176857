"""The search for the thickness of a pair, in a thread beside the search for its depth: other pairs
leave no core to it, but the only pair of a check does."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Thread
from time import perf_counter_ns
from typing import TYPE_CHECKING

from satcheck.audit.figures.thickness import first_search, why_not_thick

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.audit.bodies.pair import Pair


# Both searches need memory for each triangle. If the bodies have more triangles, one search runs
# after the other.
MOST_TRIANGLES = 1_000_000


class StoppedError(Exception):
    """Ends a search that nobody waits for."""


class Ahead:
    """The first search for the thickness of a pair, in a thread of its own. nanoseconds: how long
    it took, once it has ended."""

    def __init__(self, pair: Pair) -> None:
        self._pair = pair
        self.nanoseconds = 0
        self._stopped = False
        self._outcome: core.ThicknessInterval | BaseException | None = None
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def result(self) -> core.ThicknessInterval:
        """Waits for the search. Raises what it raised."""
        self._thread.join()
        if isinstance(self._outcome, BaseException):
            raise self._outcome
        if self._outcome is None:
            raise AssertionError("the search ended without a result")
        return self._outcome

    def stop(self) -> None:
        self._stopped = True
        self._thread.join()

    def _run(self) -> None:
        began = perf_counter_ns()
        try:
            self._outcome = first_search(self._pair, self._go_on)
        except BaseException as error:  # noqa: BLE001 result() raises it
            self._outcome = error
        self.nanoseconds = perf_counter_ns() - began

    def _go_on(self) -> None:
        if self._stopped:
            raise StoppedError


@contextmanager
def thickness_ahead(pair: Pair) -> Iterator[Ahead | None]:
    """Of an overlap of which the depth is searched. None: the thickness is not searched ahead."""
    ahead = _started(pair)
    try:
        yield ahead
    finally:
        if ahead is not None:
            ahead.stop()


def _started(pair: Pair) -> Ahead | None:
    if pair.both_convex or pair.settings.jobs == 1 or pair.triangles > MOST_TRIANGLES:
        return None
    if why_not_thick(pair) is not None:
        return None
    pair.a.surface(), pair.b.surface()  # made once, for both searches
    try:
        return Ahead(pair)
    except RuntimeError:  # the system grants no more threads
        return None
