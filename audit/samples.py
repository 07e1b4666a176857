"""The check of robots in many poses: a verdict for each pose, and counts for each pair."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, get_args

from msgspec import Struct, to_builtins
from msgspec.structs import astuple, replace

from satcheck.audit.bodies.placed_bodies import BodyCache
from satcheck.audit.check import DEFAULT_SETTINGS, check
from satcheck.audit.request.rule_book import RuleBook
from satcheck.audit.request.settings import Settings
from satcheck.report.config import StatedConfig
from satcheck.report.report import (
    OVERLAPS,
    BodyReport,
    Exempt,
    Finding,
    Issue,
    PairCounts,
    Report,
    RuleReport,
    Tool,
    Verdict,
    without_timings,
)
from satcheck.report.samples import (
    SampledBody,
    SampledPair,
    SampledPairCounts,
    SampledPose,
    SamplesReport,
    SamplesSummary,
)
from satcheck.report.settings import StatedSettings

if TYPE_CHECKING:
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose, Posture

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)


class Sample(Struct, frozen=True):
    """One pose. number: from 1. findings: the pairs that are not plainly separated there, at rest
    and on the way."""

    number: int
    posture: Posture
    verdict: Verdict
    findings: tuple[Finding, ...]
    issues: tuple[Issue, ...]


class PairTally(Struct):
    """One pair over all samples. Each sample counts once, at rest or in motion, as the first of
    overlaps, touches, near, undecided that applies.

    undecided: the relation, or whether the bodies hit in motion. first_overlap: number of the first
    sample with an overlap. In all other samples the pair is separated.
    """

    a: str
    b: str
    overlaps: int = 0
    touches: int = 0
    near: int = 0
    undecided: int = 0
    first_overlap: int | None = None

    @property
    def contacts(self) -> int:
        """The number of samples in which the two bodies overlap or touch."""
        return self.overlaps + self.touches

    @property
    def settled(self) -> bool:
        """Whether the pair is proven separated in all samples."""
        return not (self.contacts or self.near or self.undecided)

    def count(self, finding: Finding, number: int) -> None:
        if finding.relation in OVERLAPS:
            self.overlaps += 1
            if self.first_overlap is None:
                self.first_overlap = number
        elif finding.relation == "touching":
            self.touches += 1
        elif finding.relation == "near":
            self.near += 1
        elif finding.undecided is not None:
            self.undecided += 1


class Samples(Struct, frozen=True):
    """The result of `check_poses`.

    pairs: every checked pair, in the order of the bodies, including pairs that never met. counts:
    of the last sample; the numbers of allowed and exempt pairs are the same in all samples. bodies,
    exempt and rules: as in a report; the transforms are those of the last sample. issues: those
    that are not about a single pose. seed: of the random poses; None: not random. config: as in a
    report.
    """

    tool: Tool
    units: str | None
    settings: StatedSettings
    bodies: tuple[BodyReport, ...]
    exempt: Exempt
    rules: tuple[RuleReport, ...]
    samples: tuple[Sample, ...]
    pairs: tuple[PairTally, ...]
    counts: PairCounts
    issues: tuple[Issue, ...]
    seed: int | None = None
    config: StatedConfig | None = None

    @property
    def verdict(self) -> Verdict:
        """The worst of the samples."""
        verdicts = {sample.verdict for sample in self.samples}
        return next(verdict for verdict in ("fail", "incomplete", "pass") if verdict in verdicts)

    def report(self) -> SamplesReport:
        verdicts = Counter(sample.verdict for sample in self.samples)
        settled = sum(pair.settled for pair in self.pairs)
        counts = self.counts
        return SamplesReport(
            tool=self.tool,
            units=self.units,
            settings=self.settings,
            seed=self.seed,
            summary=SamplesSummary(
                self.verdict,
                len(self.samples),
                {name: verdicts[name] for name in VERDICTS},
                SampledPairCounts(counts.total, counts.allowed, counts.exempt, settled),
            ),
            bodies=tuple(SampledBody(b.id, b.file, b.sha256, b.shape) for b in self.bodies),
            exempt=self.exempt,
            rules=self.rules,
            samples=tuple(
                SampledPose(s.number, s.posture.pose(), s.verdict, s.findings, s.issues)
                for s in self.samples
            ),
            pairs=tuple(SampledPair(*astuple(pair)) for pair in self.pairs if not pair.settled),
            issues=self.issues,
            config=self.config,
        )

    def to_dict(self, timings: bool = True) -> dict[str, Any]:
        """JSON values; no `microseconds` without timings."""
        values: dict[str, Any] = to_builtins(self.report())
        return values if timings else without_timings(values)


def check_poses(
    scene: Scene,
    poses: Sequence[Pose],
    settings: Settings = DEFAULT_SETTINGS,
    progress: Callable[[int, int], None] | None = None,
) -> Samples:
    """Check the scene in each of these poses of its robots. At least one pose is needed.

    scene: loaded, with `robots`. poses: joint -> values, for instance from `scene.robot`'s
    `joint_samples([robot.robot for robot in scene.robots], count, seed)`, or read by `read_poses`.
    progress(done, total) counts poses. Facts that depend on a mesh alone (convexity, parts) are
    computed once for all poses.

    Settings(depth=False) is much faster and decides only whether bodies meet. A pair in
    `Samples.pairs` that is always in contact has `contacts == len(samples)`; a pair that is always
    separated is `settled`.

    Raises SatcheckError for a pose with unknown joints, and what `check` raises.
    """
    from satcheck.scene.robot import posed

    if not poses:
        raise ValueError("no pose to check")
    placed = [posed(scene, pose) for pose in poses]  # all poses are judged before work is done
    cache = BodyCache()
    tallies: dict[tuple[str, str], PairTally] = {}
    samples: list[Sample] = []
    common: dict[Issue, None] = {}
    report: Report | None = None
    for number, posed_scene in enumerate(placed, 1):
        report = check(posed_scene, replace(settings, list_pruned=False), cache=cache)
        sample, others = _sample(number, report, posed_scene.posture)
        samples.append(sample)
        common |= dict.fromkeys(others)
        for finding in sample.findings:
            pair = finding.a, finding.b
            tallies.setdefault(pair, PairTally(*pair)).count(finding, number)
        if progress is not None:
            progress(number, len(placed))
    assert report is not None
    assert cache.book is not None
    return Samples(
        tool=report.tool,
        units=report.units,
        settings=report.settings,
        bodies=report.bodies,
        exempt=report.exempt,
        rules=report.rules,
        samples=tuple(samples),
        pairs=_all_pairs(report, cache.book, tallies),
        counts=report.summary.pairs,
        issues=tuple(common),
    )


def _sample(number: int, report: Report, posture: Posture | None) -> tuple[Sample, list[Issue]]:
    """The sample, and the issues that are not about its pose."""
    assert posture is not None
    own = {(issue.code, issue.message) for issue in posture.issues}
    of_pose = [issue for issue in report.issues if (issue.code, issue.message) in own]
    others = [issue for issue in report.issues if (issue.code, issue.message) not in own]
    findings = tuple(finding for finding in report.findings if not _is_plain(finding))
    return Sample(number, posture, report.summary.verdict, findings, tuple(of_pose)), others


def _is_plain(finding: Finding) -> bool:
    """Separated at rest and in motion, without a remark."""
    return finding.relation == "separated" and finding.severity == "none"


def _all_pairs(
    report: Report, book: RuleBook, tallies: dict[tuple[str, str], PairTally]
) -> tuple[PairTally, ...]:
    """Every checked pair, in the order of the bodies."""
    ids = [body.id for body in report.bodies]
    checked = ((ids[i], ids[j]) for i, j in book.checked_pairs())
    return tuple(tallies.get(pair) or PairTally(*pair) for pair in checked)
