"""The table of coverage speaks of every field of the published schema, and of no other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from satcheck.report.report import Report
from satcheck.report.schema import schema_of
from satcheck.verify.coverage import COVERAGE, uncovered
from tests.verify.honest import honest
from tests.verify.reports import report_of, verified

SCHEMA = schema_of("report", Report)


def fields_of(node: Any, path: str = "") -> Iterator[str]:
    """Paths of the fields of a schema that have no fields of their own, as COVERAGE names them.

    A certificate is one field: it is evidence, and claims nothing itself.
    """
    if "$ref" in node:
        node = SCHEMA["$defs"][node["$ref"].rpartition("/")[2]]
    choices = [choice for choice in node.get("anyOf", []) if choice.get("type") != "null"]
    items = node.get("items") or next(iter(node.get("prefixItems", [])), None)
    if path.endswith(".certificate") or not (choices or node.get("properties") or items):
        yield path
        return
    for choice in choices:
        yield from fields_of(choice, path)
    for key, member in node.get("properties", {}).items():
        yield from fields_of(member, f"{path}.{key}".lstrip("."))
    if items:
        yield from fields_of(items, f"{path}[]")


def speaks_of(entry: str, field: str) -> bool:
    rest = field.removeprefix(entry)
    return field.startswith(entry) and (not rest or rest[0] in ".[")


FIELDS = sorted(set(fields_of(SCHEMA)))


def test_each_field_is_in_one_class() -> None:
    assert len(FIELDS) > 100
    for field in FIELDS:
        entries = [entry for entry in COVERAGE if speaks_of(entry, field)]
        assert len(entries) == 1, (field, entries)


def test_each_entry_is_about_a_field() -> None:
    for entry in COVERAGE:
        assert any(speaks_of(entry, field) for field in FIELDS), entry


def test_what_is_listed_has_a_name() -> None:
    for entry, cover in COVERAGE.items():
        assert bool(cover.called) is (cover.kind not in ("proven", "follows")), entry


def test_what_is_not_proven_is_named() -> None:
    document = report_of("sheet-in-wall", depth=True)
    left = {one.field: one.findings for one in verified(document).not_covered}
    assert left["findings[].depth_bounds"] == 1
    assert "findings[].mtv" not in left
    assert {"settings", "bodies[].id", "findings[].plan"} <= left.keys()
    assert "rules[]" not in left
    assert "bodies[].transform" not in left
    document["bodies"][0]["transform"] = [float(k % 5 == 0) for k in range(16)]
    assert "bodies[].transform" in {one.field for one in uncovered(document, [])}


def test_a_volume_of_nothing_is_named_where_bodies_overlap() -> None:
    document = honest("concave")
    document["findings"][0].update(volume=0.0, volume_error=0.0)
    left = {one.field for one in verified(document).not_covered}
    assert {"findings[].volume", "findings[].volume_error"} <= left
