"""What `satcheck stability` found: one question, asked in ways that must not change the answer."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Quality, Relation, Tool, Value, Vector

Family = Literal[
    "scale", "order", "axes", "swap", "translation", "retessellation", "motion", "noise"
]
Judgement = Literal["same", "within", "undecided", "beyond"]
StabilityVerdict = Literal["stable", "changed", "undecided"]


class StatedAnswer(Value, frozen=True):
    """relation: the exact one, without a touch band. depth_bounds: contains the depth."""

    relation: Relation
    distance: Length | None
    depth_bounds: Interval | None
    mtv: Vector | None
    quality: Quality | None
    reason: str | None


class StatedVariant(Value, frozen=True):
    """how: what was done, in words. beyond: what changed and must not have. change: of the signed
    distance, at least. bound: how much of that change the variant may cause."""

    how: str
    judgement: Judgement
    beyond: tuple[str, ...]
    change: Length | None
    bound: Length
    answer: StatedAnswer


class StatedFamily(Value, frozen=True):
    """judgement: the worst of the samples; None: there are none. skipped: why there are none.
    change, bound: the largest of the samples."""

    family: Family
    judgement: Judgement | None
    skipped: str | None
    change: Length | None
    bound: Length
    samples: tuple[StatedVariant, ...]


class StabilityReport(Value, frozen=True, kw_only=True):
    """The same question asked in other ways. Every answer is taken back to the frame, the scale and
    the order of the question as asked; lengths in the units of the files.

    a, b: the files as given. verdict: changed: something changed beyond its bound. undecided: not
    changed, but something could not be compared.
    """

    schema: Literal["satcheck.stability/1"] = "satcheck.stability/1"
    tool: Tool
    a: str
    b: str
    seed: Count
    verdict: StabilityVerdict
    answer: StatedAnswer
    families: tuple[StatedFamily, ...]
