"""The result of `satcheck tradeoff` as text: a row for each rung, then how to read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.words import at_least, at_most, counted, duration, interval, number
from satcheck.cli.formats.tables import BOLD_RED, GREEN, Column, fitted, fitted_each, joined, table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from satcheck.cli.output import Page
    from satcheck.report.tradeoff import Bounds, Row, Times, TradeoffReport

_VERDICT = {True: "right", False: "WRONG", None: ""}
_STYLES = {True: GREEN, False: BOLD_RED, None: ""}


def render(result: TradeoffReport, page: Page) -> str:
    """Return the whole text, final newline included."""
    below = [f"  {line}" for line in silent(result)]
    if result.default is not None:
        below.append(f"The default: settled by {result.default}; see satcheck --explain A B.")
    spent = f"{number(round(result.seconds, 1))} s of {number(result.budget)} s"
    below.append(
        "Error: signed distance said minus proven; below 0: closer or deeper than it is. "
        f"Medians of up to {counted(result.repeat, 'run')} in turn, {spent}."
    )
    lines = [*fitted(title(result), page), *_table(result, page)]
    return joined([*lines, *fitted_each(below, page)], page)


def title(result: TradeoffReport) -> str:
    truth = result.truth
    if truth.relation is None:
        return f"{result.a} against {result.b}: the truth is not known, {truth.reason}"
    said = "" if truth.bounds is None else f", {figure(truth.bounds[0], truth.bounds)}"
    return f"{result.a} against {result.b}: proven {truth.relation}{said}"


def silent(result: TradeoffReport) -> Iterator[str]:
    """Yield which rungs do not answer, and why."""
    reasons: dict[str, list[str]] = {}
    for row in result.rungs:
        if row.reason:
            reasons.setdefault(f"{row.state}, {row.reason}", []).append(row.label)
    for reason, labels in reasons.items():
        yield f"{', '.join(labels)}: {reason}"


def figure(value: float, bounds: Bounds) -> str:
    """`gap 0.5`, `depth <= 2`, `depth 0.25 .. 0.26`, `gap >= 1`."""
    low, high = bounds
    if value < 0:
        depth = None if high is None or high >= 0 else interval((-high, -value))
        return f"depth {depth or f'<= {at_most(-value)}'}"
    if high is None:
        return f"gap >= {at_least(value)}"
    return f"gap {number(value) if low is None else interval((max(low, 0.0), high))}"


def _table(result: TradeoffReport, page: Page) -> list[str]:
    rows = result.rungs
    exact = next((row.cold for row in rows if row.rung == "exact"), None)

    def column(name: str, cell: Callable[[Row], str], **how: bool) -> Column:
        return Column(name, tuple(map(cell, rows)), **how)

    columns = (
        column("rung", lambda row: row.label),
        column("relation", _relation, folds=True),
        column("verdict", _verdict, right=True, graded=True),
        column("answer", _answer, right=True, folds=True),
        column("error", _error, right=True),
        column("time", lambda row: _time(row.cold), right=True),
        column("x exact", lambda row: _ratio(row.cold, exact), right=True, folds=True),
        column("cached", lambda row: _time(row.cached), right=True, folds=True),
        column("settled by", lambda row: row.settled_by or "", folds=True),
    )
    styles = ["" if row.rung == "exact" else _STYLES[row.right] for row in rows]
    return table(columns, page, styles)


def _relation(row: Row) -> str:
    if row.state != "answered":
        return row.state
    if row.relation is None:
        return {True: "overlap", False: "no overlap", None: "cannot tell"}[row.overlap]
    if row.proven or row.relation == "indeterminate":
        return row.relation
    return f"{'surfaces' if row.overlap is None else 'possibly'} {row.relation}"


def _verdict(row: Row) -> str:
    return "the truth" if row.rung == "exact" and row.right else _VERDICT[row.right]


def _answer(row: Row) -> str:
    if row.volume is not None:
        error = f" ±{row.volume_error:.0e}" if row.volume_error else ""
        return f"volume {number(row.volume)}{error}"
    if row.signed_distance is None or row.bounds is None:
        return ""
    return figure(row.signed_distance, row.bounds)


def _error(row: Row) -> str:
    if row.error is None:
        return ""
    return "0" if row.error == 0 else f"{row.error:+.3g}"


def _time(times: Times | None) -> str:
    return "" if times is None else duration(times.median)


def _ratio(times: Times | None, exact: Times | None) -> str:
    """Two significant digits."""
    if times is None or exact is None:
        return ""
    ratio = times.median / exact.median
    return f"{ratio:.2g}" if ratio < 10 else f"{float(f'{ratio:.2g}'):,.0f}"
