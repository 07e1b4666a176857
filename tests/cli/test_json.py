"""The JSON document, and the schema it follows."""

from __future__ import annotations

import json
import math
import random
import struct

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from msgspec.structs import replace

from satcheck.audit import Contacts, Report, Stage
from satcheck.audit.report.report_values import plain
from satcheck.cli._json import pieces, text
from satcheck.cli.report import json as report_json
from satcheck.cli.report.schema import text as schema_text
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
    return "".join(report_json.render(report, timings=timings))


def test_the_pieces_are_the_document() -> None:
    for report in (FULL, reports.report(bodies=()), reports.report()):
        assert text_of(report, timings=True) == report_json.document(report.to_dict(True))


def test_a_long_document_comes_in_pieces() -> None:
    values = [{"name": "\u00e4" * 1000, "rows": [[k], []]} for k in range(200)]
    assert len(pieces(values)) > 2
    assert "".join(pieces(values, 1)) == text(values, 1)
    assert pieces(7) == ["7"]


def test_numbers_are_written_as_python_shows_them() -> None:
    rng = random.Random(7)
    anything = (struct.unpack("<d", rng.randbytes(8))[0] for _ in range(20_000))
    numbers = [number for number in anything if math.isfinite(number)]
    numbers += [rng.uniform(-1, 1) * 10.0 ** rng.randint(-8, 20) for _ in range(20_000)]
    numbers += [float(f"1e{exponent}") for exponent in range(-320, 309)]
    assert text(numbers) == f"[{', '.join(map(repr, numbers))}]"


def test_there_is_no_negative_zero() -> None:
    assert text([-0.0, {"a": -0.0}]) == '[\n  0.0,\n  {\n    "a": 0.0\n  }\n]'


def test_a_frozen_value_is_an_object_of_its_fields() -> None:
    stage = Stage("aabb", "meet", 1.5, "")
    named = '{\n  "stage": "aabb",\n  "result": "meet",\n  "microseconds": 1.5,\n  "detail": ""\n}'
    assert text(stage) == named == text(plain(stage))
    assert text(stage, 0, "microseconds") == text(plain(stage, "microseconds"))
    assert "microseconds" not in text([stage], 0, "microseconds")
    assert ('"motion"' in text(reports.SWEPT), '"motion"' in text(reports.SEPARATED)) == (
        True,
        False,
    )
    assert text(reports.SWEPT) == text(plain(reports.SWEPT))


def test_the_layout_of_values() -> None:
    values = {"none": {}, "list": [], "rows": [[1, 2.5], [True, None]], "mixed": (1, {"a": "b"})}
    assert text(values) == (
        '{\n  "none": {},\n  "list": [],\n  "rows": [\n    [1, 2.5],\n    [true, null]\n  ],\n'
        '  "mixed": [\n    1,\n    {\n      "a": "b"\n    }\n  ]\n}'
    )
    assert text({"a": 1}, 2) == '{\n      "a": 1\n    }'
    assert text(10**30) == str(10**30)


@pytest.mark.parametrize("name", ['\x00\x1f\n\t"\\/\x7f', "\u00e4\U0001f600", "\ud800 lone", ""])
def test_any_name_reads_back(name: str) -> None:
    assert json.loads(text({name: name})) == {name: name}
    assert text(name) == json.dumps(name, ensure_ascii=False)


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_a_number_that_json_has_not_is_refused(number: float) -> None:
    with pytest.raises(ValueError, match="no JSON form for the number"):
        text({"a": [1.0, number]})


@pytest.mark.parametrize("value", [{1: 2}, {"a": {1, 2}}, [b""], np.float64(1.0)])
def test_what_is_no_json_value_is_refused(value: object) -> None:
    with pytest.raises(TypeError, match="no JSON form for a"):
        text(value)


def test_a_value_that_holds_itself_is_refused() -> None:
    endless: list[object] = []
    endless.append(endless)
    with pytest.raises(RecursionError):
        text(endless)


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
