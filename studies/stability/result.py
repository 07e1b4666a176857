"""What a probe found: plain frozen data, and its one way into JSON values."""

from __future__ import annotations

from typing import Any, Literal

from msgspec import Struct, to_builtins

from satcheck.audit.report.report import Relation, Vector
from satcheck.audit.summary import tool
from satcheck.studies.stability.answer import Answer
from satcheck.studies.stability.comparison import Comparison, Judgement
from satcheck.studies.stability.variant import Family

SCHEMA = "satcheck.stability/1"

Verdict = Literal["stable", "changed", "undecided"]
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
        ranks = [JUDGEMENTS.index(one.comparison.judgement) for one in self.samples]
        return JUDGEMENTS[max(ranks)] if ranks else None

    @property
    def relations(self) -> dict[Relation, int]:
        """How many samples came to each relation."""
        counted: dict[Relation, int] = {}
        for one in self.samples:
            counted[one.answer.relation] = counted.get(one.answer.relation, 0) + 1
        return counted

    @property
    def change(self) -> float | None:
        """The largest one."""
        known = [c for c in (one.comparison.change for one in self.samples) if c is not None]
        return max(known, default=None)

    @property
    def bound(self) -> float:
        return max((one.comparison.bound for one in self.samples), default=0.0)


class Stability(Struct, frozen=True):
    """a, b: the names of the files. asked: the answer to the question as given. band: up to this
    gap or depth a plain check says `touching`; here nothing is within a band."""

    a: str
    b: str
    seed: int
    asked: Answer
    families: tuple[FamilyResult, ...]
    band: float = 0.0

    @property
    def in_band(self) -> bool:
        """Whether a plain check answers `touching` instead."""
        asked = self.asked
        most = asked.gap if asked.depth is None else asked.depth[1]
        return asked.relation != "touching" and most is not None and most <= self.band

    @property
    def verdict(self) -> Verdict:
        found = {family.judgement for family in self.families}
        if "beyond" in found:
            return "changed"
        return "undecided" if "undecided" in found else "stable"

    @property
    def asked_ways(self) -> int:
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
            "answer": _answer(self.asked),
            "families": [_family(family) for family in self.families],
        }


def _family(family: FamilyResult) -> dict[str, Any]:
    return {
        "family": family.family,
        "judgement": family.judgement,
        "skipped": family.skipped,
        "change": family.change,
        "bound": family.bound,
        "samples": [_sample(sample) for sample in family.samples],
    }


def _sample(sample: Sample) -> dict[str, Any]:
    found = sample.comparison
    return {
        "how": sample.how,
        "judgement": found.judgement,
        "beyond": list(found.beyond),
        "change": found.change,
        "bound": found.bound,
        "answer": _answer(sample.answer),
    }


def _answer(answer: Answer) -> dict[str, Any]:
    return {
        "relation": answer.relation,
        "distance": answer.gap,
        "depth_bounds": None if answer.depth is None else list(answer.depth),
        "mtv": _vector(answer.mtv),
        "quality": answer.quality,
        "reason": answer.reason,
    }


def _vector(vector: Vector | None) -> list[float] | None:
    return None if vector is None else list(vector)
