"""Where a climb ended, and what each rung on the way said: read from the trace of a finding."""

from __future__ import annotations

from satcheck.report.report import Finding
from satcheck.studies.tradeoff.figure import is_of_bodies
from satcheck.studies.tradeoff.result import Picked

# Stages of a trace that are rungs, and how they are called here.
STAGES = {"aabb": "aabb", "obb": "obb", "sat": "hull", "hull": "hull", "curved": "hull"}
STAGES |= {"curved-exact": "hull", "parts": "parts", "triangles": "exact"}
# What a stage records that had nothing to add to the one below.
SKIPPED = "skipped"


def picked(finding: Finding) -> Picked:
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
    return Picked(ran[-1] if ran else "none", settled, "; ".join(said))
