"""The table, rendered from reports made by hand."""

from __future__ import annotations

import re
from itertools import takewhile

import pytest
from msgspec.structs import replace

from satcheck.cli.formats.table import render
from satcheck.cli.formats.tables import ROWS, broken
from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.report.contacts import Component, Components, Contacts
from satcheck.report.part_pairs import PartPair, PartPairs
from satcheck.report.report import (
    Finding,
    RuleReport,
)
from tests.cli.reports import (
    BLOCK,
    BOUNDED,
    CONTACTS,
    CROSSING,
    HIT,
    PENETRATING,
    SEPARATED,
    SWEPT,
    THICK,
    TOUCHING,
    UNDECIDED,
    report,
)
from tests.cli.shown import ESCAPES, shown

WIDE = Page(width=200, colour=False, unicode=True)
ALL = (PENETRATING, BOUNDED, TOUCHING, SEPARATED, UNDECIDED)


BOLD_RED = "\x1b[1;31m"


def rows(text: str) -> list[list[str]]:
    """The head and the rows of a table whose cells fit into a line."""
    lines = text.splitlines()
    rule = next(k for k, line in enumerate(lines) if set(line) == {"─"})
    table = [lines[rule - 1], *lines[rule + 1 :]]
    cells = [re.split(r" {2,}", line.strip()) for line in table]
    return list(takewhile(lambda row: len(row) > 1, cells))


def test_a_row_says_it_all() -> None:
    assert rows(shown(PENETRATING))[1:] == [
        ["block", "block_pushed", "penetrating", "1", "(-1, 0, 0)"]
    ]


def test_the_thickest_overlaps_come_first() -> None:
    thin = replace(THICK, b="thin", thickness=0.25, thickness_bounds=(0.25, 0.25))
    text = shown(SEPARATED, thin, TOUCHING, BOUNDED, THICK, explain=True, page=WIDE)
    head, *found = rows(text)
    assert [row[1] for row in found] == [BOUNDED.b, "block_pushed", "thin", "flush", "far"]
    assert head[3] == "thickness"
    assert [row[3] for row in found[:3]] == ["not asked", "0.5", "0.25"]


def test_only_findings_are_rows() -> None:
    text = shown(*ALL)
    assert [row[1] for row in rows(text)[1:]] == [BOUNDED.b, "block_pushed", "soup"]
    assert "\n1 separated, 1 touching pairs not shown\n" in text
    assert len(rows(shown(*ALL, explain=True, page=WIDE))) == 6


@pytest.mark.parametrize("alone", [TOUCHING, SEPARATED])
def test_a_pair_that_is_alone_has_a_row(alone: Finding) -> None:
    text = shown(alone)
    assert [row[1] for row in rows(text)[1:]] == [alone.b]
    assert "not shown" not in text


def test_what_is_allowed_or_known_passes() -> None:
    allowed = replace(PENETRATING, severity="note", rule="cell.toml:3")
    known = replace(BOUNDED, baseline_state="unchanged")
    text = shown(allowed, known, UNDECIDED)
    assert len(rows(text)) == 2
    assert "\n1 allowed, 1 known pairs not shown\n" in text


def test_figures_that_were_asked_for_are_shown_of_pairs_that_pass() -> None:
    made = report(replace(TOUCHING, contacts=CONTACTS), SEPARATED)
    made = replace(made, settings=replace(made.settings, contacts=True))
    text = render(made, WIDE, explain=False, timings=False)
    assert [row[1] for row in rows(text)[1:]] == ["flush"]


def test_a_root_that_all_names_share_is_said_once() -> None:
    names = {"hall/shelf/a": "hall/box", "hall/shelf/b": "hall/lid"}
    pairs = [replace(THICK, id=a, a=a, b=b) for a, b in names.items()]
    bodies = tuple(replace(BLOCK, id=name, name=name) for pair in names.items() for name in pair)
    text = render(report(*pairs, bodies=bodies), PLAIN_PAGE, explain=False, timings=False)
    assert [row[:2] for row in rows(text)[1:]] == [["shelf/a", "box"], ["shelf/b", "lid"]]
    assert text.count("hall/") == 1
    assert "\nAll names begin with hall/\n" in text
    assert "; worst: shelf/a and box overlap" in text


def test_more_rows_than_a_person_reads_are_counted() -> None:
    many = [replace(THICK, id=str(k), b=f"block{k}") for k in range(ROWS + 5)]
    text = shown(*many)
    assert len(rows(text)) == ROWS + 1
    assert "\n5 more pairs not shown: see --top\n" in text


def test_figures_of_swept_pairs_are_those_as_placed() -> None:
    swept = replace(CROSSING, motion=SWEPT.motion, placed_relation="penetrating", volume=0.5)
    head = next(line for line in shown(swept).splitlines() if "relation" in line)
    assert "volume as placed" in head
    assert "contact as placed" in head
    assert "as placed" not in shown(CROSSING)


def test_columns_without_content_are_left_out() -> None:
    assert "depth" not in shown(SEPARATED)
    assert "move A by" not in shown(SEPARATED)
    assert "quality" not in shown(PENETRATING, BOUNDED)
    assert "quality" in shown(PENETRATING, BOUNDED, explain=True, page=WIDE)
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
    made = replace(CROSSING, components=Components((thick, *[thin] * 9), False))
    text = shown(made, asked="components")
    a, b = CROSSING.a, CROSSING.b
    assert f"{a} and {b}: 10 connected overlaps, perhaps not all" in text
    first = f"  0.375 ±0.125 thick, at (0.5, 0.5, 0), volume 0.125, {a} passes through {b}, "
    assert first + f"{b} passes through {a}\n" in text
    assert text.count("  <= 0.1 thick, at (0.5, 0.5, 1), volume 0.125\n") == 7
    assert "  2 thinner ones\n" in text


def test_parts_below_the_table() -> None:
    deep = PartPair("block#2", "peg#1", "penetrating", 0.31, (0.0, 0.6, 0.8), "gjk+epa", 0, 7)
    flush = PartPair("block#1", "peg#1", "touching", 0.0, (1.0, 0.0, 0.0), "exact", 15, 0)
    remark = "no parts overlap where the bodies do; peg sticks out of its parts by up to 1"
    made = PartPairs((2, 1), (deep, flush), 1, 0, 1)
    finding = replace(SEPARATED, b="peg", part_pairs=made)
    text = shown(finding, page=WIDE, asked="parts")
    assert "\nblock (2 convex parts) and peg (1): 1 pair of parts overlaps\n" in text
    assert (
        "\n  block#2 x peg#1  penetrating  depth 0.31  axis (0, 0.6, 0.8)  gjk+epa, 7 iterations\n"
        "  block#1 x peg#1  touching                 axis (1, 0, 0)      exact, 15 axes\n"
    ) in text
    many = replace(made, pairs=(deep,) * 9 + (flush,), overlapping=3_000, untested=2, remark=remark)
    text = shown(replace(finding, part_pairs=many), page=WIDE, asked="parts")
    assert "peg (1): 3,000 pairs of parts overlap\n" in text
    assert text.count("block#2 x peg#1") == 8
    assert f"\n  2,993 more pairs\n  2 pairs of parts not tested\n  {remark}\n" in text
    untested = replace(finding, part_pairs=PartPairs((2, 1), untested=2))
    assert "peg (1): no overlap of parts was found\n" in shown(untested, page=WIDE, asked="parts")
    none = PartPairs(remark="no convex parts: a half space has no end: peg")
    without = replace(finding, part_pairs=none)
    assert "\nno convex parts: a half space has no end: peg\n" in shown(
        without, page=WIDE, asked="parts"
    )
    clear = replace(PENETRATING, part_pairs=PartPairs((2, 1)))
    text = shown(without, replace(without, a="ball"), finding, clear, page=WIDE, asked="parts")
    assert "\n1 pair with no parts that overlap\n" in text
    assert text.count("a half space has no end: peg (2 pairs)\n") == 1
    assert "peg" in shown(TOUCHING, finding, asked="parts")
    clear = replace(finding, part_pairs=PartPairs((2, 1)))
    assert "peg" not in shown(TOUCHING, clear, asked="parts")


def test_parts_have_the_names_of_the_table() -> None:
    pair = PartPair("a/b#1#2", "a/c#1", "penetrating", 1.0, (1.0, 0.0, 0.0), "sat", 15, 0)
    named = replace(PENETRATING, a="a/b#1", b="a/c", part_pairs=PartPairs((2, 1), (pair,), 1))
    text = shown(named, page=WIDE, asked="parts")
    assert "  a/b#1#2 x a/c#1  penetrating  depth 1  axis (1, 0, 0)  sat, 15 axes\n" in text


def test_a_volume_that_was_asked_for() -> None:
    text = shown(CROSSING, SEPARATED)
    assert "volume" in text
    assert "0.328" in text
    assert "volume" not in shown(SEPARATED)


def test_bounds_are_shown_outward() -> None:
    assert "1.25 ±0.01" in shown(BOUNDED)


def test_an_unverified_way_out_says_so() -> None:
    assert "not verified" in shown(replace(PENETRATING, mtv_verified=False))


def test_the_touch_band_hides_nothing() -> None:
    line = "block and flush: {}, but by no more than the tolerance 2.5e-07"
    assert line.format("overlapping") in shown(TOUCHING)
    assert line.format("apart") in shown(replace(TOUCHING, exact_relation="separated"))


def test_what_is_near_is_separated_without_further_words() -> None:
    assert "tolerance" not in shown(replace(SEPARATED, relation="near", distance=0.5))


def test_what_was_not_decided_comes_with_its_reason() -> None:
    assert "block and soup: the time limit was reached" in shown(UNDECIDED)


def test_nothing_is_wider_than_the_page() -> None:
    text = shown(replace(PENETRATING, a="й" * 300, b="ж" * 300))
    assert all(len(line) <= PLAIN_PAGE.width for line in text.splitlines())
    rows, fails, last = text.partition("FAIL")
    assert rows.count("й") == rows.count("ж") == 300
    assert "…" not in rows
    assert fails
    assert last.count("…") == 2  # the names once more, by their ends
    assert "\x1b" not in text


@pytest.mark.parametrize("width", [20, 60, 80, 100, 120])
def test_a_narrow_terminal_cuts_nothing(width: int) -> None:
    text = shown(BOUNDED, page=Page(width=width, colour=False, unicode=True))
    for word in ("contains", "1.25", "±0.01", "0.12", "-1.23", "0.46", "depth"):
        assert word in text
    assert "…" not in text
    assert all(len(line) <= width for line in text.splitlines())


def test_a_terminal_too_narrow_for_a_table_gets_paragraphs() -> None:
    tables = {w: shown(BOUNDED, page=Page(width=w, colour=False, unicode=True)) for w in (80, 40)}
    assert "─" in tables[80]
    assert "─" not in tables[40]
    assert "  relation: contains\n" in tables[40]
    assert "  depth: 1.25 ±0.01\n" in tables[40]


def test_a_severity_that_a_rule_sets_is_a_column_and_the_colour() -> None:
    allowed = replace(PENETRATING, severity="note", rule="cell.toml:3")
    known = replace(BOUNDED, baseline_state="unchanged")
    page = Page(width=200, colour=True, unicode=True)
    text = shown(allowed, known, page=page, explain=True)
    assert "error, known" in text
    assert BOLD_RED not in text
    assert BOLD_RED in shown(PENETRATING, page=page)


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
    assert len(rows(text)) == 2
    assert "2 more pairs not shown: see --top" in text
    assert "1 penetrating, 1 containing, 1 indeterminate" in text
    assert "FAIL: 2 of 3 pairs overlap" in text


@pytest.mark.parametrize(
    ("name", "width", "lines"),
    [
        ("l_bracket", 7, "l_\n bracke\n t"),
        ("peg_in_arm", 8, "peg_in_\n arm"),
        ("rod", 8, "rod"),
        ("歯車_a", 6, "歯車_a"),
        ("歯車_ab", 6, "歯車_\n ab"),
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


def test_pairs_that_the_report_does_not_list_are_counted() -> None:
    made = report(PENETRATING)
    summary = replace(made.summary, by_relation={"penetrating": 1, "separated": 7})
    text = render(replace(made, summary=summary), PLAIN_PAGE, explain=False, timings=True)
    assert "\n7 separated pairs not shown\n" in text


@pytest.mark.parametrize(
    ("units", "head"), [("mm", "depth (mm)"), ("inches", "depth (in)"), ("mm, or so", "depth")]
)
def test_units_are_shown_where_they_are_known(units: str, head: str) -> None:
    text = render(report(PENETRATING, units=units), PLAIN_PAGE, explain=False, timings=True)
    assert head in rows(text)[0]


def test_explain_shows_each_step() -> None:
    text = shown(PENETRATING, explain=True)
    assert "block against block_pushed: penetrating" in text
    assert re.search(r"hull +penetrating +11.5 us +both are convex: nothing finer is needed", text)
    assert re.search(r"soup +soup.stl: 1,234 triangles, not closed, concave", text)
    assert "3 convex parts: they stick out of the mesh by at most 0.25, and the mesh" in text


def test_bodies_that_overlap_on_a_whole_way_do_so_throughout() -> None:
    text = render(report(HIT, PENETRATING), PLAIN_PAGE, explain=False, timings=True)
    assert sorted(row[-1] for row in rows(text)[1:]) == ["hits at", "throughout"]
    assert "throughout" not in render(report(PENETRATING), PLAIN_PAGE, explain=False, timings=True)
