"""The report of `satcheck stability`: a pair in variants that must not change the answer."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Quality, Relation, Tool, Value, Vector

Family = Literal[
    "scale", "order", "axes", "swap", "translation", "retessellation", "motion", "noise"
]
Judgement = Literal["same", "within", "undecided", "beyond"]
StabilityVerdict = Literal["stable", "changed", "undecided"]


class StatedAnswer(Value, frozen=True):
    """relation: the exact one, without a touch band. depth_bounds: contains the depth.
    thickness_bounds: contains the thickness; None: a body is not closed."""

    relation: Relation
    distance: Length | None
    depth_bounds: Interval | None
    thickness_bounds: Interval | None
    mtv: Vector | None
    quality: Quality | None
    reason: str | None


class StatedVariant(Value, frozen=True):
    """how: the variant, in words. beyond: what changed although it must not. change: a lower bound
    of the change of the signed distance. bound: the change that the variant may cause.
    thickness_change: a lower bound of the change of the thickness, which may be twice the bound."""

    how: str
    judgement: Judgement
    beyond: tuple[str, ...]
    change: Length | None
    bound: Length
    thickness_change: Length | None
    answer: StatedAnswer


class StatedFamily(Value, frozen=True):
    """judgement: the worst of the samples; None: no samples. skipped: why there are no samples.
    change, bound, thickness_change: the largest of the samples."""

    family: Family
    judgement: Judgement | None
    skipped: str | None
    change: Length | None
    bound: Length
    thickness_change: Length | None
    samples: tuple[StatedVariant, ...]


class StabilityReport(Value, frozen=True, kw_only=True):
    """A pair and its variants. Every answer is converted back to the frame, the scale and the order
    of the original pair; lengths in the units of the files.

    a, b: the files as given. verdict: changed: an answer changed beyond its bound. undecided: no
    answer changed, but some could not be compared.
    """

    schema: Literal["satcheck.stability/1"] = "satcheck.stability/1"
    tool: Tool
    a: str
    b: str
    seed: Count
    verdict: StabilityVerdict
    answer: StatedAnswer
    families: tuple[StatedFamily, ...]
