"""The format of reports that programs of buildings read."""

from __future__ import annotations

from satcheck.cli.formats.registry import Format

FORMATS = (
    Format(
        "bcf", (".bcf",), "satcheck.plugins.ifc.bcf.archive:render", "picture", "topics (BCF 3.0)"
    ),
)
