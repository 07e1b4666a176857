"""The same bodies in many poses of their robots: a verdict for each pose, and counts for pairs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.bodies import StatedShape
from satcheck.report.config import StatedConfig
from satcheck.report.report import Exempt, Finding, Issue, JointValues, RuleReport
from satcheck.report.settings import StatedSettings
from satcheck.report.values import Count, Sha256, Tool, Value, Verdict

# From 1.
Number = Annotated[int, Meta(ge=1)]


class SampledBody(Value, frozen=True):
    """A body as in a report of one pose, without what depends on the pose."""

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
    """In how many samples the pair is what, at rest or while it moves; in the others it is
    separated.

    undecided: how they relate, or whether they hit on the way. first_overlap: number of the first
    sample in which the two overlap.
    """

    a: str
    b: str
    overlaps: Count
    touches: Count
    near: Count
    undecided: Count
    first_overlap: Number | None


class SampledPairCounts(Value, frozen=True):
    """total: as in a report of one pose, with the allowed ones. allowed: by rules, an SRDF, or
    because both bodies are of one link: not checked. exempt: pairs of static bodies, and pairs
    within an ignored group: not checked, and not in total. separated: in all samples."""

    total: Count
    allowed: Count
    exempt: Count
    separated: Count


class SamplesSummary(Value, frozen=True):
    """verdict: the worst of the samples. by_verdict: how many samples."""

    verdict: Verdict
    samples: Number
    by_verdict: Mapping[Verdict, Count]
    pairs: SampledPairCounts


class SamplesReport(Value, frozen=True, kw_only=True):
    """The same bodies in many poses of their robots. World frame, right-handed; lengths in the
    units of the files. A figure that was not computed is None, never 0.

    seed: of the random poses; None: they are not random. pairs: those that are not separated in
    all samples. issues: those that are not about the pose of one sample. config: as in a report.
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
    samples: Annotated[tuple[SampledPose, ...], Meta(min_length=1)]
    pairs: tuple[SampledPair, ...]
    issues: tuple[Issue, ...]
    config: StatedConfig | None = None
