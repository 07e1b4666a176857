"""The report of a check in many poses of robots: a verdict for each pose, and counts for pairs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct, to_builtins
from msgspec.structs import replace

from satcheck.report.bodies import StatedShape
from satcheck.report.report import (
    OVERLAPS,
    Exempt,
    Finding,
    Issue,
    JointValues,
    RuleReport,
    without_timings,
)
from satcheck.report.settings import FailOn, StatedConfig, StatedReading, StatedSettings
from satcheck.report.values import Count, Sha256, Tool, Value, Verdict
from satcheck.report.verdict import fails

# Numbers of samples start at 1.
Number = Annotated[int, Meta(ge=1)]
# Row-major 4x4.
StatedTransform = Annotated[tuple[float, ...], Meta(min_length=16, max_length=16)]
StatedPose = Mapping[str, float | JointValues]


class SampledBody(Value, frozen=True):
    """A body as in a report of one pose, placed as in the first of the poses."""

    id: str
    name: str
    file: str
    sha256: Sha256 | None
    path: str | None
    shape: StatedShape | None
    transform: StatedTransform | None


class SampledPose(Value, frozen=True):
    """findings: the pairs that are not plainly separated. issues: about this pose. moved: body ->
    its transform, if it does not stand as in the first pose; left empty without a finding."""

    number: Number
    pose: StatedPose
    verdict: Verdict
    findings: tuple[Finding, ...]
    issues: tuple[Issue, ...]
    moved: Mapping[str, StatedTransform] = {}


class SampledPair(Struct, forbid_unknown_fields=True):
    """One pair over all samples, counted one after another. Each sample counts once, at rest or in
    motion, as the first of overlaps, touches, near, undecided that applies. In all other samples
    the pair is separated.

    undecided: how the bodies relate, or whether they hit in motion. first_overlap: the number of
    the first sample with an overlap; first_pose: its pose. fails: the number of samples that fail
    by the pair. reason: why it was undecided in the sample `first_undecided`, at rest, in motion,
    or beside a limit.
    """

    a: str
    b: str
    overlaps: Count = 0
    touches: Count = 0
    near: Count = 0
    undecided: Count = 0
    first_overlap: Number | None = None
    first_pose: StatedPose | None = None
    fails: Count = 0
    first_undecided: Number | None = None
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


class SampledPairCounts(Value, frozen=True):
    """total: as in a report of one pose, including allowed pairs. allowed: pairs that are not
    checked, because of rules, an SRDF, or because both bodies belong to one link. exempt: pairs of
    static bodies, and pairs within an ignored group; they are not checked and not in total.
    separated: in all samples."""

    total: Count
    allowed: Count
    exempt: Count
    separated: Count


class SamplesSummary(Value, frozen=True):
    """verdict: the worst of the samples. by_verdict: number of samples with each verdict."""

    verdict: Verdict
    samples: Number
    by_verdict: Mapping[Verdict, Count]
    pairs: SampledPairCounts


class SamplesTruncated(Value, frozen=True):
    """The number of samples that `samples` leaves out, and the reason."""

    samples: Number
    reason: str


class SamplesReport(Value, frozen=True, kw_only=True):
    """The same bodies in many poses of their robots. World frame, right-handed; lengths in the
    units of the files. A figure that was not computed is None, never 0.

    seed: of the random poses; None: they are not random. samples: all of them; of very many, the
    first ones with a finding, and `truncated` counts the others. Summary and pairs count all of
    them. pairs: every checked pair, in the order of the bodies; JSON leaves out those that are
    separated in all samples. issues: those that are not about the pose of one sample. reading,
    config: as in a report.
    """

    schema: Literal["satcheck.samples/1"] = "satcheck.samples/1"
    tool: Tool
    units: str | None
    settings: StatedSettings
    seed: Count | None
    summary: SamplesSummary
    reading: StatedReading | None = None
    bodies: tuple[SampledBody, ...]
    exempt: Exempt
    rules: tuple[RuleReport, ...]
    samples: tuple[SampledPose, ...]
    pairs: tuple[SampledPair, ...]
    issues: tuple[Issue, ...]
    truncated: SamplesTruncated | None = None
    config: StatedConfig | None = None

    def to_dict(self, timings: bool = True) -> dict[str, Any]:
        """JSON values; no `microseconds` without timings."""
        met = tuple(pair for pair in self.pairs if not pair.settled)
        values: dict[str, Any] = to_builtins(replace(self, pairs=met))
        return values if timings else without_timings(values)
