"""The formats of reports, and which of them a call means: `--format`, else the name of the file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from click.core import ParameterSource

from satcheck.cli.formats.ci import FORMATS as CI_FORMATS
from satcheck.cli.formats.picture import FORMATS as PICTURE_FORMATS
from satcheck.scene.loading.readers import readers

FORMATS = ("table", "json")
# Formats of one report or of many.
REPORT_FORMATS = (*FORMATS, *CI_FORMATS)
PICTURES = tuple(PICTURE_FORMATS)
_ENDINGS = {
    ending: form for form, endings in (CI_FORMATS | PICTURE_FORMATS).items() for ending in endings
}
_BCF_2 = ".bcfzip"
# Documents of other kinds, by the end of their names.
_NO_REPORTS = {".svg", ".pdf", ".toml", ".yaml", _BCF_2, *readers()} - _ENDINGS.keys()

form_option = click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    metavar="FORMAT",
    help="table or json.  [default: json if the file of -o ends in .json, otherwise table]",
)
reports_form_option = click.option(
    "--format",
    "form",
    type=click.Choice(REPORT_FORMATS),
    metavar="FORMAT",
    help=f"{', '.join(REPORT_FORMATS)}.  [default: as the file of -o ends, otherwise table]",
)
report_form_option = click.option(
    "--format",
    "form",
    type=click.Choice((*REPORT_FORMATS, *PICTURES)),
    metavar="FORMAT",
    help=f"{', '.join((*REPORT_FORMATS, *PICTURES))}; html is a 3-D view, png an image of the "
    "worst finding, glb a 3-D model, bcf topics (BCF 3.0).  [default: as the file of -o ends, "
    "otherwise table]",
)


def form_of(form: str | None, output: Path | None, forms: Sequence[str] = FORMATS) -> str:
    """The format, one of `forms`: as given, else as the name of the output file says.

    Raises click.UsageError for a name that promises another kind of document.
    """
    if output is not None and _is_overridden("form", "output"):
        form = None
    if form is not None and form not in forms:
        raise click.UsageError(f"--format {form}: this command writes {', '.join(forms)}")
    if form is not None or output is None:
        return form or "table"
    ending = output.suffix.lower()
    named = "json" if ending == ".json" else _ENDINGS.get(ending, "table")
    if ending == _BCF_2 and "bcf" in forms:
        raise click.UsageError(f"{output}: BCF 2.1 is not written: name the file .bcf for BCF 3.0")
    if ending in _NO_REPORTS or named not in forms:
        raise click.UsageError(
            f"{output}: this command writes {', '.join(forms)}: give one of them with --format, "
            "or name the file .json"
        )
    return named


def _is_overridden(name: str, typed: str) -> bool:
    """Return whether an option comes from a config file, and another one that decides it was
    typed."""
    ctx = click.get_current_context(silent=True)
    return (
        ctx is not None
        and ctx.get_parameter_source(name) is ParameterSource.DEFAULT_MAP
        and ctx.get_parameter_source(typed) is ParameterSource.COMMANDLINE
    )
