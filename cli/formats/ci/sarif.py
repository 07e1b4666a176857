"""SARIF 2.1.0 (OASIS, Static Analysis Results Interchange Format), as code scanning services read
it. A result is a finding or an issue of an input; reports without any have a run without results.

A body is where a scene file or a robot states it; otherwise at line 1 of its mesh file.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from satcheck.audit.summary import tool
from satcheck.cli.formats.ci.problems import KINDS, Problem, uri, worst_problems
from satcheck.cli.formats.summary import config_lines
from satcheck.report.json import document

if TYPE_CHECKING:
    from satcheck.cli.formats.registry import Reports

SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)
# GitHub refuses a run with more results.
MOST_RESULTS = 25_000
# What makes a link in a message.
_MARKUP = re.compile(r"([\\\[\]])")


def render(reports: Reports) -> list[str]:
    kept, left_out = worst_problems(reports, MOST_RESULTS)
    driver = tool()
    kinds = list(dict.fromkeys(problem.kind for problem in kept))
    run = {
        "tool": {
            "driver": {
                "name": driver.name,
                "semanticVersion": driver.version,
                "rules": [_rule(kind) for kind in kinds],
            }
        },
        "columnKind": "unicodeCodePoints",
        "invocations": [_invocation(reports, left_out=left_out)],
        "results": [_result(problem, kinds.index(problem.kind)) for problem in kept],
    }
    return [document({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]})]


def _rule(kind: str) -> dict[str, Any]:
    text = KINDS.get(kind, f"The inspection of an input reports {kind}.")
    return {"id": kind, "shortDescription": {"text": text}}


def _invocation(reports: Reports, left_out: int) -> dict[str, Any]:
    """left_out: results beyond the limit."""
    notes = []
    if left_out:
        text = f"{left_out} more results, none graver than those here, are left out."
        notes.append({"level": "warning", "message": {"text": text}})
    return {
        "executionSuccessful": all(
            report.summary.verdict != "incomplete" for report in reports.values()
        ),
        "toolExecutionNotifications": notes,
        "toolConfigurationNotifications": [
            {"level": "note", "message": {"text": line}} for line in config_lines(reports.values())
        ],
    }


_BASELINE_STATES = {
    "new": "new",
    "unchanged": "unchanged",
    "accepted": "unchanged",
    "worse": "updated",
    "undecided": "updated",
}


def _result(problem: Problem, rule: int) -> dict[str, Any]:
    locations = [_location(problem, number) for number in range(len(problem.places))]
    state = {} if problem.state is None else {"baselineState": _BASELINE_STATES[problem.state]}
    return {
        **state,
        "ruleId": problem.kind,
        "ruleIndex": rule,
        "level": problem.level,
        "message": {"text": _MARKUP.sub(r"\\\1", problem.message)},
        "locations": locations[:1],
        "relatedLocations": locations[1:],
        "partialFingerprints": {"satcheckId/v1": problem.id},
    }


def _location(problem: Problem, number: int) -> dict[str, Any]:
    bodies, place = problem.bodies[number : number + 1], problem.places[number]
    return {
        "physicalLocation": {
            "artifactLocation": {"uri": uri(place.file)},
            "region": {"startLine": place.line},
        },
        "logicalLocations": [{"fullyQualifiedName": body, "kind": "object"} for body in bodies],
    }
