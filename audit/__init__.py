"""satcheck.audit: checks the pairs of a scene, and makes the report."""

from __future__ import annotations

from satcheck.audit.check import check
from satcheck.audit.settings import Settings
from satcheck.report.components import Component, Components
from satcheck.report.contacts import Contacts, ContactTotals, Curve, Patch
from satcheck.report.report import (
    BodyReport,
    Finding,
    Issue,
    PairCounts,
    PartError,
    Report,
    Stage,
    Summary,
    Tool,
    Witness,
)

__all__ = [
    "BodyReport",
    "Component",
    "Components",
    "ContactTotals",
    "Contacts",
    "Curve",
    "Finding",
    "Issue",
    "PairCounts",
    "PartError",
    "Patch",
    "Report",
    "Settings",
    "Stage",
    "Summary",
    "Tool",
    "Witness",
    "check",
]
