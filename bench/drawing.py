"""What the figures of the benchmarks share: a light and a dark file of each, and tick labels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from satcheck.cli.plotting import file_of

# Draws one figure, on dark paper or on light.
Draw = Callable[[bool], Figure]


def both(name: str, draw: Draw) -> dict[str, bytes]:
    """SVG by the name of its file: NAME.svg and NAME-dark.svg."""
    return {
        f"{name}.svg": file_of(draw(False), ".svg"),
        f"{name}-dark.svg": file_of(draw(True), ".svg"),
    }


def write_both(path: Path, draw: Draw) -> None:
    """path: of the light file, an SVG; the dark one lies beside it."""
    for name, content in both(path.stem, draw).items():
        path.with_name(name).write_bytes(content)


def embedded(folder: str, name: str, words: str) -> str:
    """HTML, which Markdown takes: the file that suits the reader's scheme. words: in its place."""
    return (
        f'<picture><source media="(prefers-color-scheme: dark)" srcset="{folder}/{name}-dark.svg"/>'
        f'<img alt="{words}" src="{folder}/{name}.svg"/></picture>'
    )


def name_decades(axis: Axis, words: Callable[[float], str]) -> None:
    """Of a logarithmic axis: ticks at powers of ten, in these words."""
    axis.set_major_formatter(FuncFormatter(lambda value, _: words(value)))
    axis.set_minor_locator(NullLocator())


def plain(value: float) -> str:
    """`10,000`, `0.01`."""
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def percent(share: float) -> str:
    """`0.01 %`; `0`."""
    if share == 0:
        return "0"
    return f"{plain(float(f'{100 * share:.3g}'))} %"
