"""What a probe found: plain frozen data, and its one way into JSON values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, Literal

from msgspec import Struct, to_builtins

from satcheck.audit.summary import tool
from satcheck.report.report import Relation
from satcheck.studies.stability.answer import Answer
from satcheck.studies.stability.comparison import Comparison, Judgement
from satcheck.studies.stability.variant import Family

SCHEMA = "satcheck.stability/1"

Verdict = Literal["stable", "changed", "undecided"]
# What the document has of each.
_ANSWER = ("relation", "distance", "depth_bounds", "mtv", "quality", "reason")
_COMPARISON = ("judgement", "beyond", "change", "bound")
_FAMILY = ("family", "judgement", "skipped", "change", "bound")
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
    def verdict(self) -> Verdict:
        judgements = {family.judgement for family in self.families}
        if "beyond" in judgements:
            return "changed"
        return "undecided" if "undecided" in judgements else "stable"

    @property
    def sample_count(self) -> int:
        return sum(len(family.samples) for family in self.families)

    def to_dict(self) -> dict[str, Any]:
        """JSON values in a fixed order; equal input and seed give equal values."""
        return {
            "schema": SCHEMA,
            "tool": to_builtins(tool()),
            "a": self.a,
            "b": self.b,
            "seed": self.seed,
            "verdict": self.verdict,
            "answer": _fields(self.answer, _ANSWER),
            "families": [
                _fields(family, _FAMILY) | {"samples": [_sample(s) for s in family.samples]}
                for family in self.families
            ],
        }


def _sample(sample: Sample) -> dict[str, Any]:
    comparison = _fields(sample.comparison, _COMPARISON)
    return {"how": sample.how} | comparison | {"answer": _fields(sample.answer, _ANSWER)}


def _fields(value: Struct, names: Sequence[str]) -> dict[str, Any]:
    return {name: to_builtins(getattr(value, name)) for name in names}
