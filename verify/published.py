"""A report read strictly: its text means one thing only, and its values follow the schema."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator
from typing import Any, TypeVar

from msgspec import ValidationError, convert, to_builtins

from satcheck.report.assets import SCHEMA as ASSETS
from satcheck.report.report import SCHEMA, Finding, Report
from satcheck.report.schema import TIMING
from satcheck.report.verification import Checked
from satcheck.verify.exact import Rejected


def parse(text: str) -> Any:
    """JSON values. Rejected: not JSON, a key that an object has twice, a number that no float64 is.

    JSON leaves open which of two equal keys counts, so two readers of such a report may see two
    reports.
    """
    try:
        return json.loads(
            text, object_pairs_hook=_object, parse_constant=_refuse, parse_float=_finite
        )
    except (ValueError, RecursionError) as error:
        raise Rejected(f"not JSON: {error}") from None


def _object(members: list[tuple[str, Any]]) -> dict[str, Any]:
    made = dict(members)
    if len(made) < len(members):
        keys = [key for key, _ in members]
        twice = next(key for key, times in Counter(keys).items() if times > 1)
        raise Rejected(f"the key {twice!r} stands twice in one object")
    return made


def _finite(text: str) -> float:
    number = float(text)
    if math.isinf(number):
        raise Rejected(f"the number {text[:40]} is out of range")
    return number


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is no number")


LONGEST_MESSAGE = 200
Form = TypeVar("Form", Report, Finding)


def report_of(document: Any) -> tuple[Report, list[Finding | Checked]]:
    """Return the report without its findings, and these; those that break the schema, as rejected.

    Rejected: a value of a wrong type, an unknown key or word, a missing key, or a number that is
    not finite, outside of the findings.
    """
    if isinstance(document, dict) and document.get("schema") == ASSETS:
        raise Rejected(
            "it holds the reports of several assets, and certificates need the check of one: "
            "satcheck --certificate -o REPORT.json ASSET"
        )
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise Rejected(f'not a report: "schema" is not "{SCHEMA}"')
    findings = document.get("findings")
    if not isinstance(findings, list):
        raise Rejected("not a report by its schema: `findings` is no list")
    if not all(isinstance(finding, dict) for finding in findings):
        raise Rejected("not a report: a finding is no object")
    try:
        report = _strictly({**document, "findings": []}, Report)
    except ValidationError as why:
        raise Rejected(f"not a report by its schema: {_shortened(str(why))}") from None
    return report, [_finding(finding) for finding in findings]


def _finding(values: dict[str, Any]) -> Finding | Checked:
    try:
        return _strictly(values, Finding)
    except ValidationError as why:
        a, b, relation = (str(values.get(key)) for key in ("a", "b", "relation"))
        reason = f"not by the schema: {_shortened(str(why))}"
        return Checked(a, b, relation, "rejected", reason)


def _strictly(values: dict[str, Any], form: type[Form]) -> Form:
    try:
        struct = convert(values, form)
    except UnicodeEncodeError:  # where a word of the schema is expected
        raise ValidationError("half a character instead of a word") from None
    for departure in _beyond_types(values, to_builtins(struct), "$"):
        raise ValidationError(departure)
    return struct


def _shortened(message: str) -> str:
    if len(message) <= LONGEST_MESSAGE:
        return message
    return f"{message[: LONGEST_MESSAGE // 2]} ... {message[-LONGEST_MESSAGE // 2 :]}"


def _beyond_types(value: Any, whole: Any, path: str) -> Iterator[str]:
    """Keys that are missing, and infinity. whole: the value with all its keys."""
    if isinstance(whole, float) and not math.isfinite(whole):
        yield f"Not a finite number - at `{path}`"
    elif isinstance(whole, dict):
        for key, member in whole.items():
            if key in value:
                yield from _beyond_types(value[key], member, f"{path}.{key}")
            elif key != TIMING:
                yield f"Object has no field `{key}` - at `{path}`"
    elif isinstance(whole, list | tuple):
        for number, (each, member) in enumerate(zip(value, whole, strict=True)):
            yield from _beyond_types(each, member, f"{path}[{number}]")
