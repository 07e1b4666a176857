"""`satcheck schema [DOCUMENT]`."""

from __future__ import annotations

import json

import click
from msgspec import Struct

from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.output import Document
from satcheck.report.assets import AssetsReport
from satcheck.report.axes import AxesReport
from satcheck.report.batch import Result
from satcheck.report.decomposition import DecompositionReport
from satcheck.report.report import Report
from satcheck.report.resolution import ResolutionReport
from satcheck.report.samples import SamplesReport
from satcheck.report.schema import schema_of
from satcheck.report.suggestions import SuggestionsReport
from satcheck.report.tradeoff import TradeoffReport
from satcheck.report.verification import VerificationReport

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


STRUCTS: dict[str, type[Struct]] = {
    "assets": AssetsReport,
    "axes": AxesReport,
    "decomposition": DecompositionReport,
    "report": Report,
    "resolution": ResolutionReport,
    "result": Result,
    "samples": SamplesReport,
    "suggestions": SuggestionsReport,
    "tradeoff": TradeoffReport,
    "verification": VerificationReport,
}


def text(name: str = "report") -> str:
    """The schema of one kind of document: `report` of a check, `assets`, `axes`, `decomposition`,
    `resolution`, `result`, `samples`, `suggestions`, `tradeoff`,
    `verification`; `scene`; `config`."""
    if name == "scene":
        from satcheck.scene.format.schema import schema as scene_schema

        return json.dumps(scene_schema(), indent=2) + "\n"
    if name == "config":
        from satcheck.cli.config.schema import schema

        return schema()
    return json.dumps(schema_of(name, STRUCTS[name]), indent=2) + "\n"
