"""One run of one rung on one pair: its answer in a row of the report, and its time."""

from __future__ import annotations

import os
import tempfile
import time
from time import perf_counter
from typing import NamedTuple

from msgspec import Struct
from msgspec.structs import replace

# What the first question needs is imported here: it is no cost of the rung that asks it.
import satcheck.decompose.computation  # noqa: F401
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.figures.volume import common_volume
from satcheck.audit.finding import examine
from satcheck.audit.request.settings import Settings
from satcheck.audit.request.trace import Trace
from satcheck.audit.studied_pair import Bodies, pair_of
from satcheck.core.errors import SatcheckError
from satcheck.core.overlap_volume import VolumeMeter
from satcheck.decompose.result import Decomposition
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.tradeoff import Bounds, Row, RungName

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


class Run(Struct, frozen=True):
    """Seconds from the meshes in memory to the answer, with hulls and trees made anew. cpu: of
    these the processor was at work so long, on all threads and in ended child processes."""

    row: Row
    cold: float
    cpu: float | None = None
    cached: float | None = None


def run(rung: Rung, bodies: Bodies, seconds: float, settings: Settings) -> Run | str:
    """Ask a rung; or why it has no answer. seconds: that convex parts or a volume may take."""
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
        cold, pair = _ladder(rung, bodies, settings)
        made = _decompositions(pair)
        if failure := next((one for one in made if isinstance(one, SatcheckError)), None):
            return str(failure)
        if not made:  # the hulls of the bodies are all there is
            ended = "hull" if cold.row.settled_by == "parts" else cold.row.settled_by
            return replace(cold, row=replace(cold.row, settled_by=ended))
        again, pair = _ladder(rung, bodies, settings)
        reread = all(
            isinstance(one, Decomposition) and one.from_cache for one in _decompositions(pair)
        )
        return replace(cold, cached=again.cold if reread else None)


def _decompositions(pair: Pair) -> list[Decomposition | SatcheckError]:
    """Those that a climb has asked for."""
    known = [body.shared.decomposition.known for body in (pair.a, pair.b)]
    return [one for one in known if one is not None]


def _ladder(rung: Rung, bodies: Bodies, settings: Settings) -> tuple[Run, Pair]:
    cpu, start = _cpu_seconds(), perf_counter()
    pair = pair_of(bodies, settings)
    examined = examine(pair, Trace())
    cold, cpu = perf_counter() - start, _cpu_seconds() - cpu
    finding = examined.finding
    # A clearance is asked only to have the gap measured.
    relation = "separated" if finding.relation == "near" else finding.relation
    known = is_of_bodies(finding) and relation != "indeterminate"
    figure = signed_distance(finding, examined.draft.verdict)
    row = Row(
        rung=rung.name,
        threshold=rung.threshold,
        state="answered",
        reason=None if known else finding.reason,
        overlap=relation in OVERLAPS if known else None,
        relation=relation,
        proven=known and finding.exact_relation is not None,
        signed_distance=None if figure is None else figure[0],
        bounds=None if figure is None else figure[1],
        settled_by=last_rung(finding),
    )
    return Run(row, cold, cpu), pair


def last_rung(finding: Finding) -> RungName | None:
    """The rung at which the climb ended."""
    ran = [stage.stage for stage in finding.plan if stage.result != "skipped"]
    return next((STAGES[stage] for stage in reversed(ran) if stage in STAGES), None)


def is_of_bodies(finding: Finding) -> bool:
    """Return whether it says how the bodies relate, not their surfaces alone, or nothing."""
    return finding.undecided not in ("relation", "inside")


def signed_distance(finding: Finding, verdict: Verdict) -> tuple[float, Bounds] | None:
    """With its bounds. verdict: of the same ladder, for what it proves and nobody asked to report.
    None: no figure of the bodies; how far their surfaces are apart says nothing of one that may lie
    inside."""
    if not is_of_bodies(finding):
        return None
    if finding.depth_bounds is not None:
        low, high = finding.depth_bounds
        # An overlap that is not proven may be a gap, of any width.
        return -high + 0.0, (-high + 0.0, -low + 0.0 if verdict.proven else None)
    signed = verdict.signed_distance
    if signed is not None and signed.distance is not None:
        return signed.distance, (signed.lower, signed.upper)
    if finding.distance is not None:
        return finding.distance, (finding.distance, finding.distance)
    if verdict.relation == "separated":
        return verdict.gap_lower, (verdict.gap_lower if verdict.proven else None, None)
    if verdict.relation == "touching":
        return 0.0, (0.0, 0.0)
    band = finding.tolerance
    return None if finding.relation != "touching" or band is None else (0.0, (-band, None))


def _cpu_seconds() -> float:
    used = os.times()
    return time.process_time() + used.children_user + used.children_system


def _boolean(bodies: Bodies, settings: Settings) -> Run | str:
    """Measure the common volume by manifold3d, in a child process of its own, twice."""
    seconds, megabytes = settings.volume_seconds, settings.volume_megabytes
    with VolumeMeter(seconds=seconds, megabytes=megabytes) as meter:
        cold = _volume(bodies, settings, meter)
        cached = cold if isinstance(cold, str) else _volume(bodies, settings, meter)
    if isinstance(cold, str) or isinstance(cached, str):
        return str(cached)
    _, volume, error = cold
    known = volume == 0 or volume > error
    row = Row(
        rung="boolean",
        state="answered",
        overlap=volume > 0 if known else None,
        volume=volume,
        volume_error=error,
        reason=None if known else "the volume lies within its own error",
    )
    return Run(row, cold[0], cached=cached[0])


def _volume(
    bodies: Bodies, settings: Settings, meter: VolumeMeter
) -> tuple[float, float, float] | str:
    """Seconds, the volume and its error; or why there is none."""
    start = perf_counter()
    pair = pair_of(bodies, settings, meter)
    if pair.curved:
        return "a curved shape has no triangles"
    common = common_volume(pair, Verdict("penetrating", False), Trace())
    if common.volume is None or common.error is None:
        return common.refusal or "no volume"
    return perf_counter() - start, common.volume, common.error
