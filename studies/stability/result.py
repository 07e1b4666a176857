"""What a probe found: plain frozen data, and the document that is written of it."""

from __future__ import annotations

from collections import Counter

from msgspec import Struct

from satcheck.audit.summary import tool
from satcheck.report.report import Relation
from satcheck.report.stability import (
    Family,
    Judgement,
    StabilityReport,
    StabilityVerdict,
    StatedAnswer,
    StatedFamily,
    StatedVariant,
)
from satcheck.studies.stability.answer import Answer
from satcheck.studies.stability.comparison import Comparison

# From best to worst.
JUDGEMENTS: tuple[Judgement, ...] = ("same", "within", "undecided", "beyond")


class Sample(Struct, frozen=True):
    """how: what was done, for people."""

    how: str
    answer: Answer
    comparison: Comparison


class FamilyResult(Struct, frozen=True):
    """samples: none where the family has nothing to say about this pair, see `skipped`."""

    family: Family
    samples: tuple[Sample, ...]
    skipped: str | None = None

    @property
    def judgement(self) -> Judgement | None:
        """The worst of the samples."""
        ranks = [JUDGEMENTS.index(sample.comparison.judgement) for sample in self.samples]
        return JUDGEMENTS[max(ranks)] if ranks else None

    @property
    def relations(self) -> dict[Relation, int]:
        """How many samples came to each relation."""
        return dict(Counter(sample.answer.relation for sample in self.samples))

    @property
    def change(self) -> float | None:
        """The largest one."""
        changes = (sample.comparison.change for sample in self.samples)
        return max((change for change in changes if change is not None), default=None)

    @property
    def thickness_change(self) -> float | None:
        """The largest one."""
        changes = (sample.comparison.thickness_change for sample in self.samples)
        return max((change for change in changes if change is not None), default=None)

    @property
    def bound(self) -> float:
        return max((sample.comparison.bound for sample in self.samples), default=0.0)


class Stability(Struct, frozen=True):
    """a, b: the names of the files. answer: to the question as given. band: up to this
    gap or depth a plain check says `touching`; here nothing is within a band."""

    a: str
    b: str
    seed: int
    answer: Answer
    families: tuple[FamilyResult, ...]
    band: float = 0.0

    @property
    def in_band(self) -> bool:
        """Whether a plain check answers `touching` instead."""
        answer = self.answer
        most = answer.distance if answer.depth_bounds is None else answer.depth_bounds[1]
        return answer.relation != "touching" and most is not None and most <= self.band

    @property
    def verdict(self) -> StabilityVerdict:
        judgements = {family.judgement for family in self.families}
        if "beyond" in judgements:
            return "changed"
        return "undecided" if "undecided" in judgements else "stable"

    @property
    def sample_count(self) -> int:
        return sum(len(family.samples) for family in self.families)

    def document(self) -> StabilityReport:
        """Equal input and seed give an equal document."""
        return StabilityReport(
            tool=tool(),
            a=self.a,
            b=self.b,
            seed=self.seed,
            verdict=self.verdict,
            answer=_answer(self.answer),
            families=tuple(_family(family) for family in self.families),
        )


def _family(family: FamilyResult) -> StatedFamily:
    return StatedFamily(
        family=family.family,
        judgement=family.judgement,
        skipped=family.skipped,
        change=family.change,
        bound=family.bound,
        thickness_change=family.thickness_change,
        samples=tuple(_variant(sample) for sample in family.samples),
    )


def _variant(sample: Sample) -> StatedVariant:
    comparison = sample.comparison
    return StatedVariant(
        how=sample.how,
        judgement=comparison.judgement,
        beyond=comparison.beyond,
        change=comparison.change,
        bound=comparison.bound,
        thickness_change=comparison.thickness_change,
        answer=_answer(sample.answer),
    )


def _answer(answer: Answer) -> StatedAnswer:
    return StatedAnswer(
        relation=answer.relation,
        distance=answer.distance,
        depth_bounds=answer.depth_bounds,
        thickness_bounds=answer.thickness_bounds,
        mtv=answer.mtv,
        quality=answer.quality,
        reason=answer.reason,
    )
