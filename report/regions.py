"""What a report says about bodies that have to lie in a region."""

from __future__ import annotations

from typing import Literal

from satcheck.report.certificate import OnBody
from satcheck.report.statics import BodyRuleReport, State
from satcheck.report.values import Length, Value, Vector


class InsideFinding(Value, frozen=True, kw_only=True):
    """Whether a body lies in a region: yes, if no point of it is farther outside than the
    tolerance. rule: the name of the rule that asks. sticks_out: how far it surely does, beyond a
    face of a convex region, or as a distance from another one; None: it does not, or that is not
    known. shift: the body, moved so, lies in the region exactly. point: of the body, outside of the
    region. reason: of an answer that is not yes."""

    body: str
    region: str
    rule: str
    severity: Literal["error", "warning", "note", "silenced", "none"]
    answer: State
    reason: str | None = None
    sticks_out: Length | None = None
    shift: Vector | None = None
    point: OnBody | None = None

    @property
    def question(self) -> str:
        return f"inside {self.region}"


class Regions(Value, frozen=True, kw_only=True):
    """tolerance: by so much a body may stick out. rules: of single bodies. microseconds: of all of
    this."""

    tolerance: Length
    rules: tuple[BodyRuleReport, ...]
    findings: tuple[InsideFinding, ...]
    microseconds: Length = 0.0
