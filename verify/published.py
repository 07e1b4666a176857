"""Check of a report against its published schema."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from msgspec import ValidationError, convert, to_builtins

from satcheck.report.report import Finding, Report
from satcheck.report.schema import TIMING

LONGEST_MESSAGE = 200


def departures(document: dict[str, Any]) -> dict[int | None, str]:
    """Index of a finding, or None for the rest of the report -> the first thing that is wrong.

    Values of a wrong type, unknown keys and words, missing keys, numbers that are not finite.
    """
    findings = document.get("findings")
    if not isinstance(findings, list):
        return {None: "`findings` is no list"}
    parts: dict[int | None, str | None] = dict(
        enumerate(_departure(finding, Finding) for finding in findings)
    )
    parts[None] = _departure({**document, "findings": []}, Report)
    return {part: why for part, why in parts.items() if why is not None}


def _departure(value: Any, form: type[Report | Finding]) -> str | None:
    try:
        whole = to_builtins(convert(value, form))
    except ValidationError as why:
        message = str(why)
        if len(message) > LONGEST_MESSAGE:
            message = f"{message[: LONGEST_MESSAGE // 2]} ... {message[-LONGEST_MESSAGE // 2 :]}"
        return message
    return next(_beyond_types(value, whole, "$"), None)


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
