"""The order in which pairs are checked, on all cores, and when the data of a body is released.

Pairs follow a curve through space, so the pairs of one body are close to each other in the order,
and only a few bodies have a surface in memory at a time. Pairs go in batches. The core climbs the
ladder with all pairs of a batch, in its own threads, while Python makes the findings of the batch
before. Slow figures, such as a depth, run in threads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, TypeVar

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.ladder.core_climb import leaves_work, start_climbs
from satcheck.audit.parallel import in_parallel

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody

T = TypeVar("T")

# Below this many pairs, starting threads costs more than they save.
PARALLEL_PAIRS = 8
# The most pairs of a batch. Two batches are under way at a time. A larger batch would hold more
# results in memory and delay Ctrl-C. BATCH_TRIANGLES: the most triangles of a batch for each
# thread; ten million take about a second and a gigabyte.
BATCH_PAIRS = 256
BATCH_TRIANGLES = 250_000


Climbs = Sequence["core.Climb | None"]
Examine = Callable[[Pair, "core.Climb | None"], T]


class PairQueue(Struct, frozen=True):
    """jobs: threads, 0 for one a core. keep: do not release the data of the bodies, because another
    check needs them."""

    jobs: int
    keep: bool = False

    def each(
        self, pairs: Sequence[Pair], examine: Examine[T], *, alone: bool = False
    ) -> Iterator[tuple[int, T]]:
        """Yield (k, examine(pairs[k], its climb)) for every pair, in an order that keeps near pairs
        together. alone: no two pairs at once, and examine climbs itself."""
        order = _along_curve(pairs)
        leaving = {} if self.keep else _leaving(pairs, order)
        threads = 1 if alone else self._threads(len(pairs))
        for batch, climbs in _climbed(pairs, _batches(pairs, order, threads), threads, alone):
            results = _examined([pairs[k] for k in batch], climbs, examine, threads)
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
    pairs: Sequence[Pair], batches: Iterable[list[int]], threads: int, alone: bool
) -> Iterator[tuple[list[int], Climbs]]:
    """Yield each batch and its climbs, while the next one climbs."""
    ahead: tuple[list[int], Callable[[], Climbs]] | None = None
    for batch in batches:
        if alone:
            yield batch, [None] * len(batch)
            continue
        climbed = ahead and (ahead[0], ahead[1]())
        ahead = batch, start_climbs([pairs[k] for k in batch], threads)
        if climbed is not None:
            yield climbed
    if ahead is not None:
        yield ahead[0], ahead[1]()


def _examined(
    pairs: Sequence[Pair], climbs: Climbs, examine: Examine[T], threads: int
) -> Iterator[T]:
    """Yield the results of a batch, those that take long from threads."""
    heavy = [k for k, climb in enumerate(climbs) if leaves_work(pairs[k], climb)]
    if threads == 1 or len(heavy) < PARALLEL_PAIRS:
        yield from map(examine, pairs, climbs)
        return
    results = in_parallel(lambda k: examine(pairs[k], climbs[k]), heavy, threads)
    is_heavy = set(heavy)
    for k, (pair, climb) in enumerate(zip(pairs, climbs, strict=True)):
        yield next(results) if k in is_heavy else examine(pair, climb)
