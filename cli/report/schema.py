"""The JSON Schemas (2020-12) of the documents, as published in the package."""

from __future__ import annotations

from pathlib import Path

HERE = Path(__file__).parent


def text(name: str = "report") -> str:
    """The schema of one kind of document: `report` of a check, or `stability`."""
    return (HERE / f"{name}.schema.json").read_text(encoding="utf-8")
