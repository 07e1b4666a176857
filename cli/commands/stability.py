"""`satcheck stability A B`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.audit import Settings
from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of, form_option
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.options import color_option, debug_option, output_option, paths_argument
from satcheck.cli.output import Document, Page
from satcheck.cli.progress import Bar
from satcheck.cli.scene_options import reading_options, units_option
from satcheck.report.json import document as json_document
from satcheck.studies.stability import Stability, probe

_EXIT_CODES = {
    "stable": exit_codes.CLEAN,
    "changed": exit_codes.FINDINGS,
    "undecided": exit_codes.INCOMPLETE,
}


@click.command("stability", cls=Command, context_settings=HELP_NAMES)
@paths_argument("A B")
@click.option(
    "--samples",
    type=click.IntRange(min=1),
    metavar="N",
    default=4,
    show_default=True,
    help="How many variants of each kind.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="The seed of the variants: the same seed makes the same variants.",
)
@click.option("--depth/--no-depth", default=True, help="Compare depths as well.  [default: depth]")
@form_option
@output_option
@click.option("--explain", is_flag=True, help="Show every variant, not only the failures.")
@units_option
@reading_options
@color_option
@debug_option
def command(
    form: str | None,
    output: Path | None,
    samples: int,
    seed: int,
    depth: bool,
    explain: bool,
    **options: Any,
) -> int:
    """Check whether equivalent inputs get the same answer.

    satcheck makes variants of the mesh files A and B, N of each kind: scaled by powers of two,
    vertices and faces reordered, axes exchanged, A and B swapped, moved, turned, faces divided into
    other triangles, coordinates changed by one unit in the last place. It compares each change of
    the answer with its proven bound.

    Exit codes: 0, everything is within its bound; 1, something is not; 2, wrong usage, an
    unreadable input, or an internal error; 3, something could not be decided.
    """
    inputs = Inputs.taken_from(options)
    form = form_of(form, output)
    if len(inputs.paths) != 2:
        raise click.UsageError(f"give two mesh files, not {len(inputs.paths)}")
    refuse_early(inputs, output)
    document = Document()
    scene = load(inputs)
    if scene.unreadable:
        raise click.ClickException("an input could not be used: there is no pair to ask about")
    with Bar("variants", "comparing") as bar:
        result = probe(scene, samples, seed, Settings(depth=depth), progress=bar)
    document.deliver(
        lambda page: _render(result, form, page, explain=explain), output, utf8=form == "json"
    )
    return _EXIT_CODES[result.verdict]


def _render(result: Stability, form: str, page: Page, *, explain: bool) -> str:
    if form == "json":
        return json_document(result.document())
    from satcheck.cli.formats.stability import render

    return render(result, page, explain=explain)
