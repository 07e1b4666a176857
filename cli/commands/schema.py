"""`satcheck schema [DOCUMENT]`."""

from __future__ import annotations

import json
from typing import Any

import click
from msgspec import Struct

from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.config import options_of_commands
from satcheck.cli.format_option import FormatChoice
from satcheck.cli.formats import registry
from satcheck.cli.output import Document
from satcheck.report.assets import AssetsReport, Result
from satcheck.report.axes import AxesReport
from satcheck.report.colliders import CollidersReport
from satcheck.report.decomposition import DecompositionReport
from satcheck.report.report import Report
from satcheck.report.resolution import ResolutionReport
from satcheck.report.samples import SamplesReport
from satcheck.report.schema import schema_of
from satcheck.report.suggestions import SuggestionsReport
from satcheck.report.tradeoff import TradeoffReport
from satcheck.report.verification import VerificationReport
from satcheck.scene.files import readers
from satcheck.scene.units import LENGTH_PATTERN

STRUCTS: dict[str, type[Struct]] = {
    "assets": AssetsReport,
    "axes": AxesReport,
    "colliders": CollidersReport,
    "decomposition": DecompositionReport,
    "report": Report,
    "resolution": ResolutionReport,
    "result": Result,
    "samples": SamplesReport,
    "suggestions": SuggestionsReport,
    "tradeoff": TradeoffReport,
    "verification": VerificationReport,
}
DOCUMENTS = ("report", *sorted({"config", "scene", *STRUCTS} - {"report"}))


@click.command("schema", cls=Command, context_settings=HELP_NAMES)
@click.argument("document", type=click.Choice(DOCUMENTS), default=DOCUMENTS[0])
def command(document: str) -> None:
    """Print the JSON Schema of a kind of document.

    report describes a check, assets many of them, samples a robot in many poses, config the options
    in satcheck.toml, result a line of the results of batch, resolution the result of resolve,
    suggestions that of suggest, verification that of verify.
    """
    Document().write(text(document), utf8=True)


def text(name: str = "report") -> str:
    """Return the schema of one of DOCUMENTS."""
    if name == "scene":
        from satcheck.scene.scene_file.schema import schema as scene_schema

        return json.dumps(scene_schema(), indent=2) + "\n"
    if name == "config":
        return _of_config()
    return json.dumps(schema_of(name, STRUCTS[name]), indent=2) + "\n"


def _of_config() -> str:
    """The options, also those of the readers and formats of other packages."""
    readers.add_others()
    registry.add_others()
    properties = {key: _property(option) for key, option in options_of_commands().items()}
    document = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "satcheck.toml, and [tool.satcheck] of pyproject.toml",
        "type": "object",
        "additionalProperties": False,
        "properties": dict(sorted(properties.items())),
    }
    return json.dumps(document, indent=2) + "\n"


def _property(option: click.Option) -> dict[str, Any]:
    described = {"description": " ".join((option.help or "").split("[default")[0].split())}
    if option.is_flag:
        return {"type": "boolean", **described}
    if option.nargs > 1:
        size = {"minItems": option.nargs, "maxItems": option.nargs}
        several = {"type": "array", "items": {"type": "string"}, **size}
        return {"type": "array", "items": several, **described}
    if option.multiple:
        texts = {"type": "array", "items": {"type": "string"}}
        return {"anyOf": [texts, {"type": "string"}], **described}
    return {**_kind(option.type), **described}


def _kind(kind: click.ParamType[Any]) -> dict[str, Any]:
    if isinstance(kind, FormatChoice):
        return {"enum": [*kind.known()]}
    if isinstance(kind, click.Choice):
        return {"enum": list(kind.choices)}
    if isinstance(kind, click.IntRange | click.FloatRange):
        return {"type": "integer" if isinstance(kind, click.IntRange) else "number"} | _range(kind)
    if isinstance(kind, click.types.FuncParamType):  # a length
        return {"type": ["number", "string"], "minimum": 0, "pattern": LENGTH_PATTERN}
    return {"type": "string"}


def _range(kind: click.IntRange | click.FloatRange) -> dict[str, Any]:
    ends = {
        "exclusiveMinimum" if kind.min_open else "minimum": kind.min,
        "exclusiveMaximum" if kind.max_open else "maximum": kind.max,
    }
    return {name: end for name, end in ends.items() if end is not None}
