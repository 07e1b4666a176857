"""The result of `satcheck tradeoff` as text: a row for each rung, then how to read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.audit.tradeoff import labels_of
from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.numbers import DIGITS, bounds, duration, number
from satcheck.cli.formats.tradeoff_steps import steps
from satcheck.cli.formats.words import counted

if TYPE_CHECKING:
    from collections.abc import Callable

    from satcheck.audit.tradeoff import (
        Figure,
        PairTradeoff,
        Row,
        Rung,
        Times,
        Tradeoff,
    )
    from satcheck.cli.output import Page

_MICROSECONDS = 1e6
_RIGHT = {True: "right", False: "WRONG", None: ""}
_COLOURS = {"right": "green", "WRONG": "bold red"}
# Left out, in this order, where a terminal is too narrow.
_SPARE = ("runs", "thickness time", "width", "spread", "cached")
# Never broken between lines.
_WHOLE = ("rung", "verdict", "error", "time")
_FRAME = 3
# As in a check: so narrow an interval, relatively, comes from rounding alone.
EXACT_WIDTH = 1e-9


def render(result: Tradeoff, page: Page) -> str:
    """The whole text, final newline included."""
    console = Canvas(page)
    for pair in result.pairs:
        _print_pair(console, pair, page)
    if result.left_out:
        console.print(f"{counted(result.left_out, 'more pair')} with boxes that meet: see --pairs.")
    console.print(
        "* on the Pareto front: no rung is better in time, error or proof without being worse in "
        "another; times within the spread of their runs (middle half) are alike. Error: signed "
        "distance said minus proven; below 0: closer or deeper than it is. Thickness: of the "
        "overlap of what stands for the bodies: hulls bound it, parts (~) do not."
    )
    spent = f"{number(round(result.spent, 1))} s of {number(result.budget)} s"
    console.print(f"Medians of up to {counted(result.repeat, 'run')} in turn, {spent}.")
    return console.text()


def _print_pair(console: Canvas, pair: PairTradeoff, page: Page) -> None:
    console.print(f"{pair.a} against {pair.b}: {_truth(pair)}")
    console.print(_table(pair, page))
    for line in _remarks(pair):
        console.print(f"  {line}")
    for line in steps(pair):
        console.print(f"* {line}")
    if pair.default is not None:
        ended = "settled by" if pair.default.settled else "not settled, ends at"
        console.print(f"Default: {ended} {pair.default.rung}. {pair.default.why}.")
    console.print()


def _remarks(pair: PairTradeoff) -> list[str]:
    """Why rungs do not answer, and which climbed no further than a lower one."""
    silent: dict[str, list[Rung]] = {}
    early: dict[str, list[Rung]] = {}
    for row in pair.rows:
        if row.reason:
            silent.setdefault(f"{row.state}, {row.reason}", []).append(row.rung)
        if row.ended_lower:
            early.setdefault(f"climbed no further than {row.settled_by}", []).append(row.rung)
    return [f"{labels_of(rungs)}: {said}" for said, rungs in (silent | early).items()]


def _truth(pair: PairTradeoff) -> str:
    truth = pair.truth
    if truth.relation is None:
        return f"the truth is not known, {truth.reason}"
    said = f"proven {truth.relation}"
    if truth.figure is not None:
        said += f", {figure(truth.figure)}"
    thickness = truth.thickness
    if thickness is not None and thickness.low is not None and thickness.high:
        said += f", thickness {_interval(thickness.low, thickness.high)}"
    return f"{said} ({truth.reason})" if truth.reason else said


def _table(pair: PairTradeoff, page: Page) -> Table:
    columns = _columns(pair)
    for name in _SPARE:
        if _width(columns) > page.width:
            columns.pop(name, None)
    table = Table(header_style="bold", box=box.ROUNDED if page.unicode else box.ASCII)
    for name in columns:
        left = name in ("rung", "relation")
        table.add_column(
            name, justify="left" if left else "right", overflow="fold", no_wrap=name in _WHOLE
        )
    for cells in zip(*columns.values(), strict=True):
        table.add_row(*(Text(cell, style=_COLOURS.get(cell, "")) for cell in cells))
    return table


def _columns(pair: PairTradeoff) -> dict[str, list[str]]:
    def column(cell: Callable[[Row], str]) -> list[str]:
        return [cell(row) for row in pair.rows]

    made = {
        "rung": column(lambda row: f"{'*' if row.on_front else ' '} {row.rung.label}"),
        "relation": column(_relation),
        "verdict": column(_verdict),
        "answer": column(_answer),
        "error": column(_error),
        "width": column(_width_of),
        "thickness": column(_thickness),
        "thickness time": column(lambda row: _time(row.thickness_times)),
        "time": column(lambda row: _time(row.cold)),
        "spread": column(lambda row: _spread(row.cold)),
        "runs": column(lambda row: "" if row.cold is None else str(len(row.cold.runs))),
        "cached": column(lambda row: _time(row.cached)),
    }
    return {name: cells for name, cells in made.items() if any(cells)}


def _verdict(row: Row) -> str:
    if row.rung.accuracy == "exact" and row.right:
        return "the truth"
    return _RIGHT[row.right]


def _width(columns: dict[str, list[str]]) -> int:
    return 1 + sum(_FRAME + max(map(len, (name, *cells))) for name, cells in columns.items())


def _relation(row: Row) -> str:
    if row.state != "answered":
        spent = (
            row.state == "not run" and row.reason is not None and row.reason.startswith("budget")
        )
        return "not run: budget" if spent else row.state
    if row.relation is None:
        words = {True: "overlap", False: "no overlap", None: "cannot tell"}
        return words[row.overlap]
    if row.proven or row.relation == "indeterminate":
        return row.relation
    if row.overlap is None:
        return f"surfaces {row.relation}"
    return f"possibly {row.relation}"


def figure(error: Figure) -> str:
    """`gap 0.5`, `depth <= 2`, `depth 0.25 .. 0.26`, `gap >= 1`."""
    low, high = error.low, error.high
    if error.value < 0:
        if high is None or high >= 0:
            return f"depth <= {number(-error.value)}"
        return f"depth {_interval(-high, -error.value)}"
    if high is None:
        return f"gap >= {number(error.value)}"
    return f"gap {number(error.value)}" if low is None else f"gap {_interval(max(low, 0.0), high)}"


def _interval(low: float, high: float) -> str:
    """One number where rounding alone makes it an interval."""
    return number(high) if high - low <= EXACT_WIDTH * high else bounds(low, high)


def _answer(row: Row) -> str:
    if row.volume is not None:
        error = f" +- {row.volume_error:.0e}" if row.volume_error else ""
        return f"volume {number(row.volume)}{error}"
    return "" if row.figure is None else figure(row.figure)


def _thickness(row: Row) -> str:
    """`<= 2` of hulls, `0.25 .. 0.26`; `~ 0.25` of parts, which leave both sides open."""
    thickness = row.thickness
    if thickness is None:
        return ""
    if thickness.high is None:
        return f"~ {number(thickness.value)}"
    low = thickness.low
    return f"<= {number(thickness.high)}" if low is None else _interval(low, thickness.high)


def _error(row: Row) -> str:
    if row.error is None:
        return ""
    return "0" if row.error == 0 else f"{row.error:+.{DIGITS - 3}g}"


def _width_of(row: Row) -> str:
    if row.figure is None:
        return ""
    width = row.figure.width
    return "open" if width is None else f"{width:.2g}"


def _time(times: Times | None) -> str:
    return "" if times is None else duration(times.median * _MICROSECONDS)


def _spread(times: Times | None) -> str:
    if times is None or len(times.runs) < 2:
        return ""
    low, high = (duration(end(times.runs) * _MICROSECONDS) for end in (min, max))
    return f"{low} .. {high}"
