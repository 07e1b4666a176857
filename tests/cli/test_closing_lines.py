"""The lines below the table: counts, warnings and the verdict."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from satcheck.audit.messages import with_messages
from satcheck.cli import exit_codes
from satcheck.cli.formats.summary import FACETED, next_step
from satcheck.cli.formats.table import render
from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.cli.rendering import tell
from satcheck.report.report import (
    INTERNAL_ERROR,
    NOTHING_TO_CHECK,
    Exempt,
    Issue,
    Stage,
)
from satcheck.scene import Scene
from tests.cli import reports
from tests.cli.reports import (
    BOUNDED,
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
from tests.cli.shown import ESCAPES, HIT_AT_60, UNMEASURED, shown

WIDE = Page(width=400, colour=False, unicode=True)


def test_warnings_are_in_the_text_and_errors_are_not() -> None:
    text = render(
        report(UNDECIDED, issues=(reports.OPEN, reports.MISSING)),
        PLAIN_PAGE,
        explain=False,
        timings=True,
    )
    assert "warning: soup: open mesh (1 hole, 2 across) [not-closed]" in text
    assert "gone.obj" not in text
    assert "\nERROR: no collision was found, but 1 pair is indeterminate; 1 input could" in text


def test_the_word_of_the_command_is_that_of_its_exit_code() -> None:
    made = report(PENETRATING, issues=(reports.MISSING,))
    assert made.message.startswith(
        "FAIL: block and block_pushed overlap (1 to pull apart). 1 input could"
    )
    text = render(made, WIDE, explain=False, timings=True)
    assert "\nERROR: block and block_pushed overlap (1 to pull apart). 1 input could" in text


def test_meshes_that_decide_nothing_share_a_line() -> None:
    issues = tuple(replace(reports.OPEN, body=f"open{k}") for k in range(19))
    text = render(report(PENETRATING, issues=issues), WIDE, explain=False, timings=True)
    assert "\n19 open meshes; none mattered\n" in text
    assert "not-closed" not in text


def test_issues_of_one_kind_are_three_lines_at_most() -> None:
    issues = tuple(replace(reports.OPEN, code="far-vertex", body=f"b{k}") for k in range(5))
    text = render(report(PENETRATING, issues=issues), WIDE, explain=False, timings=True)
    assert text.count("warning: b") == 3
    assert "\n2 [far-vertex] more: JSON has all\n" in text


def test_an_open_mesh_that_decides_names_the_option() -> None:
    inside = replace(THICK, relation="contains", b="soup")
    assert "Next: --allow-open, if " in shown(inside)
    assert "--allow-open" not in shown(replace(THICK, b="soup"))


@pytest.mark.parametrize(
    ("findings", "lines"),
    [
        ((SEPARATED,), ("2 bodies, 1 pair: 1 separated.", "PASS: no collision.")),
        (
            (THICK,),
            (
                "2 bodies, 1 pair: 1 penetrating.",
                "FAIL: block and block_pushed overlap (thickness 0.5, 1 to pull apart). "
                "Next: -o report.html shows it in 3-D.",
            ),
        ),
        (
            (THICK, BOUNDED, UNMEASURED, UNDECIDED, HIT),
            (
                "2 bodies, 5 pairs: 3 penetrating, 1 containing, 1 indeterminate. "
                "1 pair hits in motion.",
                "FAIL: 3 of 5 pairs overlap, 1 hits in motion; worst: "
                "a_rather_long_name contains another_rather_long_name (1.25 ±0.01 to pull apart). "
                "1 pair is indeterminate. Next: -o report.html shows them in 3-D.",
            ),
        ),
        (
            (THICK, UNMEASURED, replace(BOUNDED, severity="note")),
            (
                "2 bodies, 3 pairs: 2 penetrating, 1 containing.",
                "FAIL: 2 of 3 pairs overlap more than allowed; worst: block and block_pushed "
                "overlap (thickness 0.5, 1 to pull apart). "
                "Next: -o report.html shows them in 3-D.",
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
                "2 bodies, 1 pair: 1 penetrating. 1 pair hits in motion.",
                "FAIL: block hits passer at 60 deg, near (1.5, 2, 0). "
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
            (replace(PENETRATING, severity="note", rule="--max-depth"),),
            (
                "2 bodies, 1 pair: 1 penetrating.",
                "PASS: no collision beyond what --max-depth allows.",
            ),
        ),
        (
            (replace(PENETRATING, severity="warning", undecided="limit", rule="cell.toml:3"),),
            (
                "2 bodies, 1 pair: 1 penetrating.",
                "INCOMPLETE: no collision beyond what rules allow was found, "
                "but 1 pair may exceed its limits. Next: a larger --budget may decide it.",
            ),
        ),
    ],
)
def test_the_last_lines_are_counts_and_a_verdict(
    findings: tuple[object, ...], lines: tuple[str, str]
) -> None:
    shown_lines = shown(*findings, page=WIDE).splitlines()
    first = next(k for k, line in enumerate(shown_lines) if line.startswith("2 bodies, "))
    assert (shown_lines[first], " ".join(shown_lines[first + 1 :])) == lines


def test_a_pair_of_long_names_is_named_by_their_ends() -> None:
    a, b = (f"{'part_of_' * 12}{name}" for name in ("lid", "box"))
    said = report(replace(PENETRATING, a=a, b=b)).message
    assert said.startswith("FAIL: …")
    assert "part_of_lid and …" in said
    assert "part_of_box overlap (" in said


def test_no_pair_is_left_beside_what_cannot_be_read() -> None:
    made = report(UNDECIDED, issues=(reports.MISSING,))
    lost = replace(made.bodies[1], triangles=None)
    made = with_messages(replace(made, bodies=(made.bodies[0], lost)))
    assert made.message == ("INCOMPLETE: no pair could be checked: 1 input could not be used.")
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert text == "ERROR: no pair could be checked: 1 input could not be used.\n"


def test_exit_zero_forgives_what_fails_and_not_what_is_open() -> None:
    made = report(PENETRATING, UNDECIDED)
    assert "1 pair is indeterminate." in made.message
    assert exit_codes.for_report(made, exit_zero=False) == exit_codes.FINDINGS
    assert exit_codes.for_report(made, exit_zero=True) == exit_codes.INCOMPLETE
    assert exit_codes.for_report(report(PENETRATING), exit_zero=True) == exit_codes.CLEAN


def test_many_overlaps_ask_for_rules() -> None:
    many = [replace(THICK, b=f"block{k}") for k in range(11)]
    made = report(*many)
    parts = tuple(replace(body, file="assembly.glb") for body in made.bodies)
    made = with_messages(replace(made, bodies=parts))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "Next: satcheck suggest proposes rules" in text


def test_what_hulls_cannot_prove_asks_for_accuracy() -> None:
    made = report(ESTIMATE)
    made = with_messages(replace(made, settings=replace(made.settings, accuracy="hull")))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert (
        "FAIL: block and perhaps possibly overlap (at most 2 to pull apart).\nNext: --accuracy"
        in text
    )


def test_an_internal_error_is_no_unusable_input() -> None:
    fault = Issue(INTERNAL_ERROR, "error", None, None, "block and soup: internal error: ...")
    made = report(UNDECIDED, issues=(fault,))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    assert "1 pair is indeterminate; 1 pair failed by an internal error.\nNext" in text
    made = with_messages(replace(made, issues=(fault, reports.MISSING)))
    text = render(made, WIDE, explain=False, timings=True)
    assert "; 1 input could not be used; 1 pair failed by an internal error.\nNext" in text


def test_opinions_that_could_not_be_had_are_told_once() -> None:
    silent = Stage("cross-check", "no answer", 1.0, "python-fcl: it did not answer in 30 s")
    pairs = [replace(PENETRATING, id=str(k), plan=(*PENETRATING.plan, silent)) for k in range(2)]
    text = shown(*pairs, asked="cross_check")
    assert text.count("python-fcl") == 1
    assert "cross-check: no answer on 2 pairs: python-fcl: it did not answer in 30 s\n" in text


def test_no_pair_checked_is_no_verdict() -> None:
    made = report()
    pairs = replace(made.summary.pairs, total=3, allowed=3)
    why = Issue(NOTHING_TO_CHECK, "warning", None, None, "no pair was checked: 3 allowed by rules")
    summary = replace(made.summary, verdict="incomplete", pairs=pairs)
    made = with_messages(replace(made, summary=summary, issues=(why,)))
    text = render(made, PLAIN_PAGE, explain=False, timings=True)
    last = "INCOMPLETE: no pair was checked: 3 allowed by rules.\n"
    assert text == f"2 bodies, 3 pairs.\n{last}"


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
    bodies = (reports.BLOCK, replace(reports.BLOCK, id=SEPARATED.b), lost)
    made = report(SEPARATED, undecided, bodies=bodies, issues=(reports.MISSING,))
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


def test_facets_that_excuse_more_than_a_limit_are_told() -> None:
    faceted = Issue(FACETED, "note", None, "a.step", "facets are off by 0.5 mm")
    found = replace(TOUCHING, thickness=0.4, depth=0.4)
    made = report(found, issues=(faceted,))

    def said(**limits: float) -> list[str]:
        return next_step(replace(made, settings=replace(made.settings, **limits)), written=True)

    assert said() == said(max_thickness=0.4) == []
    assert "1 pair overlaps by more than the limit" in said(max_thickness=0.3)[0]
    assert said(max_depth=0.3) == said(max_thickness=0.3)
    assert next_step(replace(made, issues=())) == []


def test_facets_are_told_beside_a_report_in_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    faceted = Issue(FACETED, "note", None, "a.step", "facets are off by 0.5 mm")
    other = Issue("left-out", "note", None, "a.step", "a sketch")
    scene = Scene(name="", units=None, bodies=())
    tell(report(SEPARATED, issues=(faceted, other)), scene, "Report: a.json", written=True)
    told = capsys.readouterr().err
    assert "note: a.step: facets are off by 0.5 mm [faceted]" in told
    assert "left-out" not in told
