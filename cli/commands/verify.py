"""`satcheck verify REPORT`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.cli.commands.options import (
    HELP_NAMES,
    Command,
    debug_option,
    form_option,
    output_option,
    outside_option,
)
from satcheck.cli.output import form_of


@click.command("verify", cls=Command, context_settings=HELP_NAMES)
@click.argument("report", metavar="REPORT", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--root",
    type=click.Path(file_okay=False, exists=True, path_type=Path),
    default=Path(),
    help="The folder where the check ran: paths in the report start there.  "
    "[default: the current one]",
)
@form_option
@output_option
@outside_option
@debug_option
def command(debug: bool, **options: Any) -> int:
    """Re-check the certificates of a report from the mesh files.

    satcheck --certificate -o REPORT.json A B writes such a report. Its verdicts are checked in
    rational arithmetic, without the solver. A verdict without a certificate (an estimate below
    --accuracy exact, for instance) is not certified and does not pass.

    Exit codes: 0, every verdict is accepted; 1, a verdict is rejected or not certified; 2, wrong
    usage, an unreadable report, no certificate in it, a missing mesh file, or an internal error.
    """
    from satcheck.cli.verifying import Choices, run

    del debug
    options["form"] = form_of(options["form"], options["output"])
    return run(Choices(**options))
