"""What the samples of a check of robots in many poses add up to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import get_args

from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.body import SharedMesh
from satcheck.audit.check import check, described
from satcheck.audit.messages import finding_message
from satcheck.audit.settings import Settings
from satcheck.core.transform import Transform
from satcheck.report.report import Finding, Issue, Report, Verdict
from satcheck.report.samples import (
    SampledBody,
    SampledPair,
    SampledPairCounts,
    SampledPose,
    SamplesReport,
    SamplesSummary,
    SamplesTruncated,
    StatedPose,
)
from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.robot.postures import PoseBatch

# A report lists all samples up to this number. Of more samples it lists the first ones with a
# finding, so many.
LISTED_SAMPLES = 1000
LISTED_NOTED = 100
# The worst first.
VERDICTS: tuple[Verdict, ...] = ("fail", "incomplete", "pass")


class SampleResults:
    """What the samples so far have added up to. first: the report of the first one, maybe without
    its pairs; all have its units, rules and settings."""

    def __init__(self, scene: Scene, settings: Settings, *, lists_all: bool) -> None:
        self.settings, self.lists_all = settings, lists_all
        self.cache = BodyCache()
        if scene.robots and settings.planar is None:  # else the meshes are those of one pose
            self.cache.meshes = scene.robots[0].kept.meshes(SharedMesh.terms(settings))
        self.first: Report | None = None
        self.by_verdict: Counter[Verdict] = Counter()
        self.listed: list[SampledPose] = []
        self.issues: dict[Issue, None] = {}
        self._tallies: dict[tuple[str, str], SampledPair] = {}
        self._placed: dict[str, Transform | None] = {}

    @property
    def room(self) -> int:
        """How many more samples with a finding are listed."""
        return LISTED_NOTED - len(self.listed)

    def tally(self, a: str, b: str) -> SampledPair:
        return self._tallies.setdefault((a, b), SampledPair(a, b))

    def check(self, batch: PoseBatch, row: int, posed: Scene) -> SampledPose:
        """Checks a pose as a scene of its own, which is `posed`."""
        report = check(posed, self.settings, cache=self.cache)
        of_pose = self._take(report, batch, row)
        told = tuple(self.told(finding) for finding in report.findings if not is_plain(finding))
        return self.sample(batch, row, report.summary.verdict, told, of_pose)

    def describe(self, batch: PoseBatch, posed: Scene) -> None:
        """Takes what is the same in all poses from the first one, which is `posed`."""
        self._take(described(posed, self.settings, self.cache), batch, 0)

    def _take(self, report: Report, batch: PoseBatch, row: int) -> list[Issue]:
        """Keeps what the report of a pose says of all poses, and returns its other issues."""
        if self.first is None:
            self.first = report
            self._placed = {body.id: body.transform for body in report.bodies}
        own = {(issue.code, issue.message) for issue in batch.issues(row)}
        of_pose = [issue for issue in report.issues if (issue.code, issue.message) in own]
        others = [issue for issue in report.issues if (issue.code, issue.message) not in own]
        self.issues |= dict.fromkeys(others)
        return of_pose

    def told(self, finding: Finding) -> Finding:
        """Return the finding with its message."""
        assert self.first is not None
        return replace(finding, message=finding_message(finding, self.first))

    def sample(
        self,
        batch: PoseBatch,
        row: int,
        verdict: Verdict,
        findings: tuple[Finding, ...],
        issues: Iterable[Issue],
    ) -> SampledPose:
        """Return a pose with its findings, of which none is plain, and with the placement of each
        body that does not stand as in the first sample."""
        moved = {}
        if findings:
            moved = {
                body.id: transform or body.transform or IDENTITY
                for body, transform in batch.transforms(row)
                if (transform or body.transform) != self._placed[body.id]
            }
        stated = batch.stated(row)
        return SampledPose(batch.first + row, stated, verdict, findings, tuple(issues), moved)

    def add(self, batch: PoseBatch, row: int) -> None:
        """Adds what the check of a pose says."""
        sample = self.check(batch, row, batch.posed(row))
        self.by_verdict[sample.verdict] += 1
        for finding in sample.findings:
            self.count(finding, sample.number)
        if self.lists_all or (sample.findings and self.room > 0):
            self.listed.append(sample)

    def count(self, finding: Finding, number: int) -> None:
        self.tally(finding.a, finding.b).count(finding, number, self.settings.fail_on)

    def keep_first_poses(self, batch: PoseBatch) -> None:
        """States the poses of this batch in which a pair overlaps first."""
        poses: dict[int, StatedPose] = {}
        for tally in self._tallies.values():
            number = tally.first_overlap
            if number is not None and tally.first_pose is None:
                if number not in poses:
                    poses[number] = batch.stated(number - batch.first)
                tally.first_pose = poses[number]

    def report(self, number: int) -> SamplesReport:
        """Nothing passes while an issue of all samples blocks it. number: of the checked
        samples."""
        first, book = self.first, self.cache.book
        assert first is not None
        assert book is not None
        if any(issue.state == "blocking" for issue in self.issues):
            self.by_verdict["incomplete"] += self.by_verdict.pop("pass", 0)
            self.listed = [
                replace(sample, verdict="incomplete") if sample.verdict == "pass" else sample
                for sample in self.listed
            ]
        ids = [body.id for body in first.bodies]
        pairs = tuple(self.tally(ids[i], ids[j]) for i, j in book.checked_pairs())
        counts, settled = first.summary.pairs, sum(pair.settled for pair in pairs)
        return SamplesReport(
            tool=first.tool,
            units=first.units,
            settings=first.settings,
            seed=None,
            summary=SamplesSummary(
                next(verdict for verdict in VERDICTS if self.by_verdict[verdict]),
                number,
                {verdict: self.by_verdict[verdict] for verdict in get_args(Verdict)},
                SampledPairCounts(counts.total, counts.allowed, counts.exempt, settled),
            ),
            reading=first.reading,
            bodies=tuple(
                SampledBody(b.id, b.name, b.file, b.sha256, b.path, b.shape, b.transform)
                for b in first.bodies
            ),
            exempt=first.exempt,
            rules=first.rules,
            samples=tuple(self.listed),
            pairs=pairs,
            issues=tuple(self.issues),
            truncated=self._truncated(number),
        )

    def _truncated(self, number: int) -> SamplesTruncated | None:
        left_out = number - len(self.listed)
        if not left_out:
            return None
        beyond = f", or come after the first {LISTED_NOTED:,} with one"
        reason = f"they have no finding{beyond if len(self.listed) == LISTED_NOTED else ''}"
        return SamplesTruncated(left_out, reason)


def is_plain(finding: Finding) -> bool:
    """Separated at rest and in motion, without a remark."""
    return finding.relation == "separated" and finding.severity == "none"
