"""The formats of reports, and which of them a call means: `--format`, else the name of the file."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

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
from satcheck.cli.option import STANDARD_OUTPUT, Told
from satcheck.cli.output import Document, Page
from satcheck.core.plugins import failures
from satcheck.report.json import document as json_document

Command = TypeVar("Command", bound=Callable[..., Any])


class Target(NamedTuple):
    """A document to write. output: its file; None: standard output."""

    form: str
    output: Path | None


class FormatChoice(click.Choice[str]):
    """A name of a format of these kinds, also one that another package registers. also: further
    formats, and what the command means by a name. without: formats that do not fit the command."""

    def __init__(
        self,
        kinds: tuple[Kind, ...],
        also: Mapping[str, Format] = {},
        without: Collection[str] = (),
    ) -> None:
        self._kinds, self._also, self._without = kinds, also, without
        super().__init__([*self.known()])

    def known(self) -> dict[str, Format]:
        """Return the formats that are registered by now, by name."""
        known = {**formats(self._kinds), **self._also}
        return {name: each for name, each in known.items() if name not in self._without}

    def ending_in(self, ending: str) -> Format | None:
        """Return the format of files whose names end so; None: there is none."""
        own = (each for each in reversed(self.known().values()) if ending in each.endings)
        found = next(own, None) or format_of(ending)
        return found if found is not None and found.name in self.known() else None

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        found = format_named(value)
        if found is not None and found.kind in self._kinds and found.name not in self._without:
            return found.name
        if failed := failures("formats", (Format,)):
            self.fail(f"{value!r} is no format that is known{failed}", param, ctx)
        return super().convert(value, param, ctx)


def format_option(
    choice: FormatChoice, default: str = "as FILE ends, else table"
) -> Callable[[Command], Command]:
    """Return the option --format of a command that writes these formats."""

    def tell() -> str:
        known = choice.known().items()
        about = ", ".join(f"{name} is {each.about}" for name, each in known if each.about)
        names = ", ".join(_with_ending(name, each) for name, each in known)
        return f"{names}{f'; {about}' if about else ''}.  [default: {default}]"

    return click.option("--format", "form", cls=Told, tell=tell, type=choice, metavar="FORMAT")


def _with_ending(name: str, known: Format) -> str:
    """`markdown (.md)`; an ending that is the name is left out."""
    others = [ending for ending in known.endings[:1] if ending != f".{name}"]
    return f"{name} ({others[0]})" if others else name


_PLAIN = FormatChoice(PLAIN)
form_option = format_option(_PLAIN, "json if the file of -o ends in .json, otherwise table")


def targets_of(
    form: str | None, outputs: Sequence[Path], choice: FormatChoice
) -> tuple[Target, ...]:
    """Return the documents that a call asks for: one for each -o, else one on standard output. The
    form is that of standard output, or of the only file. Raises as `form_of`."""
    paths = outputs or (STANDARD_OUTPUT,)
    if outputs and _is_overridden():
        form = None
    is_shown = STANDARD_OUTPUT in paths
    if form is not None and len(paths) > 1 and not is_shown:
        raise click.UsageError("--format is about one document, and several files are named")
    targets = []
    for path in paths:
        output = None if path == STANDARD_OUTPUT else path
        own = form if output is None or not is_shown else None
        targets.append(Target(form_of(own, output, choice), output))
    return tuple(targets)


def form_of(form: str | None, output: Path | None, choice: FormatChoice) -> str:
    """Return the format of a command that writes these: as given, else as the name of the file
    says. Raises click.UsageError for a name that promises what the command does not write."""
    ending = "" if output is None else output.suffix.lower()
    if form is not None or not ending:
        return form or "table"
    named = choice.ending_in(ending)
    if named is None:
        known = choice.known().values()
        *endings, last = dict.fromkeys(each.endings[0] for each in known if each.endings)
        written = f"{', '.join(endings)} or {last}: end the name so, or give --format"
        raise click.UsageError(f"{output}: this command writes {written}")
    return named.name


def _is_overridden() -> bool:
    """Return whether --format comes from a config file, and -o was typed."""
    ctx = click.get_current_context(silent=True)
    return (
        ctx is not None
        and ctx.get_parameter_source("form") is ParameterSource.DEFAULT_MAP
        and ctx.get_parameter_source("outputs") is ParameterSource.COMMANDLINE
    )


def product_and_report(
    outputs: Sequence[Path], endings: tuple[str, ...], form: str | None
) -> tuple[Path | None, Path | None]:
    """Return the file for what a command makes, whose name ends so, and that of its report. Raises
    click.UsageError for two of a kind, and for another ending."""
    products = [path for path in outputs if path.name.lower().endswith(endings)]
    reports = [path for path in outputs if path not in products]
    for same in (products, reports):
        if len(same) > 1:
            raise click.UsageError(f"-o {same[1]}: {same[0]} is named for that")
    product, report = (next(iter(each), None) for each in (products, reports))
    known = (*endings, *(end for each in _PLAIN.known().values() for end in each.endings))
    if report is not None and form is None and report.suffix.lower() not in ("", *known):
        raise click.UsageError(f"{report}: this command writes {', '.join(known)}: end the name so")
    return product, None if report == STANDARD_OUTPUT else report


def plain_call(
    options: dict[str, Any], form: str | None, output: Path | None, other: Path | None = None
) -> tuple[Inputs, str, Document]:
    """Return what a command begins with that writes JSON and a table: its inputs, which it takes
    from the options, the format, and standard output. other: a file that it writes beside the
    report. Raises click.UsageError for what can be seen to fail."""
    inputs, form = Inputs.taken_from(options), form_of(form, output, _PLAIN)
    refuse_early(inputs, (output, other))
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
