"""Reports in the formats of CI systems and of spreadsheets.

Each module has one function `render(reports)` that returns the whole document as text; reports are
named, by the asset that each is about. `FORMATS` is the registry: a format is imported when a
report is written in it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from satcheck.report.report import Report

# Format -> the endings of the files that are in it.
FORMATS: dict[str, tuple[str, ...]] = {
    "sarif": (".sarif",),
    "junit": (".xml",),
    "github": (),
    "markdown": (".md",),
    "csv": (".csv",),
    "jsonl": (".jsonl", ".ndjson"),
}


def render(reports: Mapping[str, Report], form: str) -> str:
    """Without any report the document is an empty one of its format."""
    module = import_module(f"{__name__}.{form}")
    return cast("Callable[[Mapping[str, Report]], str]", module.render)(reports)
