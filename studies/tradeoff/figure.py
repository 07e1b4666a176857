"""Signed distances: what a rung says, what is proven, and how far the two are apart.

Signed distance: > 0 a gap, < 0 an overlap, as deep as the shortest translation that ends it.
"""

from __future__ import annotations

import math

from msgspec import Struct

from satcheck.audit.bodies.verdict import Verdict
from satcheck.report.report import OVERLAPS, Finding, Relation


class Figure(Struct, frozen=True):
    """value: the figure a rung gives. low, high: what it leaves open; None: no bound."""

    value: float
    low: float | None
    high: float | None

    @property
    def width(self) -> float | None:
        return None if self.low is None or self.high is None else self.high - self.low


class Truth(Struct, frozen=True):
    """What the exact rung has proven; relation, figure: None where it has not, reason says why.

    pad: what the rounding of a coordinate can make of a length.
    """

    relation: Relation | None
    figure: Figure | None
    pad: float
    reason: str | None = None

    def error(self, said: Figure | None) -> float | None:
        """The figure minus the nearest signed distance that is possible; 0.0 within rounding.
        Negative: closer or deeper than the bodies are."""
        if said is None or self.figure is None:
            return None
        low, high = self.figure.low, self.figure.high
        if low is None or high is None:
            return None
        nearest = min(max(said.value, low), high)
        error = said.value - nearest
        return 0.0 if abs(error) <= self.pad else error

    def is_right(self, overlap: bool | None, relation: Relation | None) -> bool | None:
        """Whether an answer agrees. That bodies overlap is what a rung can know: `contains`,
        `inside` and `coincident` are overlaps like any. relation: None where only that is said."""
        if self.relation is None or overlap is None:
            return None
        if overlap != (self.relation in OVERLAPS):
            return False
        return overlap or relation in (None, self.relation)


def is_of_bodies(finding: Finding) -> bool:
    """Whether it says how the bodies relate, not their surfaces alone, or nothing."""
    return finding.undecided not in ("relation", "inside")


def figure_of(finding: Finding, verdict: Verdict) -> Figure | None:
    """verdict: of the same ladder, for what it proves and nobody asked to report. None: no figure
    of the bodies; how far their surfaces are apart says nothing of one that may lie inside."""
    if not is_of_bodies(finding):
        return None
    if finding.depth_bounds is not None:
        low, high = finding.depth_bounds
        # An overlap that is not proven may be a gap, of any width.
        return Figure(-high + 0.0, -high + 0.0, -low + 0.0 if verdict.proven else None)
    signed = verdict.signed_distance
    if signed is not None and signed.distance is not None:
        return Figure(signed.distance, signed.lower, signed.upper)
    if finding.distance is not None:
        return Figure(finding.distance, finding.distance, finding.distance)
    if verdict.relation == "separated":
        return Figure(verdict.gap_lower, verdict.gap_lower if verdict.proven else None, None)
    if verdict.relation == "touching":
        return Figure(0.0, 0.0, 0.0)
    band = finding.tolerance
    return None if finding.relation != "touching" or band is None else Figure(0.0, -band, None)


def truth_of(finding: Finding, figure: Figure | None, pad: float) -> Truth:
    relation = plain(finding.relation)
    if finding.exact_relation is None or not is_of_bodies(finding):
        return Truth(None, None, pad, finding.reason or "the exact rung has not proven it")
    known = figure is not None and figure.width is not None and math.isfinite(figure.width)
    return Truth(relation, figure if known else None, pad, finding.reason)


def plain(relation: Relation) -> Relation:
    """Without the clearance that is asked only to have the gap measured."""
    return "separated" if relation == "near" else relation
