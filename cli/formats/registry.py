"""The registry of formats: in what a report is written.

Plug-ins and other packages register their formats as those here are (`core/plugins.py`). What
writes a format is imported when a report is written in it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, Protocol, cast

from msgspec import Struct

from satcheck.core.plugins import function_at, others, own

if TYPE_CHECKING:
    from satcheck.report.report import Report

Kind = Literal["plain", "reports", "picture"]
PLAIN: tuple[Kind, ...] = ("plain",)
REPORTS: tuple[Kind, ...] = ("plain", "reports")
ALL: tuple[Kind, ...] = ("plain", "reports", "picture")


class Reports(Protocol):
    """Named reports, as a mapping has them. There may be more than fit into memory; then each
    iteration reads them again."""

    def items(self) -> Iterable[tuple[str, Report]]: ...
    def values(self) -> Iterable[Report]: ...
    def __len__(self) -> int: ...


class Format(Struct, frozen=True):
    """A format of reports.

    name: of --format. endings: of the files that are in it. render: "module:function". kind:
    "reports": the function takes `Reports` and returns the document in pieces, an empty one of its
    format without any report; "picture": it takes a report and its scene, and returns text or
    bytes; "plain": the commands write it themselves. about: words for the help.
    """

    name: str
    endings: tuple[str, ...] = ()
    render: str = ""
    kind: Kind = "reports"
    about: str = ""


def _for_ci(name: str, *endings: str) -> Format:
    return Format(name, endings, f"satcheck.cli.formats.ci.{name}:render")


def _picture(name: str, *endings: str, about: str) -> Format:
    module = f"satcheck.cli.formats.picture.{name}:render"
    return Format(name, endings, module, "picture", about)


_BUILT_IN = (
    Format("table", (".txt",), kind="plain"),
    Format("json", (".json",), kind="plain"),
    _for_ci("sarif", ".sarif"),
    _for_ci("junit", ".xml"),
    _for_ci("github"),
    _for_ci("markdown", ".md"),
    _for_ci("csv", ".csv"),
    _for_ci("jsonl", ".jsonl", ".ndjson"),
    _picture("html", ".html", ".htm", about="a 3-D view"),
    _picture("png", ".png", about="an image of the worst finding"),
    _picture("glb", ".glb", about="a 3-D model"),
)


@cache
def _registry() -> dict[str, Format]:
    found: dict[str, Format] = {}
    _add(found, _BUILT_IN)
    _add(found, own("formats"))
    return found


def formats(kinds: Iterable[Kind] = ALL) -> dict[str, Format]:
    """Return the formats of these kinds, by name. Other packages are asked only for what this one
    does not have (`format_named`, `format_of`)."""
    return {name: each for name, each in _registry().items() if each.kind in kinds}


def format_named(name: str) -> Format | None:
    """Return the format of this name; None: there is none."""
    if name not in _registry():
        add_others()
    return _registry().get(name)


def kind_of(name: str) -> Kind:
    """Return the kind of a format that a command has accepted."""
    return _registry()[name].kind


def function_of(name: str) -> Callable[..., Any]:
    """Return what writes a format that a command has accepted."""
    return cast("Callable[..., Any]", function_at(_registry()[name].render))


def pieces(reports: Reports, name: str) -> Iterable[str]:
    """Return the document of named reports, in pieces."""
    return cast("Iterable[str]", function_of(name)(reports))


def format_of(ending: str) -> Format | None:
    """Return the format of files whose names end so; None: there is none."""
    if not any(ending in each.endings for each in _registry().values()):
        add_others()
    return next((each for each in _registry().values() if ending in each.endings), None)


def add_others() -> None:
    """Register the formats of other packages, which takes as long as a small check."""
    _add(_registry(), others("formats", (Format,)))


def _add(registry: dict[str, Format], new: Iterable[Format]) -> None:
    """A format that is there already stays."""
    for each in new:
        registry.setdefault(each.name, each)
