"""`satcheck schema [DOCUMENT]`."""

from __future__ import annotations

import click

from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.formats.schema import text
from satcheck.cli.output import Document

DOCUMENTS = (
    "report",
    "assets",
    "axes",
    "config",
    "decomposition",
    "resolution",
    "result",
    "samples",
    "scene",
    "suggestions",
    "tradeoff",
    "verification",
)


@click.command("schema", cls=Command, context_settings=HELP_NAMES)
@click.argument("document", type=click.Choice(DOCUMENTS), default=DOCUMENTS[0])
def command(document: str) -> None:
    """Print the JSON Schema of a kind of document.

    report describes a check, assets many of them, samples a robot in many poses, config the options
    in satcheck.toml, result a line of the results of batch, resolution the result of resolve,
    suggestions that of suggest, verification that of verify.
    """
    Document().write(text(document), utf8=True)
