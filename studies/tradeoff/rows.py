"""The row of a rung: its measurements, compared with the truth, in the words of a report."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.report.report import OVERLAPS
from satcheck.studies.tradeoff.gauge import Gauge
from satcheck.studies.tradeoff.pareto import Times
from satcheck.studies.tradeoff.reading import figure_of, is_of_bodies, plain, truth_of
from satcheck.studies.tradeoff.result import Figure, Row, Truth
from satcheck.studies.tradeoff.rungs import EXACT
from satcheck.studies.tradeoff.runs import LadderRun, VolumeRun, Volumes


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


def row_of(gauge: Gauge, truth: Truth, own: Volumes) -> Row:
    """own: volumes of the bodies."""
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
        hulls=answer.hulls,
        excess=_excess(own if answer.ended == EXACT.name else answer.volumes, own),
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


def _excess(volumes: Volumes, own: Volumes) -> tuple[float | None, float | None]:
    a, b = (
        None if taken is None or not true else taken / true - 1.0
        for taken, true in zip(volumes, own, strict=True)
    )
    return a, b
