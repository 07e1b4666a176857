"""The table, rendered from reports made by hand."""

from __future__ import annotations

import re

import pytest
from msgspec.structs import replace

from satcheck.audit import Component, Components, Contacts
from satcheck.audit.request.settings import LISTED_PAIRS
from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.cli.report.columns import broken
from satcheck.cli.report.order import groups_of
from satcheck.cli.report.table import render
from satcheck.report.report import (
    INTERNAL_ERROR,
    NOTHING_TO_CHECK,
    Exempt,
    Finding,
    Issue,
    RuleReport,
    Stage,
)
from satcheck.report.sweep import Place, Sweep
from tests.cli import reports
from tests.cli.reports import (
    BOUNDED,
    CONTACTS,
    CROSSING,
    ESTIMATE,
    HIT,
    PENETRATING,
    SEPARATED,
    SWEEP,
    SWEPT,
    THICK,
    TOUCHING,
    UNDECIDED,
    report,
)

ALL = (PENETRATING, BOUNDED, TOUCHING, SEPARATED, UNDECIDED)
BOLD_RED = "\x1b[1;31m"
UNMEASURED = replace(PENETRATING, b="other", depth=None, depth_bounds=None)
WAY = Sweep(
    relation="penetrating",
    tolerance=0.0,
    reached=0.5,
    time_of_impact=(0.25, 0.5),
    at=(Place("passer", "degrees", 60.0),),
)
HIT_AT_60 = replace(HIT, motion=WAY)
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
    assert "FAIL: hand/x and box overlap (depth 3); arm and box overlap (depth 2); hand/y" in text


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
    assert f"{PENETRATING.a} and {PENETRATING.b} overlap (depth 1)" in text


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


def test_warnings_are_in_the_text_and_errors_are_not() -> None:
    text = render(
        report(SEPARATED, issues=(reports.OPEN, reports.MISSING)),
        PLAIN_PAGE,
        explain=False,
        timings=True,
    )
    assert "warning: soup: 1 hole, 2 across: there, nothing is inside [not-closed]" in text
    assert "gone.obj" not in text
    assert text.endswith("\nERROR: 1 input could not be used.\n")


@pytest.mark.parametrize(
    ("findings", "lines"),
    [
        ((SEPARATED,), ("2 bodies, 1 pair: 1 separated.", "PASS: no collision.")),
        (
            (THICK,),
            (
                "2 bodies, 1 pair: 1 penetrating.",
                "FAIL: block and block_pushed overlap (thickness 0.5, depth 1). "
                "Next: -o report.html shows it in 3-D.",
            ),
        ),
        (
            (THICK, BOUNDED, UNMEASURED, UNDECIDED, HIT),
            (
                "2 bodies, 5 pairs: 3 penetrating, 1 containing, 1 indeterminate. "
                "1 pair hits while moving.",
                "FAIL: block and other overlap; "
                "a_rather_long_name contains another_rather_long_name (depth 1.24123 .. 1.25001); "
                "block and block_pushed overlap (thickness 0.5, depth 1); and 1 more pair. "
                "1 pair is indeterminate. Next: --depth measures the overlaps.",
            ),
        ),
        (
            (replace(SEPARATED, severity="error", relation="near", distance=0.5),),
            (
                "2 bodies, 1 pair: 1 near.",
                "FAIL: block and far are 0.5 apart. Next: -o report.html shows it in 3-D.",
            ),
        ),
        (
            (HIT_AT_60,),
            (
                "2 bodies, 1 pair: 1 penetrating. 1 pair hits while moving.",
                "FAIL: block and passer, while they move: hits at 60 deg. "
                "Next: -o report.html shows it in 3-D.",
            ),
        ),
        (
            (UNDECIDED,),
            (
                "2 bodies, 1 pair: 1 indeterminate.",
                "INCOMPLETE: no collision was found, but 1 pair is indeterminate. Next: "
                "close the holes, or give --allow-open if they are meant to be open.",
            ),
        ),
        (
            (
                SWEPT,
                replace(
                    SWEPT,
                    severity="warning",
                    undecided="inside",
                    motion=replace(SWEEP, reason="what fills the holes ..."),
                ),
            ),
            (
                "2 bodies, 2 pairs: 2 separated.",
                "INCOMPLETE: no collision was found, "
                "but 1 pair moves past holes that may be filled. Next: --explain shows the steps.",
            ),
        ),
        (
            (replace(SWEPT, severity="warning", undecided="limit", rule="clearance"),),
            (
                "2 bodies, 1 pair: 1 separated.",
                "INCOMPLETE: no collision was found, but 1 pair may be closer than its clearance. "
                "Next: --explain shows the steps.",
            ),
        ),
        (
            (replace(ESTIMATE, severity="warning", undecided="relation"),),
            (
                "2 bodies, 1 pair: 1 possibly penetrating.",
                "INCOMPLETE: no collision was found, but 1 pair is indeterminate. "
                "Next: --explain shows the steps.",
            ),
        ),
        (
            (replace(ESTIMATE, severity="note", rule="cell.toml:3"),),
            (
                "2 bodies, 1 pair: 1 overlapping in a way that is not proven.",
                "PASS: no collision beyond what rules allow.",
            ),
        ),
        (
            (replace(PENETRATING, severity="warning", undecided="limit", rule="cell.toml:3"),),
            (
                "2 bodies, 1 pair: 1 penetrating.",
                "INCOMPLETE: no collision beyond what rules allow was found, "
                "but 1 pair may exceed its limits. Next: a larger --depth-budget may decide it.",
            ),
        ),
    ],
)
def test_the_last_lines_are_counts_and_a_verdict(
    findings: tuple[object, ...], lines: tuple[str, str]
) -> None:
    assert tuple(shown(*findings).splitlines()[-2:]) == lines


def test_many_overlaps_ask_for_rules() -> None:
    many = [replace(THICK, b=f"block{k}") for k in range(11)]
    assert "Next: satcheck suggest proposes rules" in shown(*many)


def test_what_hulls_cannot_prove_asks_for_accuracy() -> None:
    made = report(ESTIMATE)
    made = replace(made, settings=replace(made.settings, accuracy="hull"))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "FAIL: block and perhaps possibly overlap (depth at most 2). Next: --accuracy" in text


def test_an_internal_error_is_no_unusable_input() -> None:
    fault = Issue(INTERNAL_ERROR, "error", None, None, "block and soup: internal error: ...")
    made = report(UNDECIDED, issues=(fault,))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "1 pair is indeterminate; 1 pair failed by an internal error. Next" in text
    made = replace(made, issues=(fault, reports.MISSING))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "; 1 input could not be used; 1 pair failed by an internal error. Next" in text


def test_opinions_that_could_not_be_had_are_told_once() -> None:
    silent = Stage("cross-check", "no answer", 1.0, "python-fcl: it did not answer in 30 s")
    pairs = [replace(PENETRATING, id=str(k), plan=(*PENETRATING.plan, silent)) for k in range(2)]
    text = shown(*pairs)
    assert text.count("python-fcl") == 1
    assert "cross-check: no answer on 2 pairs: python-fcl: it did not answer in 30 s\n" in text


def test_no_pair_checked_is_no_verdict() -> None:
    made = report()
    pairs = replace(made.summary.pairs, total=3, allowed=3)
    why = Issue(NOTHING_TO_CHECK, "warning", None, None, "no pair was checked: 3 allowed by rules")
    summary = replace(made.summary, verdict="incomplete", pairs=pairs)
    made = replace(made, summary=summary, issues=(why,))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    last = "INCOMPLETE: No pair was checked: 3 allowed by rules.\n"
    assert text.endswith(f"\n2 bodies, 3 pairs.\n{last}")


@pytest.mark.parametrize(
    ("static", "exempt", "said"),
    [
        (2, 1, "1 separated; 1 pair exempt (static)."),
        (0, 3, "1 separated; 3 pairs exempt (within ignored groups)."),
        (2, 3, "1 separated; 3 pairs exempt (1 static, 2 within ignored groups)."),
    ],
)
def test_exempt_pairs_are_counted_apart(static: int, exempt: int, said: str) -> None:
    made = report(SEPARATED)
    pairs = replace(made.summary.pairs, exempt=exempt)
    bodies = tuple(replace(body, static=k < static) for k, body in enumerate(made.bodies))
    made = replace(made, summary=replace(made.summary, pairs=pairs), bodies=bodies)
    made = replace(made, exempt=Exempt(static_pairs=True))
    assert said in render(made, PLAIN_PAGE, explain=False, timings=True)


def test_one_line_a_body_with_holes() -> None:
    hollow = replace(SWEEP, reason="what fills the holes ...")
    past = replace(SWEPT, severity="warning", undecided="inside", motion=hollow)
    text = shown(*(replace(past, a=f"far{i}", b="soup") for i in range(3)))
    assert "soup has holes: 3 pairs move past them, and they may be filled\n" in text
    assert "but 3 pairs move past holes that may be filled." in text


def test_what_is_not_proven_is_called_possible() -> None:
    made = report(PENETRATING, ESTIMATE)
    made = replace(made, settings=replace(made.settings, accuracy="aabb"))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "1 penetrating, 1 possibly penetrating (not proven at --accuracy aabb)." in text
    assert "<= 2" in text
    assert text.count("not proven") == 1


def test_pairs_of_an_unreadable_body_are_no_rows() -> None:
    lost = replace(reports.BLOCK, id="gone", triangles=None, health=None)
    undecided = replace(UNDECIDED, b="gone", reason="unreadable gone.obj: file-not-found")
    made = report(SEPARATED, undecided, bodies=(reports.BLOCK, lost), issues=(reports.MISSING,))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "file-not-found" not in text
    assert "gone: could not be used, its 1 pair not checked" in text


@pytest.mark.parametrize("colour", [False, True])
@pytest.mark.parametrize("name", ["a\x1b[2A\x1b[2K", "\u202eb", "c\x0b\x85d", "\ud800"])
def test_a_name_gives_a_terminal_no_orders(name: str, colour: bool) -> None:
    page = Page(width=PLAIN_PAGE.width, colour=colour, unicode=True)
    lines = ESCAPES.sub("", shown(replace(PENETRATING, a=name), page=page)).split("\n")
    assert all(line.isprintable() for line in lines)
    assert any("\N{REPLACEMENT CHARACTER}" in line for line in lines)
