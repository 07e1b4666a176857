"""One run of one rung on one pair, with its time and memory."""

from __future__ import annotations

from time import perf_counter

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.figures.volume import common_volume
from satcheck.audit.finding import examine
from satcheck.audit.request.settings import Settings
from satcheck.audit.request.trace import Trace
from satcheck.core.errors import SatcheckError
from satcheck.core.overlap_volume import VolumeMeter
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Finding
from satcheck.studies.pair import Bodies, pair_of
from satcheck.studies.tradeoff.reading import climb_end
from satcheck.studies.tradeoff.resources import ChildMemory, CpuClock, OwnMemory
from satcheck.studies.tradeoff.thickness import ThicknessRun, thickness_by
from satcheck.studies.tradeoff.volumes import body_volume, stand_in_volume

Volumes = tuple[float | None, float | None]


class LadderRun(Struct, frozen=True):
    """The answer of a ladder.

    verdict: of the same ladder, for what it proves and nobody asked to report. pad: what rounding
    can make of a length here. seconds: from the meshes in memory to the finding, hulls and
    hierarchies made anew; reading the files is not in it. cpu: of these the processor was at work
    so long, on all threads and in child processes together; None: not known. ended: the rung at
    which the climb ended. volumes: of the shapes that it put in the place of A and of B. hulls:
    how many convex bodies stood for A and for B, where hulls answered. thickness: of these shapes;
    its time is in `seconds` only where the finding has it. split: convex parts were
    asked for; from_cache: and found there. megabytes: of the child that made them, or by which this
    process grew, whichever is more. failure: why there are none.
    """

    finding: Finding
    verdict: Verdict
    pad: float
    seconds: float
    cpu: float | None
    ended: str
    volumes: Volumes
    hulls: tuple[int, int] | None
    thickness: ThicknessRun | None = None
    split: bool = False
    from_cache: bool = False
    megabytes: float | None = None
    failure: str | None = None


class VolumeRun(Struct, frozen=True):
    """The volume in common, and about how far it is off.

    cold: seconds with the start of the child process; cached: when it runs already.
    """

    volume: float
    error: float
    cold: float
    cached: float
    megabytes: float | None


def ask(bodies: Bodies, settings: Settings) -> LadderRun:
    """As far up the ladder as the settings let it, nothing known from before."""
    return _climb(bodies, settings, children=False)[0]


def ask_parts(bodies: Bodies, settings: Settings) -> LadderRun:
    """The same of a ladder that ends with convex parts."""
    with ChildMemory() as memory:
        own = OwnMemory()
        asked, pair = _climb(bodies, settings, children=True)
        taken = [size for size in (memory.megabytes, own.grown) if size is not None]
    results = [body.shared.decomposition.known for body in (pair.a, pair.b)]
    made = [result for result in results if result is not None]
    if not made:  # the hulls of the bodies are all there is
        return replace(asked, ended="hull") if asked.ended == "parts" else asked
    failures = [str(result) for result in made if isinstance(result, SatcheckError)]
    if failures:
        return replace(asked, split=True, failure=failures[0])
    parts = [result for result in made if not isinstance(result, SatcheckError)]
    a, b = (
        1 if result is None or isinstance(result, SatcheckError) else len(result.parts)
        for result in results
    )
    return replace(
        asked,
        hulls=(a, b),
        split=True,
        from_cache=all(result.from_cache for result in parts),
        megabytes=max(taken, default=None),
    )


def _climb(bodies: Bodies, settings: Settings, *, children: bool) -> tuple[LadderRun, Pair]:
    """children: some are at work."""
    clock, start = CpuClock(), perf_counter()
    pair = pair_of(bodies, settings)
    examined = examine(pair, Trace())
    finding = examined.finding
    seconds, cpu = perf_counter() - start, clock.seconds(children=children)
    stages, ended = {stage.stage for stage in finding.plan}, climb_end(finding).rung
    asked = LadderRun(
        finding=finding,
        verdict=examined.verdict,
        pad=rounding_pad(pair.largest_coordinate),
        seconds=seconds,
        cpu=cpu,
        ended=ended,
        volumes=(stand_in_volume(ended, pair.a), stand_in_volume(ended, pair.b)),
        # Where the hulls of the whole meshes answered.
        hulls=(1, 1) if "hull" in stages and "triangles" not in stages else None,
        thickness=thickness_by(ended, pair, finding),
    )
    return asked, pair


def body_volumes(bodies: Bodies) -> Volumes:
    """Volumes of the bodies themselves."""
    pair = pair_of(bodies, Settings())
    return body_volume(pair.a), body_volume(pair.b)


def ask_volume(bodies: Bodies, settings: Settings) -> VolumeRun | str:
    """Of the Boolean of manifold3d, in a child process of its own; or why there is none."""
    times: list[float] = []
    volume = error = 0.0
    seconds, megabytes = settings.volume_seconds, settings.volume_megabytes
    with ChildMemory() as memory, VolumeMeter(seconds=seconds, megabytes=megabytes) as meter:
        for _ in ("cold", "cached"):
            start = perf_counter()
            measured = _volume(pair_of(bodies, settings, meter))
            times.append(perf_counter() - start)
            if isinstance(measured, str):
                return measured
            volume, error = measured
        memory.look()
    return VolumeRun(volume, error, times[0], times[1], memory.megabytes)


def _volume(pair: Pair) -> tuple[float, float] | str:
    if pair.curved:
        return "a curved shape has no triangles"
    common = common_volume(pair, Verdict("penetrating", False), Trace())
    if common.volume is None or common.error is None:
        return common.refusal or "no volume"
    return common.volume, common.error
