"""Stacked bars: what became of each rung, pair by pair, and where the time of a check goes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bench.accuracy.palette import ink_on, outcomes, stages
from bench.accuracy.rungs import RungSummary
from bench.accuracy.stages import GROUPS, OTHER, StageTimes
from bench.accuracy.verdicts import OUTCOMES
from satcheck.audit.words import duration
from satcheck.cli.plotting import POINTS_PER_INCH, Palette, style

WIDTH = 780.0  # points
_HEAD = 84.0
_LETTER = 7.5  # the width of a digit, in points
_MICROSECONDS = 1e6
WORDS = {
    "right": "right",
    "false hit": "false hit",
    "miss": "miss",
    "undecided": "undecided",
    "not judged": "touching, or truth not known",
    "failed": "refused",
    "not run": "out of budget",
}


def draw_verdicts(rungs: Sequence[RungSummary], *, dark: bool) -> Figure:
    pairs = sum(rungs[0].outcomes.values())
    bars = [
        _Bar(rung.label, [rung.outcomes[kind] for kind in OUTCOMES], "{:.0f}") for rung in rungs
    ]
    names = [WORDS[kind] for kind in OUTCOMES]
    with style(dark=dark) as palette:
        figure = Figure((WIDTH / POINTS_PER_INCH, (_HEAD + 27 * len(bars)) / POINTS_PER_INCH))
        box = _head(figure, f"Yes or no, of {pairs} pairs", 90)
        axes = _stack(figure, box, bars, names, outcomes(dark=dark), palette)
        axes.set_yticks(range(len(bars)), [bar.label for bar in bars])
    return figure


def draw_stages(kinds: Sequence[StageTimes], *, dark: bool) -> Figure:
    groups = [*GROUPS, OTHER]
    bars = [
        _Bar(_said(kind), [100 * kind.shares.get(group, 0.0) for group in groups], "{:.0f} %")
        for kind in kinds
    ]
    with style(dark=dark) as palette:
        figure = Figure((WIDTH / POINTS_PER_INCH, (_HEAD + 62 * len(bars)) / POINTS_PER_INCH))
        box = _head(figure, "Where the time of a plain check goes, from files to report", 16)
        axes = _stack(figure, box, bars, groups, stages(dark=dark), palette, height=0.5)
        axes.set_yticks([])
        for row, bar in enumerate(bars):
            axes.text(0, row - 0.32, bar.label, weight="bold")
    return figure


def _said(kind: StageTimes) -> str:
    total = kind.total
    quartiles = " .. ".join(duration(_MICROSECONDS * end) for end in (total.first, total.third))
    median = duration(_MICROSECONDS * total.median)
    return f"{kind.kind}: {kind.pairs} pairs, median {median}, quartiles {quartiles}"


@dataclass(frozen=True, slots=True)
class _Bar:
    """form: of the number on each piece."""

    label: str
    pieces: Sequence[float]
    form: str


_Box = tuple[float, float, float, float]


def _head(figure: Figure, title: str, left: float) -> _Box:
    """Writes the title; returns where the bars go."""
    height = figure.get_figheight() * POINTS_PER_INCH
    figure.text(16 / WIDTH, 1 - 26 / height, title, size=13, weight="bold")
    return left / WIDTH, 8 / height, 1 - (left + 16) / WIDTH, 1 - (_HEAD - 4) / height


def _stack(
    figure: Figure,
    box: _Box,
    bars: Sequence[_Bar],
    names: Sequence[str],
    colours: Sequence[str],
    palette: Palette,
    height: float = 0.72,
) -> Axes:
    """names, colours: of the pieces of each bar, in their order."""
    axes = figure.add_axes(box)
    ends = [0.0] * len(bars)
    whole = max(sum(bar.pieces) for bar in bars)
    for k, (name, colour) in enumerate(zip(names, colours, strict=True)):
        sizes = [bar.pieces[k] for bar in bars]
        if not any(sizes):
            continue
        drawn = axes.barh(
            range(len(bars)),
            sizes,
            height,
            left=ends,
            color=colour,
            edgecolor=palette.paper,
            label=name,
        )
        fits = [_fitted(bar, k, box[2] * WIDTH / whole) for bar in bars]
        axes.bar_label(drawn, fits, label_type="center", color=ink_on(colour))
        ends = [end + size for end, size in zip(ends, sizes, strict=True)]
    axes.set(xlim=(0, whole), ylim=(len(bars) - 0.5, -0.5), xticks=[])
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0, labelcolor=palette.ink, labelsize=10.5)
    axes.grid(False)
    top = figure.get_figheight() * POINTS_PER_INCH
    figure.legend(
        loc="upper left",
        bbox_to_anchor=(8 / WIDTH, 1 - 32 / top),
        ncols=9,
        columnspacing=1.2,
        handlelength=1.0,
        handleheight=1.0,
        handletextpad=0.5,
        fontsize=9.5,
    )
    return axes


def _fitted(bar: _Bar, k: int, wide: float) -> str:
    """The number on a piece, or nothing where it does not fit."""
    words = bar.form.format(bar.pieces[k])
    return words if bar.pieces[k] * wide > _LETTER * len(words) + 4 else ""
