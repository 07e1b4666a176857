"""What figures share: logarithmic axes, text, and colours for light and dark paper."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape

# Paper, ink, faint ink, grid: light, then dark.
LIGHT = {"paper": "#ffffff", "ink": "#1f2328", "faint": "#59636e", "grid": "#dfe3e8"}
DARK = {"paper": "#0d1117", "ink": "#e6edf3", "faint": "#9198a1", "grid": "#2a3038"}
_FORMS = """
text { font: 12px system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
.head { font-size: 15px; font-weight: 600; }
.title { font-weight: 600; }
.small { font-size: 11px; }
.label { paint-order: stroke; stroke-width: 3px; stroke-linejoin: round; }
.dashed { stroke-dasharray: 4 4; }
""".strip()


@dataclass(frozen=True, slots=True)
class LogAxis:
    """A logarithmic axis from `low` to `high`, drawn from `start` to `end`."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        share = math.log(value / self.low) / math.log(self.high / self.low)
        return self.start + share * (self.end - self.start)

    @property
    def decades(self) -> Iterator[float]:
        """The powers of ten on the axis, its ends included."""
        first, last = math.ceil(math.log10(self.low)), math.floor(math.log10(self.high))
        return (10.0**k for k in range(first, last + 1))


def whole_decades(values: Sequence[float], start: float, end: float) -> LogAxis:
    """An axis from power of ten to power of ten around all values, which are positive."""
    first = math.floor(math.log10(min(values)))
    last = max(math.ceil(math.log10(max(values))), first + 1)
    return LogAxis(10.0**first, 10.0**last, start, end)


def plain(value: float) -> str:
    """`10,000`, `0.01`."""
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def text(x: float, y: float, words: str, anchor: str = "end", kind: str = "") -> str:
    name = f' class="{kind}"' if kind else ""
    return f'<text{name} x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def line(x1: float, y1: float, x2: float, y2: float, kind: str) -> str:
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'


def rectangle(x: float, y: float, wide: float, high: float, kind: str, hint: str = "") -> str:
    said = f"<title>{escape(hint)}</title>" if hint else ""
    corner = f'x="{x:.1f}" y="{y:.1f}" width="{wide:.1f}" height="{high:.1f}"'
    return f'<rect class="{kind}" {corner}>{said}</rect>'


def disc(x: float, y: float, radius: float, kind: str, hint: str = "") -> str:
    said = f"<title>{escape(hint)}</title>" if hint else ""
    return f'<circle class="{kind}" cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}">{said}</circle>'


def figure(
    wide: float,
    high: float,
    title: str,
    parts: Sequence[str],
    rules: tuple[Mapping[str, str], Mapping[str, str]] = ({}, {}),
) -> str:
    """The SVG, final newline included. rules: what a class looks like, in light and in dark."""
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide:g} {high:.0f}" '
        f'width="{wide:g}" height="{high:.0f}" role="img">',
        f"<title>{escape(title)}</title>",
        f"<style>\n{_FORMS}\n{_colours(LIGHT, rules[0])}\n"
        f"@media (prefers-color-scheme: dark) {{\n{_colours(DARK, rules[1])}\n}}\n</style>",
        '<rect class="paper" width="100%" height="100%"/>',
        *parts,
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _colours(scheme: Mapping[str, str], rules: Mapping[str, str]) -> str:
    """Spelled out for each scheme: not every viewer of SVG knows variables of CSS."""
    common = (
        f".paper {{ fill: {scheme['paper']}; }} text {{ fill: {scheme['ink']}; }} "
        f".small, .faint {{ fill: {scheme['faint']}; }}\n"
        f".grid {{ stroke: {scheme['grid']}; }} .rule {{ stroke: {scheme['faint']}; }} "
        f".label {{ stroke: {scheme['paper']}; }}"
    )
    return "\n".join([common, *(f".{name} {{ {rule} }}" for name, rule in rules.items())])
