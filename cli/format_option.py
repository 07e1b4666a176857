"""The formats of reports, and which of them a call means: `--format`, else the name of the file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click
from click.core import ParameterSource
from msgspec import Struct

from satcheck.cli.formats.registry import (
    PLAIN,
    Format,
    Kind,
    format_named,
    format_of,
    formats,
)
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import Document, Page
from satcheck.core.plugins import failures
from satcheck.report.json import document as json_document
from satcheck.scene.files.readers import reader_of

Command = TypeVar("Command", bound=Callable[..., Any])

_BCF_2 = ".bcfzip"
# Documents of other kinds, by the end of their names.
_NO_REPORTS = {".svg", ".pdf", ".toml", ".yaml", _BCF_2}


class _FormatChoice(click.Choice[str]):
    """A name of a format, also one that another package registers."""

    def __init__(self, kinds: tuple[Kind, ...], also: Iterable[str]) -> None:
        super().__init__([*formats(kinds), *also])
        self._kinds = kinds

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        found = format_named(value)
        if found is not None and found.kind in self._kinds:
            return found.name
        if failed := failures("formats", (Format,)):
            self.fail(f"{value!r} is no format that is known{failed}", param, ctx)
        return super().convert(value, param, ctx)


def format_option(
    kinds: tuple[Kind, ...],
    default: str = "as the file of -o ends, otherwise table",
    also: Mapping[str, str] = {},
) -> Callable[[Command], Command]:
    """Return the option --format of a command that writes formats of these kinds. also: further
    formats, and what each is."""
    known = formats(kinds)
    what = {name: each.about for name, each in known.items() if each.about} | dict(also)
    about = ", ".join(f"{name} is {text}" for name, text in what.items())
    names = ", ".join([*known, *also])
    said = f"{names}{f'; {about}' if about else ''}.  [default: {default}]"
    choice = _FormatChoice(kinds, also)
    return click.option("--format", "form", type=choice, metavar="FORMAT", help=said)


form_option = format_option(PLAIN, "json if the file of -o ends in .json, otherwise table")


def form_of(
    form: str | None,
    output: Path | None,
    kinds: tuple[Kind, ...] = PLAIN,
    also: Sequence[str] = (),
) -> str:
    """Return the format: as given, else as the name of the output file says.

    kinds: of formats that the command writes. also: further formats. Raises click.UsageError for a
    name that promises another kind of document.
    """
    if output is not None and _is_overridden("form", "output"):
        form = None
    ending = "" if output is None else output.suffix.lower()
    named = format_of(ending)
    known = (*formats(kinds), *also)
    if form is not None and form not in known:
        raise click.UsageError(f"--format {form}: this command writes {', '.join(known)}")
    if form is not None or output is None:
        return form or "table"
    if ending == _BCF_2 and "bcf" in known:
        raise click.UsageError(f"{output}: BCF 2.1 is not written: name the file .bcf for BCF 3.0")
    is_other = named is None and (ending in _NO_REPORTS or reader_of(ending) is not None)
    chosen = "table" if named is None else named.name
    if is_other or chosen not in known:
        raise click.UsageError(
            f"{output}: this command writes {', '.join(known)}: give one of them with --format, "
            "or name the file .json"
        )
    return chosen


def _is_overridden(name: str, typed: str) -> bool:
    """Return whether an option comes from a config file, and another one that decides it was
    typed."""
    ctx = click.get_current_context(silent=True)
    return (
        ctx is not None
        and ctx.get_parameter_source(name) is ParameterSource.DEFAULT_MAP
        and ctx.get_parameter_source(typed) is ParameterSource.COMMANDLINE
    )


def plain_call(
    options: dict[str, Any], form: str | None, output: Path | None
) -> tuple[Inputs, str, Document]:
    """Return what a command begins with that writes JSON and a table: its inputs, which it takes
    from the options, the format, and standard output. Raises click.UsageError for what can be seen
    to fail."""
    inputs, form = Inputs.taken_from(options), form_of(form, output)
    refuse_early(inputs, output)
    return inputs, form, Document()


def deliver(
    document: Document,
    stated: Struct,
    form: str,
    output: Path | None,
    render: Callable[[Page], str],
) -> None:
    """Deliver what such a command has made. stated: as JSON. render: the table."""
    document.deliver(
        lambda page: json_document(stated) if form == "json" else render(page),
        output,
        utf8=form == "json",
    )
