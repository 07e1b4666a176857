"""The findings of all pairs, on all cores, and when the data of a body is released.

Pairs follow a curve through space, so the pairs of one body are close to each other in the order,
and only a few bodies have a surface in memory at a time. Pairs go in batches. The core climbs the
ladder with all pairs of a batch, in its own threads, while Python makes the findings of the batch
before. Slow figures, such as a depth, run in threads. A pair that fails is a finding too, so that
the other pairs are still checked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, TypeVar

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.draft import Trace
from satcheck.audit.finding import Examined, examine, indeterminate
from satcheck.audit.pair import Pair
from satcheck.audit.parallel import in_parallel
from satcheck.audit.stages.core_climb import leaves_work, start_climbs
from satcheck.core.risky_steps import LeftOut, is_careful, not_for_lack_of_memory, risky_step
from satcheck.report.report import INTERNAL_ERROR, Finding, Issue

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.core import Climb


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


Progress = Callable[[int, int], None]


class CheckedPair(Struct, frozen=True):
    finding: Finding
    issues: tuple[Issue, ...] = ()


def examine_pairs(
    pairs: Sequence[Pair], queue: PairQueue, progress: Progress | None = None
) -> list[CheckedPair]:
    """The findings of pairs with the same settings, in their order."""
    done: dict[int, CheckedPair] = {}
    careful = is_careful()
    examine = _examine_carefully if careful else _examine
    for k, checked in queue.each(pairs, examine, alone=careful):
        done[k] = checked
        if progress is not None:
            progress(len(done), len(pairs))
    return [done[k] for k in range(len(pairs))]


def _examine_carefully(pair: Pair, _: Climb | None) -> CheckedPair:
    """One pair after another, and none that has ended the process before."""
    a, b = pair.a.id, pair.b.id
    try:
        with risky_step(f"checking {a!r} and {b!r}"):
            return _examine(pair, *start_climbs([pair], 1)())
    except LeftOut as error:
        reason = f"the process that checked this pair {error.message}"
        issue = Issue(error.code, "warning", None, None, f"{a} and {b}: {reason}")
        return CheckedPair(indeterminate(a, b, reason, Trace()), (issue,))


def _examine(pair: Pair, climb: Climb | None = None) -> CheckedPair:
    """One pair. A failure becomes a finding, so that the other pairs are still checked."""
    trace = Trace()
    try:
        examined = examine(pair, trace, climb)
        if pair.paths is not None:
            from satcheck.audit.motion.swept_finding import with_sweep

            examined = with_sweep(examined, pair, pair.paths, trace)
        finding = examined.finding
        if pair.request.wants("certificate"):
            finding = with_certificate(pair, examined)
        return CheckedPair(finding, tuple(trace.issues))
    except Exception as error:
        not_for_lack_of_memory(error)
        import logging

        logging.getLogger("satcheck").debug("a pair failed", exc_info=True)
        reason = f"internal error: {type(error).__name__}: {error}"
        message = f"{pair.a.id} and {pair.b.id}: {reason}"
        issue = Issue(INTERNAL_ERROR, "error", None, None, message)
        finding = indeterminate(pair.a.id, pair.b.id, reason, trace)
        return CheckedPair(finding, (*trace.issues, issue))


def with_certificate(pair: Pair, examined: Examined) -> Finding:
    """The finding with its evidence, or with a stage that says why there is none."""
    from satcheck.audit.certify import NoCertificate, certified

    trace, finding = Trace(), examined.finding
    if finding.motion is not None:
        trace.record("certificate", "none", "a sweep of moving bodies leaves no evidence")
        return replace(finding, plan=(*finding.plan, *trace.stages))
    try:
        certificate = certified(pair, examined)
    except Exception as error:  # noqa: BLE001 the verdict stands whatever becomes of its evidence
        not_for_lack_of_memory(error)
        certificate = NoCertificate(f"internal error: {type(error).__name__}: {error}")
    if isinstance(certificate, NoCertificate):
        trace.record("certificate", "none", certificate.reason)
        return replace(finding, plan=(*finding.plan, *trace.stages))
    kind = certificate.relation.__struct_config__.tag
    trace.record("certificate", str(kind), "accepted by the checker")
    return replace(finding, certificate=certificate, plan=(*finding.plan, *trace.stages))
