"""The JSON Schemas (2020-12) of the documents."""

from __future__ import annotations

import json

from msgspec import Struct

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
