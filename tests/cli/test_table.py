"""The table, rendered from reports made by hand."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.cli.report.table import ROWS, render
from tests.cli import reports
from tests.cli.reports import BOUNDED, PENETRATING, SEPARATED, TOUCHING, UNDECIDED, report

ALL = (PENETRATING, BOUNDED, TOUCHING, SEPARATED, UNDECIDED)
ESCAPES = re.compile(r"\x1b\[[0-9;]*m")


def shown(*findings: object, page: Page = PLAIN_PAGE, **options: bool) -> str:
    return render(
        report(*findings),  # type: ignore[arg-type]
        page,
        explain=options.get("explain", False),
        timings=options.get("timings", True),
    )


def test_a_row_says_it_all() -> None:
    row = next(line for line in shown(PENETRATING).splitlines() if "block_pushed" in line)
    cells = [cell.strip() for cell in row.strip("│").split("│")]
    assert cells == ["block", "block_pushed", "penetrating", "1", "(-1, 0, 0)", "exact", "11.8 us"]


def test_columns_without_content_are_left_out() -> None:
    assert "depth" not in shown(SEPARATED)
    assert "move A by" not in shown(SEPARATED)
    assert "time" not in shown(SEPARATED, timings=False)


def test_bounds_are_shown_outward() -> None:
    assert "1.24123 .. 1.25001" in shown(BOUNDED)


def test_an_unverified_way_out_says_so() -> None:
    assert "not verified" in shown(replace(PENETRATING, mtv_verified=False))


def test_the_touch_band_hides_nothing() -> None:
    assert "block and flush: exactly penetrating, by no more than 2.5e-07" in shown(TOUCHING)


def test_what_is_near_is_separated_without_further_words() -> None:
    assert "exactly" not in shown(replace(SEPARATED, relation="near", distance=0.5))


def test_what_was_not_decided_comes_with_its_reason() -> None:
    assert "block and soup: the time limit was reached" in shown(UNDECIDED)


def test_without_a_terminal_nothing_is_folded_or_coloured() -> None:
    text = shown(replace(PENETRATING, a="x" * 300, b="y" * 300))
    assert "x" * 300 in text
    assert "y" * 300 in text
    assert "…" not in text
    assert "\x1b" not in text


@pytest.mark.parametrize("width", [60, 80, 120])
def test_a_narrow_terminal_folds_between_numbers(width: int) -> None:
    page = Page(width=width, colour=False, unicode=True)
    text = shown(BOUNDED, page=page)
    assert "1.25001" in text
    assert "-1.23457" in text
    if width >= 80:
        assert all(len(line) <= width for line in text.splitlines())


def test_ascii_where_the_encoding_has_no_more() -> None:
    for width in (60, 200):
        page = Page(width=width, colour=False, unicode=False)
        shown(*ALL, page=page, explain=True).encode("ascii")


def test_colour_adds_nothing_but_colour() -> None:
    page = Page(width=120, colour=True, unicode=True)
    coloured = shown(*ALL, page=page)
    assert "\x1b[1;31m" in coloured
    plain = shown(*ALL, page=replace(page, colour=False))
    squeezed = [ESCAPES.sub("", line).rstrip() for line in coloured.splitlines()]
    assert squeezed == plain.splitlines()


def test_many_separated_pairs_are_counted() -> None:
    many = [replace(SEPARATED, id=str(i), b=f"far{i}") for i in range(ROWS)]
    text = shown(PENETRATING, *many)
    assert "block_pushed" in text
    assert "far0" not in text
    assert f"{ROWS} more pairs, all separated" in text


def test_pairs_that_the_report_does_not_list_are_counted() -> None:
    made = report(PENETRATING)
    summary = replace(made.summary, by_relation={"penetrating": 1, "separated": 7})
    text = render(replace(made, summary=summary), PLAIN_PAGE, explain=False, timings=True)
    assert "7 more pairs, all separated" in text


@pytest.mark.parametrize(
    ("units", "head"), [("mm", "depth (mm)"), ("inches", "depth (in)"), ("mm, or so", "depth")]
)
def test_units_are_shown_where_they_are_known(units: str, head: str) -> None:
    text = render(report(PENETRATING, units=units), PLAIN_PAGE, explain=False, timings=True)
    assert head in [cell.strip() for cell in text.splitlines()[1].split("│")]


def test_explain_shows_each_step() -> None:
    text = shown(PENETRATING, explain=True)
    assert "block against block_pushed: penetrating" in text
    assert re.search(r"hull +penetrating +11.5 us +both are convex: nothing finer is needed", text)
    assert re.search(r"soup +1,234 +open, concave, 3 parts", text)


def test_warnings_are_in_the_text_and_errors_are_not() -> None:
    text = render(
        report(SEPARATED, issues=(reports.OPEN, reports.MISSING)),
        PLAIN_PAGE,
        explain=False,
        timings=True,
    )
    assert "warning: soup: 2 open edges: nothing can be inside it [open-mesh]" in text
    assert "gone.obj" not in text
    assert "1 input could not be used." in text


@pytest.mark.parametrize(
    ("findings", "sentence"),
    [
        ((SEPARATED,), "2 bodies, 1 pair: 1 separated. No collision."),
        ((PENETRATING,), "2 bodies, 1 pair: 1 penetrating. Depth 1."),
        (
            (PENETRATING, BOUNDED, UNDECIDED),
            "2 bodies, 3 pairs: 1 penetrating, 1 containing, 1 not decided. "
            "The deepest: a_rather_long_name and another_rather_long_name, 1.24123 .. 1.25001.",
        ),
    ],
)
def test_the_last_line_is_a_sentence(findings: tuple[object, ...], sentence: str) -> None:
    assert shown(*findings).splitlines()[-1] == sentence
