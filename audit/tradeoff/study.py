"""Every rung of the ladder on one pair, in turn, compared with what the exact one proves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from statistics import median
from time import monotonic

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.checked_pairs import Progress
from satcheck.audit.request.settings import Method, Settings
from satcheck.audit.studied_pair import Bodies, pair_of
from satcheck.audit.summary import tool
from satcheck.audit.tradeoff.runs import EXACT, RUNGS, Run, Rung, run
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import OVERLAPS
from satcheck.report.tradeoff import Row, Times, TradeoffReport, Truth, choices

SPENT = "budget"


class Measured(Struct):
    """The runs of a rung, the seconds that they took, and why it has no answer."""

    runs: list[Run] = []
    spent: float = 0.0
    failure: str | None = None


def tradeoff(
    bodies: Bodies,
    *,
    repeat: int = 5,
    budget: float = 60.0,
    rung_seconds: float = math.inf,
    rungs: Sequence[Rung] = RUNGS,
    method: Method = "auto",
    progress: Progress | None = None,
) -> TradeoffReport:
    """Each rung on two bodies, as they are placed.

    repeat: runs of each rung. budget: seconds for all of them; rung_seconds: for those of one rung.
    What does not fit is left away, and said. rungs: the exact one has to be among them. method: of
    the convex hulls, see Settings. progress(done, total) counts runs. Raises SatcheckError where a
    body cannot be placed.
    """
    start = monotonic()
    pair = pair_of(bodies, Settings())
    settings = Settings(depth=True, method=method)
    # A clearance beyond any gap: the exact rung measures it.
    beyond = replace(settings, clearance=2.0 ** (math.frexp(pair.largest_coordinate)[1] + 2))
    plain = Measured()
    if budget > monotonic() - start:
        _ask(EXACT, plain, bodies, budget, settings)
    measured = {rung: Measured() for rung in rungs}
    turns = _in_turn(rungs, repeat)
    for done, rung in enumerate(turns, 1):
        mine = measured[rung]
        left = min(budget - (monotonic() - start), rung_seconds - mine.spent)
        if mine.failure is None and left > 0:
            _ask(rung, mine, bodies, left, beyond if rung == EXACT else settings)
        if progress is not None:
            progress(done, len(turns))
    truth, pad = _truth(measured[EXACT]), rounding_pad(pair.largest_coordinate)
    rows = [_row(rung, mine, truth, pad) for rung, mine in measured.items()]
    return TradeoffReport(
        tool=tool(),
        units=bodies[0].units,
        repeat=repeat,
        budget=budget,
        seconds=monotonic() - start,
        a=bodies[0].id,
        b=bodies[1].id,
        truth=truth,
        default=next((one.row.settled_by for one in plain.runs if one.row.proven), None),
        rungs=with_front(rows),
    )


def _in_turn(rungs: Sequence[Rung], repeat: int) -> list[Rung]:
    """Rungs take turns, so that what slows the machine down for a while slows all of them. The
    exact one is the first, and convex parts, the dearest, are the last: a budget cuts these."""
    parts = [rung for rung in rungs if rung.name == "parts"]
    others = [EXACT, *(rung for rung in rungs if rung != EXACT and rung not in parts)]
    return repeat * others + repeat * parts


def _ask(rung: Rung, mine: Measured, bodies: Bodies, left: float, settings: Settings) -> None:
    start = monotonic()
    try:
        # Not counted: what ran before, such as a child process, makes the next question slower.
        run(RUNGS[0], bodies, left, settings)
        result = run(rung, bodies, left, settings)
    except Exception as error:  # noqa: BLE001 a rung that fails is a row that says so
        result = f"internal error: {type(error).__name__}: {error}"
    took = monotonic() - start
    mine.spent += took
    if isinstance(result, Run):
        mine.runs.append(result)
    elif took < left:  # else its time was over
        mine.failure = result


def _truth(exact: Measured) -> Truth:
    if not exact.runs:
        return Truth(None, None, f"the exact rung was not run: {exact.failure or SPENT}")
    row = exact.runs[0].row
    if not row.proven:
        return Truth(None, None, row.reason or "the exact rung has not proven it")
    low, high = row.bounds or (None, None)
    if low is None or high is None or math.isinf(high - low):
        return Truth(row.relation, None, None)
    return Truth(row.relation, (low, high), None)


def _row(rung: Rung, mine: Measured, truth: Truth, pad: float) -> Row:
    if mine.failure is not None:
        return Row(rung=rung.name, threshold=rung.threshold, state="failed", reason=mine.failure)
    if not mine.runs:
        return Row(rung=rung.name, threshold=rung.threshold, state="not run", reason=SPENT)
    row = mine.runs[0].row
    return replace(
        row,
        right=is_right(row, truth),
        error=error_of(row.signed_distance, truth, pad),
        cold=_times(one.cold for one in mine.runs),
        cached=_times(one.cached for one in mine.runs),
        cpu=_times(one.cpu for one in mine.runs),
    )


def is_right(row: Row, truth: Truth) -> bool | None:
    """Return whether an answer agrees. That bodies overlap is what a rung can know: `contains`,
    `inside` and `coincident` are overlaps like any."""
    if truth.relation is None or row.overlap is None:
        return None
    if row.overlap != (truth.relation in OVERLAPS):
        return False
    return row.overlap or row.relation in (None, truth.relation)


def error_of(value: float | None, truth: Truth, pad: float) -> float | None:
    """The value minus the nearest signed distance that is possible; 0.0 within rounding (pad)."""
    if value is None or truth.bounds is None:
        return None
    low, high = truth.bounds
    error = value - min(max(value, low), high)
    return 0.0 if abs(error) <= pad else error


def _times(seconds: Iterable[float | None]) -> Times | None:
    known = [1e6 * time for time in seconds if time is not None]
    return Times(median(known), min(known), max(known), len(known)) if known else None


def with_front(rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows with the marks of those on the Pareto front: a lucky guess takes no proven answer
    off it, and a wrong answer no right one."""
    keys = {row.label: _key(row) for row in choices(rows) if row.error is not None}
    front = {
        label
        for label, key in keys.items()
        if not any(
            other != key and all(o <= k for o, k in zip(other, key, strict=True))
            for other in keys.values()
        )
    }
    return tuple(replace(row, pareto=row.label in front) for row in rows)


def _key(row: Row) -> tuple[float, float, int]:
    """Smaller is better: time, error, standing."""
    return row.cold.median if row.cold else math.inf, abs(row.error or 0.0), row.standing
