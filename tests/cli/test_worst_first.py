"""Every output puts the same finding first."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from satcheck.cli.formats.picture import listed
from satcheck.cli.formats.registry import pieces
from satcheck.cli.formats.table import render as render_table
from satcheck.cli.output import PLAIN_PAGE
from satcheck.report.report import Finding, Report
from tests.cli.reports import BLOCK, PENETRATING, report

NAMES = ("block", "thin", "deep", "known")


def overlap(b: str, thickness: float | None, depth: float) -> Finding:
    bounds = None if thickness is None else (thickness, thickness)
    return replace(
        PENETRATING,
        id=f"block|{b}",
        b=b,
        depth=depth,
        depth_bounds=(depth, depth),
        thickness=thickness,
        thickness_bounds=bounds,
    )


THIN = overlap("thin", 0.033, 0.5)
DEEP = overlap("deep", None, 0.15)
KNOWN = replace(overlap("known", 0.9, 0.9), baseline_state="unchanged")


def of(*findings: Finding) -> Report:
    bodies = tuple(replace(BLOCK, id=name, name=name) for name in NAMES)
    return report(*findings, bodies=bodies)


REPORT = of(KNOWN, THIN, DEEP)


def test_the_depth_stands_for_a_thickness_that_is_unknown() -> None:
    assert [finding.b for finding in listed(REPORT)] == ["deep", "thin", "known"]


@pytest.mark.parametrize("form", ["sarif", "github"])
def test_formats_of_ci(form: str) -> None:
    assert order("".join(pieces({"all": REPORT}, form)), "{} and {}") == ["deep", "thin", "known"]


def test_markdown_lists_no_notes() -> None:
    text = "".join(pieces({"all": REPORT}, "markdown"))
    assert order(text, "| block and {1}") == ["deep", "thin"]
    assert "1 more row: a JSON report has all." in text


def test_table_and_verdict() -> None:
    table = render_table(REPORT, PLAIN_PAGE, explain=True, timings=False)
    assert order(table, "{}  {}  ") == ["deep", "thin", "known"]
    assert "worst: block and deep" in of(THIN, DEEP).message


def order(text: str, pair: str) -> list[str]:
    """The second bodies, as their pairs follow each other in the text."""
    places = {name: text.find(pair.format("block", name)) for name in NAMES[1:]}
    return sorted((name for name in places if places[name] >= 0), key=places.__getitem__)
