"""Every rung of the ladder on one pair, in turn, as often as the budget allows."""

from __future__ import annotations

import math
import shutil
import tempfile
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic

from satcheck.audit.asked.settings import Settings
from satcheck.audit.report.report import OVERLAPS, Finding
from satcheck.audit.tradeoff.asking import Asked, Bodies, Measured, ask, ask_parts, ask_volume
from satcheck.audit.tradeoff.figure import Truth, figure_of, is_of_bodies, plain, truth_of
from satcheck.audit.tradeoff.result import PairTradeoff, Picked, Row, State, with_front
from satcheck.audit.tradeoff.rungs import BOOLEAN, EXACT, GROUPS, RUNGS, Rung
from satcheck.audit.tradeoff.times import Times
from satcheck.core.frozen import replace

SPENT = "budget"
# What one run of convex parts may take whatever the budget: the default of a check.
PART_SECONDS = Settings().part_seconds
# Stages of a plan that are rungs, and how they are called here.
STAGES = {"aabb": "aabb", "obb": "obb", "sat": "hull", "hull": "hull", "curved": "hull"}
STAGES |= {"curved-exact": "hull", "parts": "parts", "triangles": "exact"}


# What a stage records that had nothing to add to the one below.
SKIPPED = "skipped"


class Budget:
    """Wall-clock seconds for a whole run, and for all runs of one rung on one pair."""

    def __init__(self, seconds: float, per_rung: float = math.inf) -> None:
        self.seconds = seconds
        self.per_rung = per_rung
        self._start = monotonic()

    @property
    def spent(self) -> float:
        return monotonic() - self._start

    @property
    def left(self) -> float:
        return self.seconds - self.spent


@dataclass(slots=True)
class Gauge:
    """What has been seen of a rung so far."""

    rung: Rung
    state: State = "not run"
    reason: str | None = SPENT
    answer: Asked | Measured | None = None
    cold: list[float] = field(default_factory=list)
    cached: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    megabytes: float | None = None
    longest: float = 0.0
    spent: float = 0.0
    stopped_after: float | None = None

    @property
    def wants_more(self) -> bool:
        """It has answered, or has not been asked."""
        return self.state == "answered" or self.reason == SPENT

    def left(self, budget: Budget) -> float:
        return min(budget.left, budget.per_rung - self.spent)

    def stop(self, limit: float) -> None:
        """A run did not end within this; what an earlier one has answered stands."""
        self.longest, self.stopped_after = math.inf, limit
        if self.state != "answered":
            self.reason = f"{SPENT}: stopped after {limit:.3g} s"

    def fail(self, reason: str) -> None:
        self.state, self.reason = "failed", reason

    def saw(self, answer: Asked | Measured, cold: float, cached: float | None) -> None:
        self.state, self.reason = "answered", None
        self.answer = self.answer or answer
        self.cold.append(cold)
        if isinstance(answer, Asked) and answer.cpu is not None:
            self.cpu.append(answer.cpu)
        if cached is not None:
            self.cached.append(cached)
        if answer.megabytes is not None:
            self.megabytes = max(self.megabytes or 0.0, answer.megabytes)


def measure_pair(
    bodies: Bodies,
    repeat: int,
    budget: Budget,
    told: Callable[[], None] | None = None,
    rungs: Sequence[Rung] | None = None,
) -> PairTradeoff:
    """repeat: runs of each rung; what does not fit the budget is left away, and said. rungs: None
    for all; the exact one has to be among them.

    Rungs take turns, so that what slows the machine down for a while slows all of them. Convex
    parts run cold with an empty cache of their own, then with what they have left in it; the cache
    of the user is neither read nor written. told: called after each run.
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
                _run(gauge, bodies, budget, apart=apart)
            if told is not None:
                told()
    truth = _truth(gauges[EXACT])
    rows = [_row(gauge, truth) for gauge in gauges.values()]
    picked = None if plainly is None else _picked(plainly.finding)
    return PairTradeoff(a, b, truth, picked, with_front(rows, truth.pad))


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


def _plain_check(bodies: Bodies, budget: Budget) -> Asked | None:
    """What `satcheck A B` finds; None where the budget is spent, or the exact rung will fail."""
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
    """What the first question imports is no cost of the rung that asks it."""
    import satcheck.core.overlap_volume
    import satcheck.decompose.computation  # noqa: F401


def _run(gauge: Gauge, bodies: Bodies, budget: Budget, *, apart: bool) -> None:
    start = budget.spent
    try:
        if gauge.rung == BOOLEAN:
            _run_boolean(gauge, bodies, budget)
        elif gauge.rung.threshold is not None:
            _run_parts(gauge, bodies, budget)
        else:
            answer = ask(bodies, _settings(gauge.rung, bodies, apart=apart))
            gauge.saw(answer, answer.seconds, None)
    except Exception as error:  # noqa: BLE001 a rung that fails is a row that says so
        gauge.fail(f"internal error: {type(error).__name__}: {error}")
    took = budget.spent - start
    gauge.longest, gauge.spent = max(gauge.longest, took), gauge.spent + took


def _settings(rung: Rung, bodies: Bodies, *, apart: bool) -> Settings:
    """The exact rung is asked for the gap of bodies that are apart, by a clearance beyond any; the
    others say what their test has shown."""
    assert rung.accuracy is not None
    settings = Settings(depth=True, accuracy=rung.accuracy)
    if not apart or rung != EXACT:
        return settings
    corners = [corner for body in bodies for corner in body.world_mesh().bounds]
    largest = max(abs(c) for corner in corners for c in corner)
    return replace(settings, clearance=math.ldexp(1.0, math.frexp(largest)[1] + 2))


def _run_parts(gauge: Gauge, bodies: Bodies, budget: Budget) -> None:
    threshold = gauge.rung.threshold
    assert threshold is not None
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
            _fail_parts(gauge, cold, limit)
            return
        cached = ask_parts(bodies, settings) if cold.split else None
    reread = cached is not None and cached.from_cache
    gauge.saw(cold, cold.seconds, cached.seconds if cached is not None and reread else None)


def _fail_parts(gauge: Gauge, asked: Asked, limit: float) -> None:
    if limit < PART_SECONDS and asked.seconds >= limit:
        gauge.stop(limit)
        return
    assert asked.failure is not None
    gauge.fail(asked.failure)


def _run_boolean(gauge: Gauge, bodies: Bodies, budget: Budget) -> None:
    settings, start = Settings(), budget.spent
    limit = min(settings.volume_seconds, gauge.left(budget))
    found = ask_volume(bodies, replace(settings, volume_seconds=limit))
    if isinstance(found, str):
        if limit < settings.volume_seconds and budget.spent - start >= limit:
            gauge.stop(limit)
        else:
            gauge.fail(found)
    else:
        gauge.saw(found, found.cold, found.cached)


def _truth(exact: Gauge) -> Truth:
    answer = exact.answer
    if not isinstance(answer, Asked):
        return Truth(None, None, 0.0, f"the exact rung was not run: {exact.reason}")
    return truth_of(answer.finding, figure_of(answer.finding, answer.contact), answer.pad)


def _row(gauge: Gauge, truth: Truth) -> Row:
    row = Row(
        rung=gauge.rung,
        state=gauge.state,
        reason=gauge.reason,
        cold=Times(tuple(gauge.cold)) if gauge.cold else None,
        cached=Times(tuple(gauge.cached)) if gauge.cached else None,
        cpu=Times(tuple(gauge.cpu)) if gauge.cpu else None,
        megabytes=gauge.megabytes,
    )
    answer = gauge.answer
    if gauge.state != "answered" or answer is None:
        return row
    if isinstance(answer, Measured):
        return _with_volume(row, answer, truth)
    finding = answer.finding
    relation = plain(finding.relation)
    known = is_of_bodies(finding) and relation != "indeterminate"
    overlap = relation in OVERLAPS if known else None
    figure = figure_of(finding, answer.contact)
    return replace(
        row,
        overlap=overlap,
        relation=relation,
        proven=known and finding.exact_relation is not None,
        right=truth.is_right(overlap, relation),
        figure=figure,
        error=truth.error(figure),
        hulls=answer.hulls,
        settled_by=_ended(answer),
        reason=None if known else finding.reason,
    )


def _ended(answer: Asked) -> str:
    """The rung of its last step; parts that nobody could make are the hulls of the bodies."""
    rung = _picked(answer.finding).rung
    return "hull" if rung == "parts" and not answer.split else rung


def _with_volume(row: Row, answer: Measured, truth: Truth) -> Row:
    """A volume within its own error says nothing, except that there is none to be seen."""
    overlap = None if 0 < answer.volume <= answer.error else answer.volume > 0
    return replace(
        row,
        overlap=overlap,
        right=truth.is_right(overlap, None),
        volume=answer.volume,
        volume_error=answer.error,
        reason="the volume lies within its own error" if overlap is None else None,
    )


def _picked(finding: Finding) -> Picked:
    """The last stage that is a rung ended the climb; those before say why they could not."""
    climbed = [stage for stage in finding.plan if stage.stage in STAGES]
    why = "; ".join(
        f"{stage.stage} {stage.result}" + (f" ({stage.detail})" if stage.detail else "")
        for stage in climbed
    )
    ran = [STAGES[stage.stage] for stage in climbed if stage.result != SKIPPED]
    settled = finding.exact_relation is not None and is_of_bodies(finding)
    return Picked(ran[-1] if ran else "none", settled, why if settled else _unsettled(finding, why))


def _unsettled(finding: Finding, why: str) -> str:
    return "; ".join(said for said in (why, finding.reason) if said)
