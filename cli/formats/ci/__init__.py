"""Reports in the formats of CI systems and of spreadsheets.

Each module has one function `render(reports)` that returns the document in pieces; reports are
named, by the asset that each is about. `FORMATS` is the registry: a format is imported when a
report is written in it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from satcheck.report.report import Report


class Reports(Protocol):
    """Named reports, as a mapping has them. There may be more than fit into memory; then each
    iteration reads them again."""

    def items(self) -> Iterable[tuple[str, Report]]: ...
    def values(self) -> Iterable[Report]: ...
    def __len__(self) -> int: ...


# Format -> the endings of the files that are in it.
FORMATS: dict[str, tuple[str, ...]] = {
    "sarif": (".sarif",),
    "junit": (".xml",),
    "github": (),
    "markdown": (".md",),
    "csv": (".csv",),
    "jsonl": (".jsonl", ".ndjson"),
}


def pieces(reports: Reports, form: str) -> Iterable[str]:
    """Without any report the document is an empty one of its format."""
    module = import_module(f"{__name__}.{form}")
    return cast("Callable[[Reports], Iterable[str]]", module.render)(reports)


def render(reports: Reports, form: str) -> str:
    return "".join(pieces(reports, form))
