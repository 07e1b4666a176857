"""The result of a check of robots in many poses: a verdict for each pose, and counts for pairs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, get_args

from msgspec import Struct, to_builtins

from satcheck.audit.request.settings import FailOn
from satcheck.report.report import (
    OVERLAPS,
    BodyReport,
    Exempt,
    Finding,
    Issue,
    PairCounts,
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
    SamplesTruncated,
)
from satcheck.report.settings import StatedConfig, StatedSettings
from satcheck.report.verdict import fails

# A report lists all samples up to this number. Of more samples it lists the first ones with a
# finding, so many.
LISTED_SAMPLES = 1000
LISTED_NOTED = 100
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)


# A pose as JSON: joint -> a number, or a list of numbers.
StatedPose = dict[str, float | list[float]]


class PairTally(Struct):
    """One pair over all samples. Each sample counts once, at rest or in motion, as the first of
    overlaps, touches, near, undecided that applies.

    undecided: the relation, or whether the bodies hit in motion. first_overlap: number of the first
    sample with an overlap; first_pose: its pose. In all other samples the pair is separated. fails:
    the number of samples that fail by it. reason: why it was undecided in the sample
    `first_undecided`, at rest, in motion, or beside a limit.
    """

    a: str
    b: str
    overlaps: int = 0
    touches: int = 0
    near: int = 0
    undecided: int = 0
    first_overlap: int | None = None
    first_pose: StatedPose | None = None
    fails: int = 0
    first_undecided: int | None = None
    reason: str | None = None

    @property
    def contacts(self) -> int:
        """The number of samples in which the two bodies overlap or touch."""
        return self.overlaps + self.touches

    @property
    def settled(self) -> bool:
        """Return whether the pair is proven separated in all samples."""
        return not (self.contacts or self.near or self.undecided)

    def count(self, finding: Finding, number: int, fail_on: FailOn) -> None:
        failed = fails(finding, fail_on)
        if finding.undecided is not None and self.first_undecided is None:
            swept = finding.motion and finding.motion.reason
            self.first_undecided = number
            self.reason = finding.reason or swept or "undecided"
        if finding.relation in OVERLAPS:
            self.count_overlaps(1, number, fails=failed)
            return
        self.fails += failed
        if finding.relation == "touching":
            self.touches += 1
        elif finding.relation == "near":
            self.near += 1
        elif finding.undecided is not None:
            self.undecided += 1

    def count_overlaps(self, count: int, first: int, *, fails: bool) -> None:
        """Adds overlaps in `count` samples; `first` is the number of the first of them."""
        self.overlaps += count
        self.fails += count if fails else 0
        self.first_overlap = min(first, self.first_overlap or first)

    def stated(self) -> SampledPair:
        counts = (self.overlaps, self.touches, self.near, self.undecided)
        return SampledPair(self.a, self.b, *counts, self.first_overlap)


class Samples(Struct, frozen=True):
    """The result of `check_poses`.

    number: of the checked samples; by_verdict: how many have each verdict. samples: all of them; of
    more than LISTED_SAMPLES, the first LISTED_NOTED ones with a finding. pairs: every checked
    pair, in the order of the bodies, including pairs that never met. counts: of one sample; the
    numbers of allowed and exempt pairs are the same in all samples. bodies, exempt and rules: as in
    a report; the transforms are those of one sample. issues: those that are not about a single
    pose. seed: of the random poses; None: not random. config: as in a report.
    """

    tool: Tool
    units: str | None
    settings: StatedSettings
    bodies: tuple[BodyReport, ...]
    exempt: Exempt
    rules: tuple[RuleReport, ...]
    number: int
    by_verdict: Mapping[Verdict, int]
    samples: tuple[SampledPose, ...]
    pairs: tuple[PairTally, ...]
    counts: PairCounts
    issues: tuple[Issue, ...]
    seed: int | None = None
    config: StatedConfig | None = None

    @property
    def verdict(self) -> Verdict:
        """The worst of the samples."""
        worst: tuple[Verdict, ...] = ("fail", "incomplete", "pass")
        return next(verdict for verdict in worst if self.by_verdict[verdict])

    def report(self) -> SamplesReport:
        settled = sum(pair.settled for pair in self.pairs)
        counts = self.counts
        return SamplesReport(
            tool=self.tool,
            units=self.units,
            settings=self.settings,
            seed=self.seed,
            summary=SamplesSummary(
                self.verdict,
                self.number,
                dict(self.by_verdict),
                SampledPairCounts(counts.total, counts.allowed, counts.exempt, settled),
            ),
            bodies=tuple(SampledBody(b.id, b.file, b.sha256, b.shape) for b in self.bodies),
            exempt=self.exempt,
            rules=self.rules,
            samples=self.samples,
            pairs=tuple(pair.stated() for pair in self.pairs if not pair.settled),
            issues=self.issues,
            truncated=self._truncated(),
            config=self.config,
        )

    def _truncated(self) -> SamplesTruncated | None:
        left_out = self.number - len(self.samples)
        if not left_out:
            return None
        beyond = f", or come after the first {LISTED_NOTED:,} with one"
        reason = f"they have no finding{beyond if len(self.samples) == LISTED_NOTED else ''}"
        return SamplesTruncated(left_out, reason)

    def to_dict(self, timings: bool = True) -> dict[str, Any]:
        """JSON values; no `microseconds` without timings."""
        values: dict[str, Any] = to_builtins(self.report())
        return values if timings else without_timings(values)
