"""The order in which pairs are examined, on all cores, and when what was made of a body is let go.

Pairs are taken along a curve through space, so that those of one body come close to each other: of
many bodies only a few have a surface in memory at a time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from satcheck import core
from satcheck.audit.pair import Pair
from satcheck.core.frozen import frozen

T = TypeVar("T")

# Below this many pairs, starting threads costs more than they save.
PARALLEL_PAIRS = 8
# Pairs handed to the threads at a time: no more results wait for their turn than these.
SLICE = 2048


@frozen
class InTurn:
    """jobs: threads, 0 for one a core. keep: what is made of the bodies, for another check."""

    jobs: int
    keep: bool = False

    def each(self, pairs: Sequence[Pair], examine: Callable[[Pair], T]) -> Iterator[tuple[int, T]]:
        """(k, examine(pairs[k])) of every pair, near ones after each other."""
        order = _along_curve(pairs)
        left = Counter(id(body) for pair in pairs for body in (pair.a, pair.b))
        results = _results([pairs[k] for k in order], examine, self.jobs)
        for k, one in zip(order, results, strict=True):
            for body in (pairs[k].a, pairs[k].b):
                left[id(body)] -= 1
                if not (left[id(body)] or self.keep):
                    body.let_go()
            yield k, one


def _along_curve(pairs: Sequence[Pair]) -> list[int]:
    bodies = {id(body): body for pair in pairs for body in (pair.a, pair.b)}
    order = core.order_along_curve([body.bounds for body in bodies.values()])
    keys = list(bodies)
    rank = {keys[number]: place for place, number in enumerate(order)}
    ends = [sorted((rank[id(pair.a)], rank[id(pair.b)])) for pair in pairs]
    return sorted(range(len(pairs)), key=ends.__getitem__)


def _results(pairs: list[Pair], examine: Callable[[Pair], T], jobs: int) -> Iterator[T]:
    import os

    threads = min(jobs or os.cpu_count() or 1, len(pairs))
    if threads <= 1 or len(pairs) < PARALLEL_PAIRS:
        yield from map(examine, pairs)
        return
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(threads)
    try:
        for start in range(0, len(pairs), SLICE):
            yield from pool.map(examine, pairs[start : start + SLICE])
    finally:
        pool.shutdown(cancel_futures=True)
