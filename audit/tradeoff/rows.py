"""From what was seen of a rung to its row: held against the truth, and in the words of a report."""

from __future__ import annotations

from satcheck.audit.report.report import OVERLAPS, Finding
from satcheck.audit.tradeoff.asking import Asked, Measured
from satcheck.audit.tradeoff.figure import Truth, figure_of, is_of_bodies, plain, truth_of
from satcheck.audit.tradeoff.gauge import Gauge
from satcheck.audit.tradeoff.result import Picked, Row
from satcheck.audit.tradeoff.times import Times
from satcheck.core.frozen import replace

# Stages of a plan that are rungs, and how they are called here.
STAGES = {"aabb": "aabb", "obb": "obb", "sat": "hull", "hull": "hull", "curved": "hull"}
STAGES |= {"curved-exact": "hull", "parts": "parts", "triangles": "exact"}
# What a stage records that had nothing to add to the one below.
SKIPPED = "skipped"


def truth_by(exact: Gauge) -> Truth:
    answer = exact.answer
    if not isinstance(answer, Asked):
        return Truth(None, None, 0.0, f"the exact rung was not run: {exact.reason}")
    return truth_of(answer.finding, figure_of(answer.finding, answer.contact), answer.pad)


def row_of(gauge: Gauge, truth: Truth) -> Row:
    row = Row(
        rung=gauge.rung,
        state=gauge.state,
        reason=gauge.reason,
        cold=Times(tuple(gauge.cold)) if gauge.cold else None,
        cached=Times(tuple(gauge.cached)) if gauge.cached else None,
        cpu=Times(tuple(gauge.cpu)) if gauge.cpu else None,
        megabytes=gauge.megabytes,
    )
    answer = gauge.answer
    if gauge.state != "answered" or answer is None:
        return row
    if isinstance(answer, Measured):
        return _with_volume(row, answer, truth)
    finding = answer.finding
    relation = plain(finding.relation)
    known = is_of_bodies(finding) and relation != "indeterminate"
    overlap = relation in OVERLAPS if known else None
    figure = figure_of(finding, answer.contact)
    return replace(
        row,
        overlap=overlap,
        relation=relation,
        proven=known and finding.exact_relation is not None,
        right=truth.is_right(overlap, relation),
        figure=figure,
        error=truth.error(figure),
        hulls=answer.hulls,
        settled_by=_ended(answer),
        reason=None if known else finding.reason,
    )


def _ended(answer: Asked) -> str:
    """The rung of its last step; parts that nobody could make are the hulls of the bodies."""
    rung = picked(answer.finding).rung
    return "hull" if rung == "parts" and not answer.split else rung


def _with_volume(row: Row, answer: Measured, truth: Truth) -> Row:
    """A volume within its own error says nothing, except that there is none to be seen."""
    overlap = None if 0 < answer.volume <= answer.error else answer.volume > 0
    return replace(
        row,
        overlap=overlap,
        right=truth.is_right(overlap, None),
        volume=answer.volume,
        volume_error=answer.error,
        reason="the volume lies within its own error" if overlap is None else None,
    )


def picked(finding: Finding) -> Picked:
    """The last stage that is a rung ended the climb; those before say why they could not."""
    climbed = [stage for stage in finding.plan if stage.stage in STAGES]
    why = "; ".join(
        f"{stage.stage} {stage.result}" + (f" ({stage.detail})" if stage.detail else "")
        for stage in climbed
    )
    ran = [STAGES[stage.stage] for stage in climbed if stage.result != SKIPPED]
    settled = finding.exact_relation is not None and is_of_bodies(finding)
    return Picked(ran[-1] if ran else "none", settled, why if settled else _unsettled(finding, why))


def _unsettled(finding: Finding, why: str) -> str:
    return "; ".join(said for said in (why, finding.reason) if said)
