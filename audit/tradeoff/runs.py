"""One run of one rung on one pair, with its time and memory."""

from __future__ import annotations

import os
import time
from time import perf_counter

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.figures.volume import common_volume
from satcheck.audit.finding import examine
from satcheck.audit.request.settings import Settings
from satcheck.audit.request.trace import Trace
from satcheck.audit.studied_pair import Bodies, pair_of
from satcheck.audit.tradeoff.result import ClimbEnd
from satcheck.audit.tradeoff.thickness import ThicknessRun, thickness_by
from satcheck.core.errors import SatcheckError
from satcheck.core.overlap_volume import VolumeMeter
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Finding

# Stages of a trace that are rungs, and how they are called here.
STAGES = {"aabb": "aabb", "obb": "obb", "sat": "hull", "hull": "hull", "curved": "hull"}
STAGES |= {"curved-exact": "hull", "parts": "parts", "triangles": "exact"}
# What a stage records that had nothing to add to the one below.
SKIPPED = "skipped"


class LadderRun(Struct, frozen=True):
    """The answer of a ladder.

    verdict: of the same ladder, for what it proves and nobody asked to report. pad: what rounding
    can make of a length here. seconds: from the meshes in memory to the finding, hulls and
    hierarchies made anew; reading the files is not in it. cpu: of these the processor was at work
    so long, on all threads and in ended child processes together. ended: the rung at which the
    climb ended. thickness: of what stood for the bodies; its time is in `seconds` only where the
    finding has it. split: convex parts were asked for; from_cache: and found there. failure: why
    there are none.
    """

    finding: Finding
    verdict: Verdict
    pad: float
    seconds: float
    cpu: float
    ended: str
    thickness: ThicknessRun | None = None
    split: bool = False
    from_cache: bool = False
    failure: str | None = None


class VolumeRun(Struct, frozen=True):
    """The volume in common, and about how far it is off.

    cold: seconds with the start of the child process; cached: when it runs already.
    """

    volume: float
    error: float
    cold: float
    cached: float


def ask_parts(bodies: Bodies, settings: Settings) -> LadderRun:
    """Climb a ladder that ends with convex parts."""
    asked, pair = _climb(bodies, settings)
    results = [body.shared.decomposition.known for body in (pair.a, pair.b)]
    made = [result for result in results if result is not None]
    if not made:  # the hulls of the bodies are all there is
        return replace(asked, ended="hull") if asked.ended == "parts" else asked
    failures = [str(result) for result in made if isinstance(result, SatcheckError)]
    if failures:
        return replace(asked, split=True, failure=failures[0])
    parts = [result for result in made if not isinstance(result, SatcheckError)]
    return replace(asked, split=True, from_cache=all(result.from_cache for result in parts))


def ask(bodies: Bodies, settings: Settings) -> LadderRun:
    """Climb as far up the ladder as the settings let it, nothing known from before."""
    return _climb(bodies, settings)[0]


def _climb(bodies: Bodies, settings: Settings) -> tuple[LadderRun, Pair]:
    before, start = _cpu_seconds(), perf_counter()
    pair = pair_of(bodies, settings)
    examined = examine(pair, Trace())
    finding = examined.finding
    seconds, cpu = perf_counter() - start, _cpu_seconds() - before
    ended = climb_end(finding).rung
    asked = LadderRun(
        finding=finding,
        verdict=examined.verdict,
        pad=rounding_pad(pair.largest_coordinate),
        seconds=seconds,
        cpu=cpu,
        ended=ended,
        thickness=thickness_by(ended, pair, finding),
    )
    return asked, pair


def climb_end(finding: Finding) -> ClimbEnd:
    """The last stage that is a rung ended the climb; those before say why they could not."""
    climbed = [stage for stage in finding.plan if stage.stage in STAGES]
    said = [
        f"{stage.stage} {stage.result}" + (f" ({stage.detail})" if stage.detail else "")
        for stage in climbed
    ]
    ran = [STAGES[stage.stage] for stage in climbed if stage.result != SKIPPED]
    settled = finding.exact_relation is not None and is_of_bodies(finding)
    if not settled and finding.reason is not None:
        said.append(finding.reason)
    return ClimbEnd(ran[-1] if ran else "none", settled, "; ".join(said))


def is_of_bodies(finding: Finding) -> bool:
    """Return whether it says how the bodies relate, not their surfaces alone, or nothing."""
    return finding.undecided not in ("relation", "inside")


def _cpu_seconds() -> float:
    """Return the CPU time of this process, on all threads, and of its children that ended; Windows
    knows of none."""
    used = os.times()
    return time.process_time() + used.children_user + used.children_system


def ask_volume(bodies: Bodies, settings: Settings) -> VolumeRun | str:
    """Measure the volume by the Boolean of manifold3d, in a child process of its own; or why there
    is none."""
    times: list[float] = []
    volume = error = 0.0
    seconds, megabytes = settings.volume_seconds, settings.volume_megabytes
    with VolumeMeter(seconds=seconds, megabytes=megabytes) as meter:
        for _ in ("cold", "cached"):
            start = perf_counter()
            measured = _volume(pair_of(bodies, settings, meter))
            times.append(perf_counter() - start)
            if isinstance(measured, str):
                return measured
            volume, error = measured
    return VolumeRun(volume, error, times[0], times[1])


def _volume(pair: Pair) -> tuple[float, float] | str:
    if pair.curved:
        return "a curved shape has no triangles"
    common = common_volume(pair, Verdict("penetrating", False), Trace())
    if common.volume is None or common.error is None:
        return common.refusal or "no volume"
    return common.volume, common.error
