"""Drawings, SVG and DXF: flat shapes bounded by contours, for checks in a plane."""

from __future__ import annotations

from pathlib import Path

DRAWINGS = {".svg": "svg", ".dxf": "dxf"}


def is_drawing(location: Path) -> bool:
    return location.suffix.lower() in DRAWINGS
