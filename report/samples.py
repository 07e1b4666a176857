"""The report of a check in many poses of robots: a verdict for each pose, and counts for pairs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.bodies import StatedShape
from satcheck.report.report import Exempt, Finding, Issue, JointValues, RuleReport
from satcheck.report.settings import StatedConfig, StatedSettings
from satcheck.report.values import Count, Sha256, Tool, Value, Verdict

# Numbers of samples start at 1.
Number = Annotated[int, Meta(ge=1)]


class SampledBody(Value, frozen=True):
    """A body as in a report of one pose, without the fields that depend on the pose."""

    id: str
    file: str
    sha256: Sha256 | None
    shape: StatedShape | None


class SampledPose(Value, frozen=True):
    """findings: the pairs that are not plainly separated. issues: about this pose."""

    number: Number
    pose: Mapping[str, float | JointValues]
    verdict: Verdict
    findings: tuple[Finding, ...]
    issues: tuple[Issue, ...]


class SampledPair(Value, frozen=True):
    """The number of samples with each relation of the pair, at rest or in motion. In all other
    samples the pair is separated.

    undecided: how the bodies relate, or whether they hit in motion. first_overlap: the number of
    the first sample with an overlap.
    """

    a: str
    b: str
    overlaps: Count
    touches: Count
    near: Count
    undecided: Count
    first_overlap: Number | None


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

    seed: of the random poses; None: they are not random. pairs: those that are not separated in
    all samples. issues: those that are not about the pose of one sample. config: as in a report.
    truncated: None: all samples are listed. Summary and pairs count all of them.
    """

    schema: Literal["satcheck.samples/1"] = "satcheck.samples/1"
    tool: Tool
    units: str | None
    settings: StatedSettings
    seed: Count | None
    summary: SamplesSummary
    bodies: tuple[SampledBody, ...]
    exempt: Exempt
    rules: tuple[RuleReport, ...]
    samples: tuple[SampledPose, ...]
    pairs: tuple[SampledPair, ...]
    issues: tuple[Issue, ...]
    truncated: SamplesTruncated | None = None
    config: StatedConfig | None = None
