"""Every rung of the ladder on one pair, in turn, as often as the budget allows."""

from __future__ import annotations

import math
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from msgspec.structs import replace

from satcheck.audit.request.settings import Method, Settings
from satcheck.audit.studied_pair import Bodies
from satcheck.audit.tradeoff.gauge import SPENT, Budget, Gauge
from satcheck.audit.tradeoff.result import PairTradeoff, with_front
from satcheck.audit.tradeoff.rows import row_of, truth_by
from satcheck.audit.tradeoff.rungs import EXACT, GROUPS, RUNGS, Rung
from satcheck.audit.tradeoff.runs import LadderRun, ask, ask_parts, ask_volume, climb_end
from satcheck.report.report import OVERLAPS

# What one run of convex parts may take whatever the budget: the default of a check.
PART_SECONDS = Settings().part_seconds


def measure_pair(
    bodies: Bodies,
    repeat: int,
    budget: Budget,
    on_run: Callable[[], None] | None = None,
    rungs: Sequence[Rung] | None = None,
    method: Method = "auto",
) -> PairTradeoff:
    """repeat: runs of each rung; what does not fit the budget is left away, and said. rungs: None
    for all; the exact one has to be among them. method: of the convex hulls, see Settings.

    Rungs take turns, so that what slows the machine down for a while slows all of them. Convex
    parts run cold with an empty cache of their own, then with what they have left in it; the cache
    of the user is neither read nor written. on_run: called after each run.
    """
    a, b = (body.id for body in bodies)
    gauges = {rung: Gauge(rung) for rung in rungs or RUNGS}
    plainly = _plain_check(bodies, budget)
    apart = plainly is not None and plainly.finding.relation not in OVERLAPS
    for group in (group for group in GROUPS for _ in range(repeat)):
        for gauge in (gauges[rung] for rung in group if rung in gauges):
            _leave_out(gauge, gauges)
            if gauge.wants_more and gauge.left(budget) > gauge.longest:
                _warm_up(bodies, budget)
                _run(gauge, bodies, budget, apart=apart, method=method)
            if on_run is not None:
                on_run()
    truth = truth_by(gauges[EXACT])
    rows = [row_of(gauge, truth) for gauge in gauges.values()]
    default = None if plainly is None else climb_end(plainly.finding)
    return PairTradeoff(a, b, truth, default, with_front(rows, truth.pad))


def _leave_out(gauge: Gauge, gauges: dict[Rung, Gauge]) -> None:
    """Finer parts take as long as coarser ones: where these were stopped, or are known to take more
    than there is left, those are not begun."""
    mine = gauge.rung.threshold
    if mine is None or gauge.reason != SPENT:
        return
    for rung, other in gauges.items():
        if (rung.threshold or 0.0) > mine:
            gauge.longest = max(gauge.longest, other.longest)
            if other.stopped_after is not None:
                limit = f"{other.stopped_after:.3g} s"
                gauge.reason = f"{SPENT}: {rung.label} was stopped after {limit}"


def _plain_check(bodies: Bodies, budget: Budget) -> LadderRun | None:
    """Return what `satcheck A B` finds; None where the budget is spent, or the exact rung will
    fail."""
    if budget.left <= 0:
        return None
    try:
        _import_early()
        ask(bodies, Settings(depth=True, accuracy="aabb"))
        return ask(bodies, Settings(depth=True))
    except Exception:  # noqa: BLE001 the row of the rung will say it
        return None


def _warm_up(bodies: Bodies, budget: Budget) -> None:
    """The cheapest question, not counted, before each run: what ran before, a dear rung or a child
    process, makes the next question slower, whichever it is."""
    if budget.left > 0:
        with suppress(Exception):  # the row of the rung will say it
            ask(bodies, Settings(depth=True, accuracy="aabb"))


def _import_early() -> None:
    """Import what the first question needs: it is no cost of the rung that asks it."""
    import satcheck.core.overlap_volume
    import satcheck.decompose.computation  # noqa: F401


def _run(gauge: Gauge, bodies: Bodies, budget: Budget, *, apart: bool, method: Method) -> None:
    start = budget.spent
    with _failing_alone(gauge):
        accuracy, threshold = gauge.rung.accuracy, gauge.rung.threshold
        if accuracy is None:
            _run_boolean(gauge, bodies, budget)
        elif threshold is not None:
            _run_parts(gauge, threshold, bodies, budget)
        else:
            settings = Settings(depth=True, accuracy=accuracy, method=method)
            if apart and gauge.rung == EXACT:
                settings = replace(settings, clearance=_beyond(bodies))
            answer = ask(bodies, settings)
            gauge.saw(answer, answer.seconds, None)
    took = budget.spent - start
    gauge.longest, gauge.spent = max(gauge.longest, took), gauge.spent + took


@contextmanager
def _failing_alone(gauge: Gauge) -> Iterator[None]:
    """A rung that fails is a row that says so."""
    try:
        yield
    except Exception as error:  # noqa: BLE001 whatever it is
        gauge.fail(f"internal error: {type(error).__name__}: {error}")


def _beyond(bodies: Bodies) -> float:
    """A clearance beyond any gap of the bodies: it has the exact rung measure it."""
    corners = [corner for body in bodies for corner in body.world_mesh().bounds]
    largest = max(abs(c) for corner in corners for c in corner)
    return math.ldexp(1.0, math.frexp(largest)[1] + 2)


def _run_parts(gauge: Gauge, threshold: float, bodies: Bodies, budget: Budget) -> None:
    limit = min(PART_SECONDS, gauge.left(budget))
    with ExitStack() as stack:
        folder = Path(tempfile.mkdtemp(prefix="satcheck-tradeoff-"))
        stack.callback(shutil.rmtree, folder, ignore_errors=True)
        settings = Settings(
            depth=True,
            accuracy="parts",
            part_threshold=threshold,
            part_seconds=limit,
            cache_directory=str(folder),
        )
        cold = ask_parts(bodies, settings)
        if cold.failure is not None:
            if limit < PART_SECONDS and cold.seconds >= limit:
                gauge.stop(limit)
            else:
                gauge.fail(cold.failure)
            return
        cached = ask_parts(bodies, settings) if cold.split else None
    reread = cached is not None and cached.from_cache
    gauge.saw(cold, cold.seconds, cached.seconds if cached is not None and reread else None)


def _run_boolean(gauge: Gauge, bodies: Bodies, budget: Budget) -> None:
    settings, start = Settings(), budget.spent
    limit = min(settings.volume_seconds, gauge.left(budget))
    volume = ask_volume(bodies, replace(settings, volume_seconds=limit))
    if isinstance(volume, str):
        if limit < settings.volume_seconds and budget.spent - start >= limit:
            gauge.stop(limit)
        else:
            gauge.fail(volume)
    else:
        gauge.saw(volume, volume.cold, volume.cached)
