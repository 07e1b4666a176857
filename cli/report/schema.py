"""The JSON Schema (2020-12) of the report, as published in the package."""

from __future__ import annotations

from pathlib import Path

FILE = Path(__file__).with_name("report.schema.json")


def text() -> str:
    """The schema document."""
    return FILE.read_text(encoding="utf-8")
