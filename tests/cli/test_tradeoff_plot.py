"""The plot of made-up rungs: what lies where."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matplotlib import figure as plots
from matplotlib.lines import Line2D
from matplotlib.text import Text
from msgspec.structs import replace

from satcheck.audit.tradeoff import (
    RUNGS,
    ClimbEnd,
    Figure,
    PairTradeoff,
    Row,
    Times,
    Truth,
    labels_of,
)
from satcheck.cli.formats.plot_style import DARK, FORMS, LIGHT, file_of
from satcheck.cli.formats.tradeoff_plot import draw

TRUTH = Truth("separated", Figure(1.0, 1.0, 1.0), 0.0)


def made(**of_rung: tuple[float, float | None]) -> PairTradeoff:
    """By name: seconds and error of rungs; those that are not named were not run."""
    rows = []
    for rung in RUNGS:
        if rung.name not in of_rung or rung.threshold not in (None, 0.1):
            rows.append(Row(rung=rung, state="not run", reason="budget"))
            continue
        seconds, error = of_rung[rung.name]
        right = None if error is None else error > -1.0
        rows.append(
            Row(
                rung=rung,
                state="answered",
                right=right,
                proven=bool(right),
                error=error,
                cold=Times((seconds,)),
                cached=Times((0.5 * seconds,)) if rung.name == "parts" else None,
            )
        )
    return PairTradeoff("a & <b>", "c", TRUTH, ClimbEnd("exact", True, ""), tuple(rows))


def markers(figure: plots.Figure, panel: int = 0) -> dict[str, Line2D]:
    """By rung; `, cached` behind it for the runs that found something cached."""
    lines = figure.axes[panel].get_lines()
    return {gid: line for line in lines if (gid := line.get_gid()) is not None}


def place(line: Line2D) -> tuple[float, float]:
    (corner,) = corners_of(line)
    return corner


def corners_of(line: Line2D) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in np.asarray(line.get_xydata())]


def words(figure: plots.Figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text) if isinstance(text, Text))


PAIR = made(
    aabb=(1e-4, -4.0), hull=(1e-3, -0.5), parts=(2.0, -0.01), exact=(0.1, 0.0), boolean=(1, None)
)
FRONT = replace(
    PAIR,
    rows=tuple(
        replace(row, on_front=row.rung.name in ("aabb", "hull", "exact")) for row in PAIR.rows
    ),
)
# Three markers that cover each other.
CROWDED = made(aabb=(1e-4, 0.0), obb=(1.1e-4, 0.0), hull=(1.2e-4, 0.0))


def test_slower_is_further_right_and_nearer_is_lower() -> None:
    seen = {label: place(line) for label, line in markers(draw([PAIR])).items()}
    by_time = ["aabb", "hull", "exact", "parts 0.1, cached", "boolean", "parts 0.1"]
    assert sorted(seen, key=lambda label: seen[label][0]) == by_time
    by_error = ["aabb", "hull", "parts 0.1", "exact", "boolean"]
    heights = [seen[label][1] for label in by_error]
    assert heights == sorted(heights, reverse=True)
    assert len(set(heights)) == len(heights)


def test_the_marker_says_whether_the_verdict_is_proven_or_wrong() -> None:
    for palette, figure in ((LIGHT, draw([PAIR])), (DARK, draw([PAIR], dark=True))):
        seen = markers(figure)
        kinds = {label: (line.get_marker(), line.get_color()) for label, line in seen.items()}
        assert kinds == {
            "aabb": ("x", palette.wrong),
            "hull": ("o", palette.proven),
            "parts 0.1": ("o", palette.proven),
            "parts 0.1, cached": ("o", palette.proven),
            "exact": ("o", palette.proven),
            "boolean": ("^", palette.guess),
        }
        assert seen["parts 0.1, cached"].get_markerfacecolor() == palette.paper


def test_a_diamond_is_the_error_of_a_thickness() -> None:
    pair = made(hull=(1e-3, 2.0), exact=(1e-2, 0.0))
    rows = [
        replace(row, thickness_error=0.125 if row.rung.name == "hull" else 0.0)
        if row.state == "answered"
        else row
        for row in pair.rows
    ]
    drawn = markers(draw([replace(pair, rows=tuple(rows))]))
    hull, exact = place(drawn["hull, thickness"]), place(drawn["exact, thickness"])
    assert hull[0] == place(drawn["hull"])[0]
    assert exact == place(drawn["exact"])
    assert exact[1] < hull[1] < place(drawn["hull"])[1]
    assert "hull, thickness" not in markers(draw([pair]))


def test_every_rung_is_named_whatever_became_of_it() -> None:
    for pairs in ([PAIR], [made()], [made(exact=(0.1, 0.0)), PAIR]):
        text = words(draw(pairs))
        for pair in pairs:
            drawn = [row.rung for row in pair.rows if row.state == "answered"]
            assert all(rung.label in text for rung in drawn)
            left_out = labels_of([rung for rung in RUNGS if rung not in drawn])
            assert f"{left_out}: not run, budget" in text
        assert text.count(
            "a & <b> against c: separated, 1 apart; the default settles it by: exact"
        ) == len(pairs)


def test_the_price_of_each_step_is_written_over_the_plot() -> None:
    text = words(draw([FRONT]))
    assert "aabb to hull: 10 times the time, error 4 to 0.5, wrong to proven" in text
    assert "hull to exact: 100 times the time, error 0.5 to 0" in text


def test_the_line_along_the_front_goes_over_to_the_next_rung_and_then_down() -> None:
    figure = draw([FRONT])
    at = {label: place(line) for label, line in markers(figure).items()}
    corners = [at["aabb"], (at["hull"][0], at["aabb"][1]), at["hull"]]
    corners += [(at["exact"][0], at["hull"][1]), at["exact"]]
    assert corners in [corners_of(line) for line in figure.axes[0].get_lines()]


@pytest.mark.parametrize("pair", [FRONT, CROWDED])
def test_labels_overlap_neither_each_other_nor_a_marker(pair: PairTradeoff) -> None:
    figure = draw([pair])
    axes = figure.axes[0]
    names = {row.rung.label for row in pair.rows}
    labels = [text.get_window_extent() for text in axes.texts if text.get_text() in names]
    centres = [axes.transData.transform(place(line)) for line in markers(figure).values()]
    assert len(labels) > 2
    assert not any(box.contains(*centre) for box in labels for centre in centres)
    assert not any(one.overlaps(other) for one, other in combinations(labels, 2))
    assert all(axes.bbox.containsx(end) for box in labels for end in (box.x0, box.x1))


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
