"""Ask every rung of the ladder about one pair, and compare each answer with what the exact one
proves."""

from __future__ import annotations

import math
import os
import tempfile
import time
from collections.abc import Iterable, Sequence
from statistics import median
from time import monotonic, perf_counter
from typing import Literal, NamedTuple

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.checked_pairs import Progress
from satcheck.audit.draft import Draft
from satcheck.audit.finding import examine
from satcheck.audit.settings import Method, Settings
from satcheck.audit.stages.volume import measure_volume
from satcheck.audit.studied_pair import Bodies, pair_of
from satcheck.audit.summary import tool
from satcheck.core.errors import SatcheckError
from satcheck.core.peers import VolumeMeter
from satcheck.core.rounding import rounding_pad
from satcheck.decompose.result import Decomposition
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.tradeoff import Bounds, Row, RungName, Times, TradeoffReport, Truth

SPENT = "budget"
# Stages of a trace that are rungs, and their names here.
STAGES: dict[str, RungName] = {
    "aabb": "aabb",
    "obb": "obb",
    "sat": "hull",
    "hull": "hull",
    "curved": "hull",
    "curved-exact": "hull",
    "parts": "parts",
    "triangles": "exact",
}


class Rung(NamedTuple):
    """threshold: of convex parts, see satcheck.decompose. The Boolean is no rung of the ladder."""

    name: RungName
    threshold: float | None = None


EXACT, BOOLEAN = Rung("exact"), Rung("boolean")
PARTS = tuple(Rung("parts", threshold) for threshold in (0.5, 0.2, 0.1, 0.05, 0.02, 0.01))
RUNGS = (Rung("aabb"), Rung("obb"), Rung("hull"), *PARTS, EXACT, BOOLEAN)


class Runs(Struct):
    """The answers of a rung, the seconds that they took, and why there are no more."""

    rows: list[Row] = []
    spent: float = 0.0
    failure: str | None = None

    def add(self, rung: Rung, bodies: Bodies, left: float, settings: Settings) -> None:
        """Run the rung once more, unless it has failed, or no seconds are left."""
        if self.failure is not None or left <= 0:
            return
        start, failure = monotonic(), None
        try:
            # Not counted: what ran before, such as a child process, makes the next one slower.
            run(RUNGS[0], bodies, left, settings)
            self.rows.append(run(rung, bodies, left, settings))
        except SatcheckError as error:
            failure = str(error)
        except Exception as error:  # noqa: BLE001 a rung that fails is a row that says so
            failure = f"internal error: {type(error).__name__}: {error}"
        took = monotonic() - start
        self.spent += took
        self.failure = failure if took < left else None  # else its time was over


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
    """Measure each rung on two bodies, as they are placed.

    repeat: runs of each rung. budget: seconds for all of them; rung_seconds: for those of one rung.
    What does not fit is not run, and its row says so. rungs: the exact one has to be among them.
    method: of the convex hulls, see Settings. progress(done, total) counts runs. Raises
    SatcheckError where a body cannot be placed.
    """
    start = monotonic()
    largest = pair_of(bodies, Settings()).largest_coordinate
    settings = Settings(depth=True, method=method)
    # A clearance beyond any gap: the exact rung measures it.
    beyond = replace(settings, clearance=2.0 ** (math.frexp(largest)[1] + 2))
    plain = Runs()
    plain.add(EXACT, bodies, budget - (monotonic() - start), settings)
    runs = {rung: Runs() for rung in rungs}
    # Rungs take turns: what slows the machine down for a while slows all of them. The exact one is
    # the first, and convex parts, the dearest, are the last: a budget cuts these.
    parts = [rung for rung in rungs if rung.name == "parts"]
    others = [EXACT, *(rung for rung in rungs if rung != EXACT and rung not in parts)]
    turns = repeat * others + repeat * parts
    for done, rung in enumerate(turns, 1):
        left = min(budget - (monotonic() - start), rung_seconds - runs[rung].spent)
        runs[rung].add(rung, bodies, left, beyond if rung == EXACT else settings)
        if progress is not None:
            progress(done, len(turns))
    truth = _truth(runs[EXACT])
    return TradeoffReport(
        tool=tool(),
        units=bodies[0].units,
        repeat=repeat,
        budget=budget,
        seconds=monotonic() - start,
        a=bodies[0].id,
        b=bodies[1].id,
        truth=truth,
        default=next((row.settled_by for row in plain.rows if row.proven), None),
        rungs=tuple(_row(rung, own, truth, rounding_pad(largest)) for rung, own in runs.items()),
    )


def run(rung: Rung, bodies: Bodies, seconds: float, settings: Settings) -> Row:
    """Ask a rung, with hulls and trees made anew from the meshes in memory. seconds: that convex
    parts or a volume may take. Raises SatcheckError: why it has no answer."""
    if rung == BOOLEAN:
        limit = min(settings.volume_seconds, seconds)
        return _boolean(bodies, replace(settings, volume_seconds=limit))
    if rung.name != "parts":
        return _ladder(rung, bodies, replace(settings, accuracy=rung.name))[0]
    # A cache of its own, empty at first: that of the user is neither read nor written.
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        settings = replace(
            settings,
            accuracy="parts",
            part_threshold=rung.threshold,
            part_seconds=min(settings.part_seconds, seconds),
            cache_directory=folder,
        )
        row, made = _ladder(rung, bodies, settings)
        if not made:  # the hulls of the bodies are all there is
            return replace(row, settled_by="hull" if row.settled_by == "parts" else row.settled_by)
        again, reread = _ladder(rung, bodies, settings)
        return replace(row, cached=again.cold if all(one.from_cache for one in reread) else None)


def _ladder(rung: Rung, bodies: Bodies, settings: Settings) -> tuple[Row, list[Decomposition]]:
    """Return the answer of a rung and the convex parts that it has asked for. Raises SatcheckError
    if these cannot be made."""
    cpu, start = _cpu_seconds(), perf_counter()
    pair = pair_of(bodies, settings)
    draft = Draft(pair)
    finding = examine(draft)
    cold, cpu = perf_counter() - start, _cpu_seconds() - cpu
    made = [body.shared.decomposition.known for body in (pair.a, pair.b)]
    for error in made:
        if isinstance(error, SatcheckError):
            raise error
    # A clearance is asked only to have the gap measured.
    relation = "separated" if finding.relation == "near" else finding.relation
    known = is_of_bodies(finding) and relation != "indeterminate"
    value, bounds = signed_distance(finding, draft) or (None, None)
    row = Row(
        rung=rung.name,
        threshold=rung.threshold,
        state="answered",
        reason=None if known else finding.reason,
        overlap=relation in OVERLAPS if known else None,
        relation=relation,
        proven=known and finding.exact_relation is not None,
        signed_distance=value,
        bounds=bounds,
        settled_by=last_rung(finding),
        cold=_times([1e6 * cold]),
        cpu=_times([1e6 * cpu]),
    )
    return row, [one for one in made if isinstance(one, Decomposition)]


def last_rung(finding: Finding) -> RungName | None:
    """Return the rung at which the climb ended."""
    ran = [stage.stage for stage in finding.plan if stage.result != "skipped"]
    return next((STAGES[stage] for stage in reversed(ran) if stage in STAGES), None)


def is_of_bodies(finding: Finding) -> bool:
    """Return whether it says how the bodies relate, not their surfaces alone, or nothing."""
    return finding.undecided not in ("relation", "inside")


def signed_distance(finding: Finding, draft: Draft) -> tuple[float, Bounds] | None:
    """Return it with its bounds. draft: of the same ladder, for what it proves and nobody asked
    to report. None: no figure of the bodies; how far their surfaces are apart says nothing of one
    that may lie inside."""
    if not is_of_bodies(finding):
        return None
    if finding.depth_bounds is not None:
        low, high = finding.depth_bounds
        # An overlap that is not proven may be a gap, of any width.
        return -high + 0.0, (-high + 0.0, -low + 0.0 if draft.exact_proven else None)
    signed = draft.signed
    if signed is not None and signed.distance is not None:
        return signed.distance, (signed.lower, signed.upper)
    if finding.distance is not None:
        return finding.distance, (finding.distance, finding.distance)
    if draft.exact == "separated":
        return draft.gap_lower, (draft.gap_lower if draft.exact_proven else None, None)
    if draft.exact == "touching":
        return 0.0, (0.0, 0.0)
    band = finding.tolerance
    return None if finding.relation != "touching" or band is None else (0.0, (-band, None))


def _cpu_seconds() -> float:
    used = os.times()
    return time.process_time() + used.children_user + used.children_system


def _boolean(bodies: Bodies, settings: Settings) -> Row:
    """Measure the common volume by manifold3d, in a child process of its own, twice."""
    seconds, megabytes = settings.volume_seconds, settings.volume_megabytes
    took = []
    with VolumeMeter(seconds=seconds, megabytes=megabytes) as meter:
        for _ in range(2):
            start = perf_counter()
            pair = pair_of(bodies, settings, meter)
            if pair.curved:
                raise SatcheckError("curved-shape", "a curved shape has no triangles")
            draft = Draft(pair, exact="penetrating")
            measure_volume(draft)
            took.append(_times([1e6 * (perf_counter() - start)]))
            if draft.volume is None or draft.volume_error is None:
                raise SatcheckError("no-volume", draft.reason or "no volume")
            volume, error = draft.volume, draft.volume_error
        known = volume == 0 or volume > error
        return Row(
            rung="boolean",
            state="answered",
            overlap=volume > 0 if known else None,
            volume=volume,
            volume_error=error,
            reason=None if known else "the volume lies within its own error",
            cold=took[0],
            cached=took[1],
        )


def _truth(exact: Runs) -> Truth:
    if not exact.rows:
        return Truth(None, None, f"the exact rung was not run: {exact.failure or SPENT}")
    row = exact.rows[0]
    if not row.proven:
        return Truth(None, None, row.reason or "the exact rung has not proven it")
    low, high = row.bounds or (None, None)
    if low is None or high is None or math.isinf(high - low):
        return Truth(row.relation, None, None)
    return Truth(row.relation, (low, high), None)


def _row(rung: Rung, runs: Runs, truth: Truth, pad: float) -> Row:
    if runs.failure is not None or not runs.rows:
        state: Literal["failed", "not run"] = "not run" if runs.failure is None else "failed"
        reason = runs.failure or SPENT
        return Row(rung=rung.name, threshold=rung.threshold, state=state, reason=reason)
    row = runs.rows[0]
    return replace(
        row,
        right=is_right(row, truth),
        error=error_of(row.signed_distance, truth, pad),
        cold=_of_all(one.cold for one in runs.rows),
        cached=_of_all(one.cached for one in runs.rows),
        cpu=_of_all(one.cpu for one in runs.rows),
    )


def _times(microseconds: Sequence[float]) -> Times:
    low, high = min(microseconds), max(microseconds)
    return Times(median(microseconds), low, high, len(microseconds))


def _of_all(runs: Iterable[Times | None]) -> Times | None:
    known = [one.median for one in runs if one is not None]
    return _times(known) if known else None


def is_right(row: Row, truth: Truth) -> bool | None:
    """Return whether an answer agrees. That bodies overlap is what a rung can know: `contains`,
    `inside` and `coincident` are overlaps like any."""
    if truth.relation is None or row.overlap is None:
        return None
    if row.overlap != (truth.relation in OVERLAPS):
        return False
    return row.overlap or row.relation in (None, truth.relation)


def error_of(value: float | None, truth: Truth, pad: float) -> float | None:
    """Return the value minus the nearest possible signed distance; 0.0 within rounding (pad)."""
    if value is None or truth.bounds is None:
        return None
    low, high = truth.bounds
    error = value - min(max(value, low), high)
    return 0.0 if abs(error) <= pad else error
