"""Reports as text."""

from __future__ import annotations

import re

from msgspec.structs import replace

from satcheck.cli.formats.table import render
from satcheck.cli.output import PLAIN_PAGE, Page
from satcheck.report.sweep import Place, Sweep
from tests.cli.reports import (
    HIT,
    PENETRATING,
    report,
)

UNMEASURED = replace(PENETRATING, b="other", depth=None, depth_bounds=None)


WAY = Sweep(
    relation="penetrating",
    tolerance=0.0,
    reached=0.5,
    time_of_impact=(0.25, 0.5),
    at=(Place("passer", "degrees", 60.0),),
    point=(1.5, 2.0, 0.0),
)


HIT_AT_60 = replace(HIT, motion=WAY)


ESCAPES = re.compile(r"\x1b\[[0-9;]*m")


def shown(*findings: object, page: Page = PLAIN_PAGE, asked: str = "", **options: bool) -> str:
    """asked: a setting that is on."""
    made = report(*findings)  # type: ignore[arg-type]
    if asked:
        made = replace(made, settings=replace(made.settings, **{asked: True}))
    return render(
        made,
        page,
        explain=options.get("explain", False),
        timings=options.get("timings", True),
    )
