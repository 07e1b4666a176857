"""`satcheck schema [DOCUMENT]`."""

from __future__ import annotations

import click

from satcheck.cli.commands.options import HELP_NAMES, Command

DOCUMENTS = (
    "report",
    "resolution",
    "samples",
    "scene",
    "stability",
    "suggestions",
    "tradeoff",
    "verification",
)


@click.command("schema", cls=Command, context_settings=HELP_NAMES)
@click.argument("document", type=click.Choice(DOCUMENTS), default=DOCUMENTS[0])
def command(document: str) -> None:
    """Print the JSON Schema of a report: of a check, of resolve, of robots in many poses, of
    stability, of suggestions, of tradeoff, of verify; or that of a scene file."""
    from satcheck.cli.output import Document
    from satcheck.cli.report.schema import text

    Document().write(text(document), utf8=True)
