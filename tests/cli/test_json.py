"""The JSON document, and the schema it follows."""

from __future__ import annotations

import json
import math
import random
import struct

import pytest
from jsonschema import Draft202012Validator
from msgspec.structs import replace

from satcheck.audit import Report
from satcheck.cli.commands.schema import text as schema_text
from satcheck.report.contacts import Contacts
from satcheck.report.json import document, render
from satcheck.report.report import Witness
from tests.cli import reports

SCHEMA = json.loads(schema_text())
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
    return "".join(render(report, timings=timings))


def test_the_pieces_are_the_document() -> None:
    for report in (FULL, reports.report(bodies=()), reports.report()):
        assert text_of(report, timings=True) == document(report.to_dict())


def test_numbers_read_back() -> None:
    rng = random.Random(7)
    anything = (struct.unpack("<d", rng.randbytes(8))[0] for _ in range(20_000))
    numbers = [number for number in anything if math.isfinite(number)]
    numbers += [rng.uniform(-1, 1) * 10.0 ** rng.randint(-8, 20) for _ in range(20_000)]
    numbers += [float(f"1e{exponent}") for exponent in range(-320, 309)]
    assert json.loads(document(numbers)) == numbers


@pytest.mark.parametrize("number", [math.nan, -math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["a", "\ud800 lone"])
def test_a_number_that_is_not_finite_is_refused(number: float, name: str) -> None:
    """Wherever it stands: msgspec alone would write null."""
    with pytest.raises(ValueError, match="Out of range float"):
        document({name: [(1.0, {"b": number})]})
    with pytest.raises(ValueError, match="Out of range float"):
        document({name: replace(reports.PENETRATING.plan[0], microseconds=number)})


@pytest.mark.parametrize("timings", [True, False])
def test_a_report_with_such_a_number_is_refused(timings: bool) -> None:
    finding = replace(reports.TOUCHING, witness=Witness((0.0, math.nan, 0.0), (0.0, 0.0, 0.0)))
    with pytest.raises(ValueError, match="Out of range float"):
        render(reports.report(finding), timings=timings)


def test_bytes_that_look_like_one_are_written() -> None:
    """An integer and a number of which the bytes hold the mark of a NaN."""
    look_alike = 0xCB7FF00000000000
    number = struct.unpack(">d", bytes.fromhex("3fcb7ff000000000"))[0]
    assert json.loads(document([look_alike, number])) == [look_alike, number]


def test_there_is_no_negative_zero() -> None:
    """In numbers: a name may hold the same characters, before any end of a line."""
    names = ["-0.0", "-0.0,", "-0.0\n", "-0.0,\n"]
    text = document([-0.0, {"a": -0.0, "b": [1.0, -0.0]}, *names])
    assert text.replace('"-0.0', "").count("-0.0") == 0
    assert json.loads(text) == [0.0, {"a": 0.0, "b": [1.0, 0.0]}, *names]


def test_the_layout_of_values() -> None:
    values = {"none": {}, "list": [], "row": [1, 2.5, True, None], "mixed": (1, {"a": "b"})}
    assert document(values) == json.dumps(values, indent=2) + "\n"


@pytest.mark.parametrize("name", ['\x00\x1f\n\t"\\/\x7f', "\u00e4\U0001f600", "\ud800 lone", ""])
def test_any_name_reads_back(name: str) -> None:
    assert json.loads(document({name: name})) == {name: name}
    odd = replace(reports.SEPARATED, a=name)
    report = reports.report(odd, reports.SEPARATED)
    assert json.loads(text_of(report, timings=True))["findings"][0]["a"] == name


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
    values = json.loads(text_of(FULL, timings=True))
    *parents, last = path
    place = values
    for parent in parents:
        place = place[parent]
    place[last] = value
    assert not Draft202012Validator(SCHEMA).is_valid(values)
