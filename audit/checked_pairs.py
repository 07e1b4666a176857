"""The findings of all pairs, on all cores, and when the data of a body is released.

Pairs follow a curve through space, so the pairs of one body are close to each other in the order,
and only a few bodies have a surface in memory at a time. Pairs go in batches. The core climbs the
ladder with all pairs of a batch, in its own threads, while Python makes the findings of the batch
before. Slow figures, such as a depth, run in threads. A pair that fails is a finding too, so that
the other pairs are still checked.

The climbs share the steps of the scene, which are counted, so that no number of threads changes
which pairs are decided. All pairs may first take a few of them. Those that want more climb again
with many times as many, as long as there are steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.draft import Draft, indeterminate
from satcheck.audit.finding import examine
from satcheck.audit.pair import (
    MOST_STEPS,
    STEPS_OF_COPIED_TRIANGLE,
    STEPS_OF_SCENE,
    STEPS_OF_SHAPE,
    STEPS_OF_TRIANGLE,
    Pair,
)
from satcheck.audit.parallel import in_parallel
from satcheck.audit.stages.relation import (
    NO_STEPS_LEFT,
    TOO_MANY_STEPS,
    leaves_work,
    start_climbs,
)
from satcheck.core.steps import LeftOut, is_careful, not_for_lack_of_memory, risky_step
from satcheck.report.report import INTERNAL_ERROR, OVERLAPS, Finding, Issue
from satcheck.report.verdict import fails

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.core import Climb

# Below this many pairs, starting threads costs more than they save.
PARALLEL_PAIRS = 8
# The most pairs of a batch. Two batches are under way at a time. A larger batch would hold more
# results in memory and delay Ctrl-C. BATCH_TRIANGLES: the most triangles of a batch for each
# thread; ten million take about a second and a gigabyte.
BATCH_PAIRS = 256
BATCH_TRIANGLES = 250_000

# The most triangles of bodies whose data wait for a later pair, about half a gigabyte. What is
# released before a pair needs it is made again.
HELD_TRIANGLES = 2_500_000

# Neighbours whose pairs come together, so that few bodies are in memory where all are in one place.
TILE = 64

# The factor of the steps of a pair that climbs again.
MORE_STEPS = 16

Progress = Callable[[int, int], None]


class CheckedPair(Struct, frozen=True):
    """draft: of a pair that fails and waits for its figures, and for what comes after them. steps:
    that it took. wants_more: with more of them it may prove more."""

    finding: Finding
    issues: tuple[Issue, ...] = ()
    draft: Draft | None = None
    steps: int = 0
    wants_more: bool = False


class StepsOfScene:
    """The steps that the pairs of a scene may still take, block after block."""

    def __init__(self) -> None:
        self.left = STEPS_OF_SCENE
        self._known: set[int] = set()

    def add(self, pairs: Sequence[Pair]) -> None:
        """Add the steps of bodies that were in no pair before. The only pair of a scene may take as
        many as any may."""
        if len(pairs) == 1 and not self._known:
            self.left = MOST_STEPS
        for body in _bodies_of(pairs):
            if id(body) not in self._known:
                self.left += self._steps_of(body)
                self._known |= {id(body), id(body.shared)}

    def _steps_of(self, body: PlacedBody) -> int:
        if body.curved is not None:
            return STEPS_OF_SHAPE
        is_copy = id(body.shared) in self._known
        a_triangle = STEPS_OF_COPIED_TRIANGLE if is_copy else STEPS_OF_TRIANGLE
        return a_triangle * body.shared.triangles


def examine_pairs(
    pairs: Sequence[Pair],
    jobs: int,
    progress: Progress | None = None,
    *,
    budget: StepsOfScene | None = None,
    keep: bool = False,
) -> list[CheckedPair]:
    """Return the findings of pairs with the same settings, in their order. jobs: threads, 0 for one
    a core. budget: of a scene of which other pairs take steps, too. keep: release only the data for
    which memory has no room, because another check needs them."""
    budget = budget or StepsOfScene()
    budget.add(pairs)
    done: dict[int, CheckedPair] = {}
    settled, wanting = 0, []
    waiting = _along_curve(pairs)
    steps = max(budget.left // max(2 * len(pairs) - 1, 1), 1)  # half of them, unless of one pair
    while waiting and budget.left >= steps:
        turn, waiting = waiting[: budget.left // steps], waiting[budget.left // steps :]
        for k, checked in _examined_within(pairs, turn, jobs, steps, keep=keep):
            done[k] = checked
            budget.left -= checked.steps
            if checked.wants_more:
                wanting.append(k)
            else:
                settled += 1
                if progress is not None:
                    progress(settled, len(pairs))
            if budget.left < 0:
                break
        if not waiting and budget.left >= 2 * steps:
            waiting, wanting, steps = wanting, [], min(MORE_STEPS * steps, budget.left)
    if progress is not None and settled < len(pairs):
        progress(len(pairs), len(pairs))
    return [done[k] if k in done else _beyond(pairs[k], keep=keep) for k in range(len(pairs))]


def _beyond(pair: Pair, *, keep: bool) -> CheckedPair:
    """Return what is known of a pair for which no steps are left."""
    for body in (pair.a, pair.b) if not keep else ():
        body.release()
    return CheckedPair(Draft(pair).indeterminate(NO_STEPS_LEFT), wants_more=True)


def _examined_within(
    pairs: Sequence[Pair], order: Sequence[int], jobs: int, steps: int, *, keep: bool
) -> Iterator[tuple[int, CheckedPair]]:
    """Yield the findings of the pairs in this order. steps: the most of each, beside those that any
    pair may take."""
    for k in order:
        pairs[k].steps = steps
    leaving, held = {} if keep else _leaving(pairs, order), _Held()
    for k, checked in _careful(pairs, order) if is_careful() else _batched(pairs, order, jobs):
        yield k, checked
        held.use(pairs[k].a, pairs[k].b)
        for body in leaving.get(k, ()):
            held.release(body)


class _Held:
    """Bodies whose data are in memory, the least recently used first."""

    def __init__(self) -> None:
        self._bodies: dict[PlacedBody, None] = {}
        self._triangles = 0

    def use(self, *bodies: PlacedBody) -> None:
        """Release the first ones if all bodies have too many triangles."""
        for body in bodies:
            if body in self._bodies:
                del self._bodies[body]
            else:
                self._triangles += body.shared.triangles
            self._bodies[body] = None
        while self._triangles > HELD_TRIANGLES and len(self._bodies) > len(bodies):
            self.release(next(iter(self._bodies)))

    def release(self, body: PlacedBody) -> None:
        del self._bodies[body]
        self._triangles -= body.shared.triangles
        body.release()


def _bodies_of(pairs: Sequence[Pair]) -> list[PlacedBody]:
    """Return the bodies, each once."""
    return [*dict.fromkeys([body for pair in pairs for body in (pair.a, pair.b)])]


def _along_curve(pairs: Sequence[Pair]) -> list[int]:
    bodies = _bodies_of(pairs)
    order = core.order_along_curve([body.bounds for body in bodies])
    rank = {bodies[number]: place for place, number in enumerate(order)}
    count = len(bodies)
    # The tiles of both bodies, then the bodies, each the earlier one first, as one number.
    places = []
    for pair in pairs:
        a, b = rank[pair.a], rank[pair.b]
        a, b = (a, b) if a < b else (b, a)
        tiles = a // TILE * count + b // TILE
        places.append((tiles * TILE + a % TILE) * TILE + b % TILE)
    return sorted(range(len(pairs)), key=places.__getitem__)


def _leaving(pairs: Sequence[Pair], order: Sequence[int]) -> dict[int, list[PlacedBody]]:
    """Return the number of a pair -> the bodies that no later pair needs."""
    last = {body: k for k in order for body in (pairs[k].a, pairs[k].b)}
    leaving: dict[int, list[PlacedBody]] = {}
    for body, k in last.items():
        leaving.setdefault(k, []).append(body)
    return leaving


def _batched(
    pairs: Sequence[Pair], order: Sequence[int], jobs: int
) -> Iterator[tuple[int, CheckedPair]]:
    """Yield the pairs batch by batch, each while the next one climbs."""
    import os

    if len(order) == 1:  # it climbs when it is examined
        yield order[0], examine_pair(pairs[order[0]])
        return
    threads = min(jobs or os.cpu_count() or 1, len(pairs)) if len(pairs) >= PARALLEL_PAIRS else 1
    ahead: tuple[list[int], Callable[[], list[Climb | None]]] | None = None
    for batch in _batches(pairs, order, threads):
        before = ahead and (ahead[0], ahead[1]())
        ahead = batch, start_climbs([pairs[k] for k in batch], threads)
        if before is not None:
            yield from _examined(pairs, *before, threads)
    if ahead is not None:
        yield from _examined(pairs, ahead[0], ahead[1](), threads)


def _batches(pairs: Sequence[Pair], order: Iterable[int], threads: int) -> Iterator[list[int]]:
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


def _examined(
    pairs: Sequence[Pair], batch: Sequence[int], climbs: Sequence[Climb | None], threads: int
) -> Iterator[tuple[int, CheckedPair]]:
    """Yield the pairs of a batch, those that take long from threads."""
    climb = dict(zip(batch, climbs, strict=True))
    heavy = [k for k in batch if threads > 1 and leaves_work(pairs[k], climb[k])]
    if len(heavy) < PARALLEL_PAIRS:
        for k in batch:
            yield k, examine_pair(pairs[k], climb[k])
        return
    results = in_parallel(lambda k: examine_pair(pairs[k], climb[k]), heavy, threads)
    is_heavy = set(heavy)
    for k in batch:
        yield k, next(results) if k in is_heavy else examine_pair(pairs[k], climb[k])


def _careful(pairs: Sequence[Pair], order: Sequence[int]) -> Iterator[tuple[int, CheckedPair]]:
    """Yield one pair after another, and none that has ended the process before."""
    for k in order:
        a, b = pairs[k].a.id, pairs[k].b.id
        try:
            with risky_step(f"checking {a!r} and {b!r}"):
                checked = examine_pair(pairs[k])
        except LeftOut as error:
            reason = f"the process that checked this pair {error.message}"
            issue = Issue(error.code, "warning", None, None, f"{a} and {b}: {reason}")
            checked = CheckedPair(indeterminate(a, b, reason), (issue,))
        yield k, checked


def examine_pair(pair: Pair, climb: Climb | None = None) -> CheckedPair:
    """Return the finding of one pair. A failure becomes a finding."""
    draft = Draft(pair)
    try:
        finding = examine(draft, climb)
        fails_now = finding.relation in OVERLAPS and fails(finding, pair.settings.fail_on)
        if pair.request.if_failing and fails_now:
            return CheckedPair(finding, (), draft, draft.steps, draft.wants_more)
        return finished(finding, draft)
    except Exception as error:  # noqa: BLE001  the other pairs are still checked
        return failed(draft, error)


def failed(draft: Draft, error: Exception) -> CheckedPair:
    """Return what an error that ended a step of a draft says of its pair."""
    if isinstance(error, core.TooManySteps):
        return _checked(draft.indeterminate(TOO_MANY_STEPS), draft)
    not_for_lack_of_memory(error)
    import logging

    logging.getLogger("satcheck").debug("a pair failed", exc_info=error)
    reason = f"internal error: {type(error).__name__}: {error}"
    message = f"{draft.pair.a.id} and {draft.pair.b.id}: {reason}"
    draft.issues.append(Issue(INTERNAL_ERROR, "error", None, None, message))
    return _checked(draft.indeterminate(reason), draft)


def finished(finding: Finding, draft: Draft) -> CheckedPair:
    """Return the finding at rest with what comes last: the sweep of the pair and its evidence."""
    if draft.pair.moves is not None:
        from satcheck.audit.motion.swept_finding import with_sweep

        finding = with_sweep(finding, draft, draft.pair.moves)
    if draft.pair.request.wants("certificate"):
        from satcheck.audit.stages.certificate import with_certificate

        finding = with_certificate(finding, draft)
    return _checked(finding, draft)


def _checked(finding: Finding, draft: Draft) -> CheckedPair:
    return CheckedPair(finding, (*draft.issues,), None, draft.steps, draft.wants_more)
