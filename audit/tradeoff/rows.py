"""The row of a rung: its measurements, compared with the truth, in the words of a report.

Signed distance: > 0 a gap, < 0 an overlap, as deep as the shortest translation that ends it.
"""

from __future__ import annotations

import math

from msgspec.structs import replace

from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.tradeoff.gauge import Gauge
from satcheck.audit.tradeoff.pareto import Times
from satcheck.audit.tradeoff.result import Figure, Row, Truth
from satcheck.audit.tradeoff.runs import LadderRun, VolumeRun, is_of_bodies
from satcheck.report.report import OVERLAPS, Finding, Relation


def truth_by(exact: Gauge) -> Truth:
    answer = exact.answer
    if not isinstance(answer, LadderRun):
        return Truth(None, None, 0.0, f"the exact rung was not run: {exact.reason}")
    truth = truth_of(answer.finding, figure_of(answer.finding, answer.verdict), answer.pad)
    if truth.relation is None:
        return truth
    if answer.finding.exact_relation not in OVERLAPS:
        return replace(truth, thickness=Figure(0.0, 0.0, 0.0))
    return truth if answer.thickness is None else replace(truth, thickness=answer.thickness.figure)


def row_of(gauge: Gauge, truth: Truth) -> Row:
    row = Row(
        rung=gauge.rung,
        state=gauge.state,
        reason=gauge.reason,
        cold=Times(tuple(gauge.cold)) if gauge.cold else None,
        cached=Times(tuple(gauge.cached)) if gauge.cached else None,
        cpu=Times(tuple(gauge.cpu)) if gauge.cpu else None,
    )
    answer = gauge.answer
    if gauge.state != "answered" or answer is None:
        return row
    if isinstance(answer, VolumeRun):
        return _with_volume(row, answer, truth)
    finding = answer.finding
    relation = plain(finding.relation)
    known = is_of_bodies(finding) and relation != "indeterminate"
    overlap = relation in OVERLAPS if known else None
    figure = figure_of(finding, answer.verdict)
    thickness = None if answer.thickness is None else answer.thickness.figure
    return replace(
        row,
        overlap=overlap,
        relation=relation,
        proven=known and finding.exact_relation is not None,
        right=truth.is_right(overlap, relation),
        figure=figure,
        error=truth.error(figure),
        thickness=thickness,
        thickness_error=truth.thickness_error(thickness),
        thickness_times=Times(tuple(gauge.thickness)) if gauge.thickness else None,
        settled_by=answer.ended,
        reason=None if known else finding.reason,
    )


def _with_volume(row: Row, answer: VolumeRun, truth: Truth) -> Row:
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
