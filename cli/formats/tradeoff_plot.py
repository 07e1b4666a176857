"""Error against time, rung by rung: lower left is better. All panels share the axis of time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from satcheck.audit.words import duration, number
from satcheck.cli.formats.tradeoff import silent, title
from satcheck.cli.output import harmless
from satcheck.cli.plotting import LETTERS, POINTS_PER_INCH, WIDTH, Palette, fitted, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from satcheck.report.tradeoff import Row, TradeoffReport

_HEAD, _PANEL, _LINE = 40.0, 260.0, 15.0  # points


def draw(results: Sequence[TradeoffReport], *, dark: bool = False) -> Figure:
    """Return a figure with a panel for each pair, and below it what is not drawn."""
    remarks = [
        [line for said in _remarks(result) for line in wrap(harmless(said), LETTERS)]
        for result in results
    ]
    heights = [_PANEL + _LINE * len(lines) for lines in remarks]
    size = WIDTH / POINTS_PER_INCH, (_HEAD + sum(heights)) / POINTS_PER_INCH
    with style(dark=dark) as palette:
        figure = Figure(size, layout="constrained")
        panels = figure.subplots(len(results), sharex=True, squeeze=False, height_ratios=heights)
        for axes, result, lines in zip(panels[:, 0], results, remarks, strict=True):
            axes.set_title(fitted(title(result)))
            axes.set_xlabel("\n".join(lines), loc="left", size=10)
            _draw_rungs(axes, _drawn(result), palette)
        for marker, colour, words in _kinds(palette):
            axes.plot([], [], marker, color=colour, label=words)
        axes.plot([], [], "o:", mfc="none", color=palette.faint, label="cached")
        figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=4)
    return figure


def _kinds(palette: Palette) -> tuple[tuple[str, str, str], ...]:
    """Return marker, colour and words of a verdict that is proven, a guess, or wrong."""
    return (
        ("o", palette.proven, "verdict proven"),
        ("^", palette.guess, "verdict not proven"),
        ("x", palette.wrong, "verdict wrong"),
    )


def _drawn(result: TradeoffReport) -> list[Row]:
    return [row for row in _distinct(result) if row.error is not None and row.cold is not None]


def _distinct(result: TradeoffReport) -> list[Row]:
    """Return the rows that answered, without those that climbed no further than a lower rung and
    say what that says."""
    seen: dict[object, Row] = {}
    for row in result.rungs:
        own = row.settled_by in (None, row.rung)
        said = row.label if own else row.settled_by, row.signed_distance, row.bounds
        if row.state == "answered":
            seen.setdefault(said, row)
    return list(seen.values())


def _draw_rungs(axes: Axes, rows: Sequence[Row], palette: Palette) -> None:
    """Both axes are logarithmic, and have room for labels; errors reach down to 0."""
    errors = [abs(row.error) for row in rows if row.error] or [1.0]
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=min(errors))
    axes.margins(0.1, 0.2)
    axes.set_ylabel("error")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda time, _: duration(time)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda error, _: number(error)))
    axes.tick_params(labelbottom=True)
    for row in rows:
        (x, y), kinds = _place(row), _kinds(palette)
        marker, colour, _ = kinds[2 if row.right is False else 0 if row.proven else 1]
        if row.cached is not None:
            axes.plot([row.cached.median, x], [y, y], ":", color=palette.faint, linewidth=1)
            gid = f"{row.label}, cached"
            axes.plot(row.cached.median, y, "o", color=colour, mfc="none", gid=gid)
        axes.plot(x, y, marker, color=colour, markersize=9, gid=row.label)
    parts = [row for row in rows if row.threshold is not None]
    named = [row for row in rows if row not in parts[1:-1]]  # the coarsest and the finest
    for k, row in enumerate(sorted(named, key=_place)):
        up, va = (7, "bottom") if k % 2 == 0 else (-7, "top")
        where: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": va}
        axes.annotate(row.label, _place(row), (0, up), **where)


def _place(row: Row) -> tuple[float, float]:
    assert row.cold is not None
    return row.cold.median, abs(row.error or 0.0)


def _remarks(result: TradeoffReport) -> Iterator[str]:
    """Yield what is not drawn, and why."""
    for row in _distinct(result):
        if row.error is None and row.cold is not None:
            yield f"{row.label}: {duration(row.cold.median)}, verdict only"
    yield from silent(result)
