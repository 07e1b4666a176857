"""The judgement of a pair of which not everything is proven."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.report.judge import Judgement, by_rule, clearance_judgement
from satcheck.report.report import OVERLAPS, Finding


def of_estimate(judgement: Judgement, finding: Finding, pair: Pair, *, overlaps: bool) -> Judgement:
    """Return the judgement of an estimate. An unproven relation does not pass, and an unproven
    overlap does not fail, unless --accuracy or --allow-open accepts estimates. overlaps: an overlap
    is proven, even if the relation is not."""
    settings = pair.settings
    if settings.accuracy != "exact" or settings.allow_open:
        return judgement
    if finding.relation in OVERLAPS and overlaps:
        is_proven = finding.mtv_verified or not judgement.passes
        return judgement if is_proven else judgement.warned("relation")
    if finding.relation in OVERLAPS:  # or a gap that may keep no clearance
        close = clearance_judgement(pair.request, 0.0, 0.0)
        if close is not None and close.severity == "error":
            return by_rule(close, pair.request).warned("relation")
        return replace(judgement, severity="warning").warned("relation")
    return judgement.warned("relation") if judgement.passes else judgement
