"""What rules ask of a pair, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats.numbers import number
from satcheck.cli.formats.words import with_unit
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import Finding, Report, RuleReport


def rule_of(finding: Finding, report: Report) -> RuleReport | None:
    """The rule of the scene that decided the severity; None, too, where several have its name, as
    those of one line do."""
    named = [rule for rule in report.rules if rule.name == finding.rule]
    return named[0] if len(named) == 1 else None


def limits(finding: Finding, report: Report) -> list[str]:
    """What the pair is held against: `clearance 5 mm`; of an overlap `max_depth 1 mm`."""
    unit, rule = unit_of(report.units), rule_of(finding, report)
    if finding.relation not in OVERLAPS:
        own = None if rule is None else rule.clearance
        asked = {"clearance": (report.settings.clearance if own is None else own, "")}
    elif rule is None:
        return []
    else:
        asked = {
            "max_depth": (rule.max_depth, ""),
            "max_thickness": (rule.max_thickness, ""),
            "max_volume": (rule.max_volume, "^3"),
        }
    return [
        f"{name} {with_unit(number(limit), unit and unit + power)}"
        for name, (limit, power) in asked.items()
        if limit is not None
    ]
