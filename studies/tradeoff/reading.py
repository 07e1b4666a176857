"""What a finding says: where its climb ended, and the signed distance.

Signed distance: > 0 a gap, < 0 an overlap, as deep as the shortest translation that ends it.
"""

from __future__ import annotations

import math

from satcheck.audit.bodies.verdict import Verdict
from satcheck.report.report import Finding, Relation
from satcheck.studies.tradeoff.result import ClimbEnd, Figure, Truth

# Stages of a trace that are rungs, and how they are called here.
STAGES = {"aabb": "aabb", "obb": "obb", "sat": "hull", "hull": "hull", "curved": "hull"}
STAGES |= {"curved-exact": "hull", "parts": "parts", "triangles": "exact"}
# What a stage records that had nothing to add to the one below.
SKIPPED = "skipped"


def climb_end(finding: Finding) -> ClimbEnd:
    """The last stage that is a rung ended the climb; those before say why they could not."""
    climbed = [stage for stage in finding.plan if stage.stage in STAGES]
    said = [
        f"{stage.stage} {stage.result}" + (f" ({stage.detail})" if stage.detail else "")
        for stage in climbed
    ]
    ran = [STAGES[stage.stage] for stage in climbed if stage.result != SKIPPED]
    settled = finding.exact_relation is not None and is_of_bodies(finding)
    if not settled and finding.reason is not None:
        said.append(finding.reason)
    return ClimbEnd(ran[-1] if ran else "none", settled, "; ".join(said))


def is_of_bodies(finding: Finding) -> bool:
    """Whether it says how the bodies relate, not their surfaces alone, or nothing."""
    return finding.undecided not in ("relation", "inside")


def figure_of(finding: Finding, verdict: Verdict) -> Figure | None:
    """verdict: of the same ladder, for what it proves and nobody asked to report. None: no figure
    of the bodies; how far their surfaces are apart says nothing of one that may lie inside."""
    if not is_of_bodies(finding):
        return None
    if finding.depth_bounds is not None:
        low, high = finding.depth_bounds
        # An overlap that is not proven may be a gap, of any width.
        return Figure(-high + 0.0, -high + 0.0, -low + 0.0 if verdict.proven else None)
    signed = verdict.signed_distance
    if signed is not None and signed.distance is not None:
        return Figure(signed.distance, signed.lower, signed.upper)
    if finding.distance is not None:
        return Figure(finding.distance, finding.distance, finding.distance)
    if verdict.relation == "separated":
        return Figure(verdict.gap_lower, verdict.gap_lower if verdict.proven else None, None)
    if verdict.relation == "touching":
        return Figure(0.0, 0.0, 0.0)
    band = finding.tolerance
    return None if finding.relation != "touching" or band is None else Figure(0.0, -band, None)


def truth_of(finding: Finding, figure: Figure | None, pad: float) -> Truth:
    relation = plain(finding.relation)
    if finding.exact_relation is None or not is_of_bodies(finding):
        return Truth(None, None, pad, finding.reason or "the exact rung has not proven it")
    known = figure is not None and figure.width is not None and math.isfinite(figure.width)
    return Truth(relation, figure if known else None, pad, finding.reason)


def plain(relation: Relation) -> Relation:
    """Without the clearance that is asked only to have the gap measured."""
    return "separated" if relation == "near" else relation
