"""The order in which pairs are checked, on all cores, and when the data of a body is released.

Pairs follow a curve through space, so the pairs of one body are close to each other in the order,
and only a few bodies have a surface in memory at a time. Pairs go in batches. The core climbs the
ladder with all pairs of a batch, in its own threads, while Python makes the findings of the batch
before. Slow figures, such as a depth, run in threads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Generic, TypeVar

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.pair import Pair

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from satcheck.audit.bodies.placed_body import PlacedBody

C = TypeVar("C")
T = TypeVar("T")

# Below this many pairs, starting threads costs more than they save.
PARALLEL_PAIRS = 8
# The most pairs of a batch. Two batches are under way at a time. A larger batch would hold more
# results in memory and delay Ctrl-C. BATCH_TRIANGLES: the most triangles of a batch for each
# thread; ten million take about a second and a gigabyte.
BATCH_PAIRS = 256
BATCH_TRIANGLES = 250_000


class Steps(Struct, Generic[C, T], frozen=True):
    """The steps of a check. start_climbs(pairs, threads) starts a batch; the function that it
    returns waits for the results. examine(pair, climb) makes one result. leaves_work(pair, climb):
    whether examine takes long."""

    start_climbs: Callable[[Sequence[Pair], int], Callable[[], Sequence[C]]]
    examine: Callable[[Pair, C], T]
    leaves_work: Callable[[Pair, C], bool]


class PairQueue(Struct, frozen=True):
    """jobs: threads, 0 for one a core. keep: do not release the data of the bodies, because another
    check needs them."""

    jobs: int
    keep: bool = False

    def each(self, pairs: Sequence[Pair], steps: Steps[C, T]) -> Iterator[tuple[int, T]]:
        """(k, examine(pairs[k])) for every pair, in an order that keeps near pairs together."""
        order = _along_curve(pairs)
        leaving = {} if self.keep else _leaving(pairs, order)
        threads = self._threads(len(pairs))
        with ExitStack() as stack:
            workers = _Workers(threads, stack)
            batches = _batches(pairs, order, threads)
            for batch, climbs in _climbed(pairs, batches, steps, threads):
                results = workers.do([pairs[k] for k in batch], climbs, steps)
                for k, result in zip(batch, results, strict=True):
                    for body in leaving.get(k, ()):
                        body.release()
                    yield k, result

    def _threads(self, pairs: int) -> int:
        import os

        return min(self.jobs or os.cpu_count() or 1, pairs) if pairs >= PARALLEL_PAIRS else 1


def _along_curve(pairs: Sequence[Pair]) -> list[int]:
    bodies = {id(body): body for pair in pairs for body in (pair.a, pair.b)}
    order = core.order_along_curve([body.bounds for body in bodies.values()])
    keys, count = list(bodies), len(bodies)
    rank = {keys[number]: place for place, number in enumerate(order)}
    places = []  # sort key: the position of the earlier body, then of the other one
    for pair in pairs:
        a, b = rank[id(pair.a)], rank[id(pair.b)]
        places.append(a * count + b if a < b else b * count + a)
    return sorted(range(len(pairs)), key=places.__getitem__)


def _leaving(pairs: Sequence[Pair], order: Sequence[int]) -> dict[int, list[PlacedBody]]:
    """The number of a pair -> the bodies that no later pair needs."""
    leaving: dict[int, list[PlacedBody]] = {}
    seen = set()
    for k in reversed(order):
        for body in (pairs[k].a, pairs[k].b):
            if id(body) not in seen:
                seen.add(id(body))
                leaving.setdefault(k, []).append(body)
    return leaving


def _batches(pairs: Sequence[Pair], order: Sequence[int], threads: int) -> Iterator[list[int]]:
    batch: list[int] = []
    triangles = 0
    for k in order:
        batch.append(k)
        triangles += pairs[k].triangles
        is_heavy = triangles >= threads * BATCH_TRIANGLES and len(batch) >= threads
        if is_heavy or len(batch) == BATCH_PAIRS:
            yield batch
            batch, triangles = [], 0
    if batch:
        yield batch


def _climbed(
    pairs: Sequence[Pair], batches: Iterable[list[int]], steps: Steps[C, T], threads: int
) -> Iterator[tuple[list[int], Sequence[C]]]:
    """Each batch and its climbs, while the next one climbs."""
    ahead: tuple[list[int], Callable[[], Sequence[C]]] | None = None
    for batch in batches:
        climbed = ahead and (ahead[0], ahead[1]())
        ahead = batch, steps.start_climbs([pairs[k] for k in batch], threads)
        if climbed is not None:
            yield climbed
    if ahead is not None:
        yield ahead[0], ahead[1]()


class _Workers:
    """The threads of one run, started when the first pair needs them."""

    def __init__(self, threads: int, stack: ExitStack) -> None:
        self._threads = threads
        self._stack = stack
        self._pool: Executor | None = None

    def do(self, pairs: list[Pair], climbs: Sequence[C], steps: Steps[C, T]) -> Iterator[T]:
        heavy = [
            k
            for k, (pair, climb) in enumerate(zip(pairs, climbs, strict=True))
            if steps.leaves_work(pair, climb)
        ]
        if self._threads == 1 or len(heavy) < PARALLEL_PAIRS:
            yield from map(steps.examine, pairs, climbs)
            return
        try:
            examined = self._started().map(
                steps.examine, [pairs[k] for k in heavy], [climbs[k] for k in heavy]
            )
        except RuntimeError:  # the system grants no more threads
            self._end(RuntimeError)
            self._threads = 1
            yield from map(steps.examine, pairs, climbs)
            return
        is_heavy = set(heavy)
        for k, (pair, climb) in enumerate(zip(pairs, climbs, strict=True)):
            yield next(examined) if k in is_heavy else steps.examine(pair, climb)

    def _started(self) -> Executor:
        if self._pool is None:
            from concurrent.futures import ThreadPoolExecutor

            self._pool = ThreadPoolExecutor(self._threads)
            self._stack.push(self._end)
        return self._pool

    def _end(self, kind: type[BaseException] | None, *_: object) -> None:
        """After an error, such as Ctrl-C, does not wait for running work."""
        if self._pool is not None:
            self._pool.shutdown(wait=kind is None, cancel_futures=True)
