"""The table, rendered from reports made by hand."""

from __future__ import annotations

import re

import pytest
from msgspec.structs import replace

from satcheck.audit import Component, Components, Contacts
from satcheck.audit.settings import LISTED_PAIRS
from satcheck.cli.formats.table import groups_of, render
from satcheck.cli.formats.tables import broken
from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.report.report import (
    Finding,
    RuleReport,
)
from tests.cli import reports
from tests.cli.reports import (
    BOUNDED,
    CONTACTS,
    CROSSING,
    PENETRATING,
    SEPARATED,
    SWEPT,
    THICK,
    TOUCHING,
    UNDECIDED,
    report,
)
from tests.cli.shown import ESCAPES, shown

ALL = (PENETRATING, BOUNDED, TOUCHING, SEPARATED, UNDECIDED)


BOLD_RED = "\x1b[1;31m"


def test_a_row_says_it_all() -> None:
    row = next(line for line in shown(PENETRATING).splitlines() if "block_pushed" in line)
    cells = [cell.strip() for cell in row.strip("│").split("│")]
    assert cells == ["block", "block_pushed", "penetrating", "1", "(-1, 0, 0)"]


def test_the_thickest_overlaps_come_first() -> None:
    thin = replace(THICK, b="thin", thickness=0.25, thickness_bounds=(0.25, 0.25))
    lines = shown(SEPARATED, thin, TOUCHING, BOUNDED, THICK).splitlines()
    names = [line.strip("│").split("│")[1].strip() for line in lines if line.startswith("│")]
    assert names[1:] == [BOUNDED.b, "block_pushed", "thin", "flush", "far"]
    cells = [line.strip("│").split("│")[3].strip() for line in lines if line.startswith("│")]
    assert cells == ["thickness", "not asked", "0.5", "0.25", "", ""]


def test_figures_of_swept_pairs_are_those_as_placed() -> None:
    swept = replace(CROSSING, motion=SWEPT.motion, placed_relation="penetrating", volume=0.5)
    head = next(line for line in shown(swept).splitlines() if "relation" in line)
    assert "volume as placed" in head
    assert "contact as placed" in head
    assert "as placed" not in shown(CROSSING)


def test_columns_without_content_are_left_out() -> None:
    assert "depth" not in shown(SEPARATED)
    assert "move A by" not in shown(SEPARATED)
    assert "quality" not in shown(PENETRATING, UNDECIDED)
    assert "quality" in shown(PENETRATING, BOUNDED)
    assert "severity" not in shown(*ALL)
    assert "time" not in shown(SEPARATED)


def test_the_time_of_a_pair_is_part_of_the_explanation() -> None:
    assert "11.8 us" in shown(PENETRATING, explain=True)
    assert " us" not in shown(PENETRATING, explain=True, timings=False)


def test_contacts_in_a_few_words() -> None:
    assert "1 patch of area 1, 1 loop of length 4, 1 point" in shown(CROSSING)
    assert "none" in shown(replace(CROSSING, contacts=Contacts()))
    cut = replace(CONTACTS, curves=(), truncated=True)
    assert "1 curve of length 4" in shown(replace(CROSSING, contacts=cut))
    assert "contact" not in shown(PENETRATING)


def test_components_below_the_table() -> None:
    thick = Component(
        bounds=((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        point=(0.5, 0.5, 0.0),
        thickness_bounds=(0.25, 0.5),
        volume=0.125,
        curves=2,
        curve_length=8.0,
        passes="both",
        resolved=True,
    )
    thin = replace(thick, point=(0.5, 0.5, 1.0), thickness_bounds=(0.0, 0.1), passes=None)
    text = shown(replace(CROSSING, components=Components((thick, *[thin] * 9), False)))
    a, b = CROSSING.a, CROSSING.b
    assert f"{a} and {b}: 10 connected overlaps, perhaps not all" in text
    first = f"  0.25 .. 0.5 thick, at (0.5, 0.5, 0), volume 0.125, {a} passes through {b}, "
    assert first + f"{b} passes through {a}\n" in text
    assert text.count("  <= 0.1 thick, at (0.5, 0.5, 1), volume 0.125\n") == 7
    assert "  2 thinner ones\n" in text


def test_a_volume_that_was_asked_for() -> None:
    text = shown(CROSSING, SEPARATED)
    assert "volume" in text
    assert "0.328125" in text
    assert "volume" not in shown(SEPARATED)


def test_bounds_are_shown_outward() -> None:
    assert "1.24123 .. 1.25001" in shown(BOUNDED)


def test_an_unverified_way_out_says_so() -> None:
    assert "not verified" in shown(replace(PENETRATING, mtv_verified=False))


def test_the_touch_band_hides_nothing() -> None:
    line = "block and flush {}, but by no more than the tolerance 2.5e-07"
    assert line.format("overlap") in shown(TOUCHING)
    assert line.format("are apart") in shown(replace(TOUCHING, exact_relation="separated"))


def test_what_is_near_is_separated_without_further_words() -> None:
    assert "tolerance" not in shown(replace(SEPARATED, relation="near", distance=0.5))


def test_what_was_not_decided_comes_with_its_reason() -> None:
    assert "block and soup: the time limit was reached" in shown(UNDECIDED)


def test_without_a_terminal_nothing_is_folded_or_coloured() -> None:
    text = shown(replace(PENETRATING, a="x" * 300, b="y" * 300))
    assert "x" * 300 in text
    assert "y" * 300 in text
    assert "…" not in text
    assert "\x1b" not in text


@pytest.mark.parametrize("width", [20, 60, 80, 100, 120])
def test_a_narrow_terminal_cuts_nothing(width: int) -> None:
    text = shown(BOUNDED, page=Page(width=width, colour=False, unicode=True))
    for word in ("contains", "1.24123", "1.25001", "0.12346", "-1.23457", "0.45679", "depth"):
        assert word in text
    assert "…" not in text
    if width >= 60:
        assert all(len(line) <= width for line in text.splitlines())


def test_a_terminal_too_narrow_for_a_table_gets_paragraphs() -> None:
    heads = {}
    for width in (130, 80, 60):
        table = shown(BOUNDED, page=Page(width=width, colour=False, unicode=True))
        heads[width] = ("│" in table, "relation" in table, "quality" in table)
    assert heads[130] == (True, True, True)
    assert heads[80] == (False, True, True)
    assert heads[60] == (False, False, True)
    assert "a_rather_long_name and another_rather_long_name: contains\n" in table
    assert "  depth: 1.24123 .. 1.25001\n" in table


def test_a_severity_that_a_rule_sets_is_a_column_and_the_colour() -> None:
    allowed = replace(PENETRATING, severity="note", rule="cell.toml:3")
    known = replace(BOUNDED, baseline_state="unchanged")
    page = Page(width=200, colour=True, unicode=True)
    text = shown(allowed, known, page=page)
    assert "error, known" in text
    assert BOLD_RED not in text
    assert BOLD_RED in shown(PENETRATING, page=page)


def test_pairs_of_the_same_parts_stand_together_behind_a_rule() -> None:
    def pair(a: str, b: str, depth: float) -> Finding:
        return replace(PENETRATING, a=a, b=b, depth=depth, depth_bounds=(depth, depth))

    text = shown(pair("hand/x", "box", 1), pair("arm", "box", 2), pair("hand/y", "box", 3))
    rows = text.splitlines()[3:-3]
    assert [row.split()[1] for row in rows if "box" in row] == ["hand/y", "hand/x", "arm"]
    assert "─" in rows[2]


def test_top_takes_the_worst_before_parts_are_grouped() -> None:
    pairs = [
        replace(PENETRATING, a=a, b="box", depth=depth, depth_bounds=(depth, depth))
        for a, depth in (("hand/x", 3.0), ("hand/y", 1.0), ("arm", 2.0))
    ]
    text = render(report(*pairs), PLAIN_PAGE, explain=False, timings=True, top=2)
    assert "arm" in text
    assert "hand/y │" not in text
    assert (
        "FAIL: hand/x and box overlap (3 to pull apart); arm and box overlap (2 to pull apart); "
        "hand/y" in text
    )


def test_pairs_of_parts_are_grouped_in_either_order() -> None:
    turned = replace(PENETRATING, a="box", b="hand/x", depth=1.0, depth_bounds=(1.0, 1.0))
    third = replace(PENETRATING, a="hand/y", b="box", depth=0.5, depth_bounds=(0.5, 0.5))
    between = replace(PENETRATING, a="arm", b="box", depth=0.75, depth_bounds=(0.75, 0.75))
    rows = [row for row in shown(turned, between, third).splitlines() if row.startswith("│")]
    assert ["hand/y" in row for row in rows[1:]] == [False, True, False]


def test_elements_of_two_files_are_groups_of_their_own() -> None:
    pairs = [replace(PENETRATING, a=f"house/{k}", b=f"pipes/{k}") for k in range(2)]
    assert len(groups_of(pairs)) == 1
    assert len(groups_of(pairs, {"house/0", "house/1", "pipes/0", "pipes/1"})) == 2


def test_rules_that_share_a_line_are_not_taken_for_each_other() -> None:
    rule = RuleReport(
        a="*",
        b="*",
        allowed=None,
        max_depth=4.0,
        max_thickness=None,
        max_volume=None,
        clearance=None,
        tolerance=None,
        severity=None,
        reason="press fits",
        where="cell.json:1",
    )
    finding = replace(PENETRATING, severity="note", rule="cell.json:1")
    one, two = (
        render(replace(report(finding), rules=rules), PLAIN_PAGE, explain=False, timings=True)
        for rules in ((rule,), (rule, replace(rule, max_depth=1.0)))
    )
    assert "note by cell.json:1, max_depth 4 (press fits)" in one
    assert "note by cell.json:1\n" in two


def test_top_limits_rows_and_nothing_else() -> None:
    made = report(PENETRATING, BOUNDED, UNDECIDED)
    text = render(made, PLAIN_PAGE, explain=False, timings=True, top=1)
    assert "block_pushed │" not in text
    assert "2 more pairs not shown (--top 1)" in text
    assert "1 penetrating, 1 containing, 1 indeterminate" in text
    assert f"{PENETRATING.a} and {PENETRATING.b} overlap (1 to pull apart)" in text


@pytest.mark.parametrize(
    ("name", "width", "lines"),
    [
        ("l_bracket", 6, "l_\nbracke\nt"),
        ("peg_in_arm", 8, "peg_in_\narm"),
        ("rod", 8, "rod"),
        ("歯車_a", 5, "歯車_\na"),
    ],
)
def test_names_are_broken_after_a_separator(name: str, width: int, lines: str) -> None:
    assert broken(name, width) == lines


def test_ascii_where_the_encoding_has_no_more() -> None:
    for width in (60, 200):
        page = Page(width=width, colour=False, unicode=False)
        shown(*ALL, page=page, explain=True).encode("ascii")


def test_colour_adds_nothing_but_colour() -> None:
    page = Page(width=120, colour=True, unicode=True)
    coloured = shown(*ALL, page=page)
    assert "\x1b[1;31m" in coloured
    plain = shown(*ALL, page=Page(width=120, colour=False, unicode=True))
    squeezed = [ESCAPES.sub("", line).rstrip() for line in coloured.splitlines()]
    assert squeezed == plain.splitlines()


def test_many_separated_pairs_are_counted() -> None:
    many = [replace(SEPARATED, id=str(i), b=f"far{i}") for i in range(LISTED_PAIRS)]
    text = shown(PENETRATING, *many)
    assert "block_pushed" in text
    assert "far0" not in text
    assert f"{LISTED_PAIRS} more pairs, all separated" in text


def test_what_hits_on_the_way_is_shown_among_many() -> None:
    many = [replace(SEPARATED, id=str(i), b=f"far{i}") for i in range(LISTED_PAIRS)]
    text = shown(reports.HIT, *many)
    assert "passer" in text
    assert f"{LISTED_PAIRS} more pairs, all separated" in text


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
    assert re.search(r"soup +soup.stl: 1,234 triangles, not closed, concave", text)
    assert "3 convex parts: they stick out of the mesh by at most 0.25, and the mesh" in text
