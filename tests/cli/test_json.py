"""The JSON document, and the schema it follows."""

from __future__ import annotations

import json

import pytest
from jsonschema import Draft202012Validator

from satcheck.audit import Contacts, Report
from satcheck.cli.report import json as report_json
from satcheck.cli.report.schema import text
from satcheck.core.frozen import replace
from tests.cli import reports

SCHEMA = json.loads(text())
FULL = reports.report(
    reports.PENETRATING,
    reports.BOUNDED,
    reports.TOUCHING,
    reports.SEPARATED,
    reports.UNDECIDED,
    reports.CROSSING,
    replace(reports.SEPARATED, contacts=Contacts()),
    issues=(reports.OPEN, reports.MISSING),
    units="mm",
)


def text_of(report: Report, *, timings: bool) -> str:
    return "".join(report_json.render(report, timings=timings))


def test_the_pieces_are_the_document() -> None:
    for report in (FULL, reports.report(bodies=()), reports.report()):
        assert text_of(report, timings=True) == report_json.document(report.to_dict(True))


def test_the_schema_is_one() -> None:
    Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("timings", [True, False])
@pytest.mark.parametrize("report", [FULL, reports.report(bodies=())], ids=["full", "empty"])
def test_documents_follow_the_schema(report: Report, timings: bool) -> None:
    Draft202012Validator(SCHEMA).validate(json.loads(text_of(report, timings=timings)))


@pytest.mark.parametrize("timings", [True, False])
def test_nothing_is_lost(timings: bool) -> None:
    assert json.loads(text_of(FULL, timings=timings)) == FULL.to_dict(timings)


def test_timings_can_be_left_out() -> None:
    assert "microseconds" in text_of(FULL, timings=True)
    assert "microseconds" not in text_of(FULL, timings=False)


def test_vectors_take_one_line() -> None:
    assert '"normal": [1.0, 0.0, 0.0],\n' in text_of(FULL, timings=True)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["findings", 0, "relation"], "colliding"),
        (["findings", 0, "mtv"], [1.0, 0.0]),
        (["findings", 0, "depth"], -1.0),
        (["findings", 0, "extra"], None),
        (["findings", 5, "volume"], -1.0),
        (["findings", 5, "contacts", "curves", 0, "points"], [[1.0, 0.0, 0.0]]),
        (["summary", "pairs", "total"], 1.5),
        (["issues", 0, "code"], "Not Kebab"),
    ],
)
def test_the_schema_refuses(path: list[str | int], value: object) -> None:
    """A schema that accepts everything would pass every other test here."""
    document = json.loads(text_of(FULL, timings=True))
    *parents, last = path
    place = document
    for parent in parents:
        place = place[parent]
    place[last] = value
    assert not Draft202012Validator(SCHEMA).is_valid(document)
