"""The plot of made-up rungs: what lies where."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib import figure as plots
from matplotlib.lines import Line2D
from matplotlib.text import Text
from msgspec.structs import replace

from satcheck.audit.tradeoff import RUNGS
from satcheck.cli.formats.tradeoff_plot import draw
from satcheck.cli.plotting import DARK, FORMS, LIGHT, file_of
from satcheck.report.tradeoff import Row, Times, TradeoffReport, Truth
from satcheck.report.values import Tool


def made(**of_rung: tuple[float, float | None]) -> TradeoffReport:
    """By name: seconds and error of rungs; those that are not named were not run."""
    rows = []
    for rung in RUNGS:
        row = Row(rung=rung.name, threshold=rung.threshold, state="not run", reason="budget")
        if rung.name in of_rung and rung.threshold in (None, 0.1):
            seconds, error = of_rung[rung.name]
            right = None if error is None else error > -1.0
            row = replace(
                row,
                state="answered",
                reason=None,
                right=right,
                proven=bool(right),
                error=error,
                settled_by=rung.name,
                cold=times(seconds),
                cached=times(0.5 * seconds) if rung.name == "parts" else None,
            )
        rows.append(row)
    return TradeoffReport(
        tool=Tool("satcheck", "1"),
        units=None,
        repeat=1,
        budget=1.0,
        seconds=1.0,
        a="a & <b>",
        b="c",
        truth=Truth("separated", (1.0, 1.0), None),
        default=None,
        rungs=tuple(rows),
    )


def times(seconds: float) -> Times:
    return Times(1e6 * seconds, 1e6 * seconds, 1e6 * seconds, 1)


def markers(figure: plots.Figure) -> dict[str, Line2D]:
    """By rung; `, cached` behind it for the runs that found something cached."""
    lines = figure.axes[0].get_lines()
    return {gid: line for line in lines if (gid := line.get_gid()) is not None}


def corners_of(line: Line2D) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in np.asarray(line.get_xydata())]


def words(figure: plots.Figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text) if isinstance(text, Text))


PAIR = made(
    aabb=(1e-4, -4.0), hull=(1e-3, -0.5), parts=(2.0, -0.01), exact=(0.1, 0.0), boolean=(1, None)
)


def test_slower_is_further_right_and_nearer_is_lower() -> None:
    figure = draw([PAIR])
    places = {label: corners_of(line)[0] for label, line in markers(figure).items()}
    assert places == {
        "aabb": (1e2, 4.0),
        "hull": (1e3, 0.5),
        "parts 0.1": (2e6, 0.01),
        "parts 0.1, cached": (1e6, 0.01),
        "exact": (1e5, 0.0),
    }
    axes = figure.axes[0]
    for low, high in ((axes.get_xlim(), axes.get_ylim()),):
        assert low[0] <= 1e2 < 2e6 <= low[1]
        assert high[0] < 0.0 < 4.0 < high[1]


def test_the_marker_says_whether_the_verdict_is_proven_or_wrong() -> None:
    guess = made(hull=(1e-3, -0.5))
    guess = replace(guess, rungs=tuple(replace(row, proven=False) for row in guess.rungs))
    for palette, dark in ((LIGHT, False), (DARK, True)):
        seen = markers(draw([PAIR], dark=dark))
        assert {label: (line.get_marker(), line.get_color()) for label, line in seen.items()} == {
            "aabb": ("x", palette.wrong),
            "hull": ("o", palette.proven),
            "parts 0.1": ("o", palette.proven),
            "parts 0.1, cached": ("o", palette.proven),
            "exact": ("o", palette.proven),
        }
        assert seen["parts 0.1, cached"].get_markerfacecolor() == "none"
        (hull,) = markers(draw([guess], dark=dark)).values()
        assert (hull.get_marker(), hull.get_color()) == ("^", palette.guess)


def test_every_rung_is_named_whatever_became_of_it() -> None:
    left_out = "parts 0.5, parts 0.2, parts 0.05, parts 0.02, parts 0.01: not run, budget"
    text = words(draw([PAIR, made()]))
    for said in ("aabb", "hull", "exact", "parts 0.1", "boolean: 1 s, verdict only"):
        assert said in text.splitlines()
    assert f"obb, {left_out}" in text
    assert text.count("a & <b> against c: proven separated, gap 1") == 2


def test_of_convex_parts_the_coarsest_and_the_finest_are_named() -> None:
    parts = made(parts=(2.0, -0.01))
    rows = [
        replace(parts.rungs[5], threshold=row.threshold) if row.rung == "parts" else row
        for row in parts.rungs
    ]
    drawn = draw([replace(parts, rungs=tuple(rows))])
    assert len(markers(drawn)) == 2 * 6
    named = [label.get_text() for label in drawn.axes[0].texts]
    assert named == ["parts 0.5", "parts 0.01"]


def test_a_rung_that_says_what_a_lower_one_has_proven_is_not_drawn_again() -> None:
    settled = {"aabb": "aabb", "obb": "aabb", "hull": "hull", "exact": "hull"}
    pair = made(aabb=(1e-4, 0.5), obb=(2e-4, 0.5), hull=(1e-3, 0.0), exact=(0.1, 0.25))
    rows = [
        replace(row, settled_by=settled.get(row.rung), signed_distance=row.error)
        for row in pair.rungs
    ]
    assert set(markers(draw([replace(pair, rungs=tuple(rows))]))) == {"aabb", "hull", "exact"}


def test_any_name_can_be_drawn() -> None:
    odd = "$x^ \\frac{ \n \udcff \x1b[31m " + 200 * "long "
    text = words(draw([replace(PAIR, a=odd)]))
    assert "$x^ \\frac{" in text
    assert len(max(text.splitlines(), key=len)) < 120


@pytest.mark.parametrize("form", FORMS)
def test_files_are_the_same_every_time(form: str) -> None:
    once, again = (file_of(draw([PAIR]), form) for _ in range(2))
    assert once == again
    assert once[:5] in (b"<?xml", b"\x89PNG\r", b"%PDF-")
