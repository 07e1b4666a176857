"""What accuracy costs in time, as an SVG that follows the light or dark scheme of its reader."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from satcheck.cli.report.tradeoff_panel import WIDTH, panel, shape, time_axis

if TYPE_CHECKING:
    from satcheck.studies.tradeoff import PairTradeoff

_HEAD = 84.0
_RUNGS = (
    "aabb, obb: boxes; hull: convex hulls; parts: convex parts, coarse to fine; exact: triangles; "
    "boolean: volume in common"
)
# Paper, ink, faint ink, grid, lanes, and what is proven, guessed, wrong: light, then dark.
_LIGHT = ("#ffffff", "#1f2328", "#656d76", "#e4e8ec", "#b8c0c8", "#0a62c9", "#8f5f00", "#cf222e")
_DARK = ("#0d1117", "#e6edf3", "#9198a1", "#21262d", "#4a525c", "#58a6ff", "#e3b341", "#ff7b72")
_FORMS = """
text { font: 12px system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
.head { font-size: 15px; font-weight: 600; }
.title { font-weight: 600; }
.tick { font-size: 11px; }
.label { font-size: 11.5px; paint-order: stroke; stroke-width: 3px; stroke-linejoin: round; }
.front { fill: none; stroke-width: 1.5; }
.link { stroke-dasharray: 2 3; }
.wrong { fill: none; stroke-width: 2.5; }
""".strip()
_LEGEND = (
    ("proven", False, "verdict proven"),
    ("guess", False, "verdict not proven"),
    ("wrong", False, "verdict wrong"),
    ("proven", True, "cached"),
)


def svg(pairs: Sequence[PairTradeoff]) -> str:
    """One panel a pair, all on one axis of time; final newline included."""
    time, top, panels = time_axis(pairs), _HEAD, []
    for pair in pairs:
        drawn, height = panel(pair, time)
        panels.append(f'<g transform="translate(0 {top:.1f})">\n{drawn}\n</g>')
        top += height
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {top:.0f}" '
        f'width="{WIDTH:g}" height="{top:.0f}" role="img">',
        "<title>What accuracy costs in time</title>",
        f"<style>\n{_FORMS}\n{_colours(_LIGHT)}\n"
        f"@media (prefers-color-scheme: dark) {{\n{_colours(_DARK)}\n}}\n</style>",
        '<rect class="paper" width="100%" height="100%"/>',
        '<text class="head" x="16" y="24">What accuracy costs: error of distance or depth '
        "against time (lower left is better)</text>",
        *_legend(),
        f'<text class="label" x="16" y="70">{_RUNGS}</text>',
        *panels,
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def page(pairs: Sequence[PairTradeoff]) -> str:
    """The same in a page of HTML that needs nothing else."""
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="color-scheme" content="light dark">\n<title>satcheck tradeoff</title>\n'
        "<style>body { margin: 1rem; } svg { max-width: 100%; height: auto; }</style>\n"
        f"</head>\n<body>\n{svg(pairs)}</body>\n</html>\n"
    )


def _colours(scheme: Sequence[str]) -> str:
    """Rules for one scheme, spelled out: not every viewer of SVG knows variables of CSS."""
    paper, ink, faint, grid, lane, proven, guess, wrong = scheme
    return (
        f".paper {{ fill: {paper}; }} .label {{ stroke: {paper}; }} "
        f"text {{ fill: {ink}; }} .tick {{ fill: {faint}; }}\n"
        f".grid {{ stroke: {grid}; }} .lane, .link {{ stroke: {lane}; }} "
        f".front {{ stroke: {faint}; }}\n"
        f".proven {{ fill: {proven}; }} .guess {{ fill: {guess}; }} .wrong {{ stroke: {wrong}; }}\n"
        f".proven.cached {{ fill: {paper}; stroke: {proven}; }} "
        f".guess.cached {{ fill: {paper}; stroke: {guess}; }}"
    )


def _legend() -> list[str]:
    drawn, x = [], 24.0
    for kind, cached, text in _LEGEND:
        drawn.append(shape(kind, x, 44, cached=cached))
        drawn.append(f'<text class="label" x="{x + 10:g}" y="48">{text}</text>')
        x += 34 + 6.2 * len(text)
    drawn.append(f'<path class="front" d="M{x:g} 44h22"/>')
    drawn.append(f'<text class="label" x="{x + 28:g}" y="48">Pareto front: worth its time</text>')
    return drawn
