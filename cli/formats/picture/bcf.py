"""Findings as topics of BCF 3.0, each with a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats import bcf

if TYPE_CHECKING:
    from satcheck.report.report import Report
    from satcheck.scene import Scene


def render(report: Report, scene: Scene) -> bytes:
    return bcf.render(report, scene)
