"""The severity of a finding, held against what its certificate proves.

That an overlap is within its limit, or a gap keeps its clearance, has to be proven. That it is not
follows from the figures of the finding. Volumes are not certified.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import inf

from msgspec.structs import replace

from satcheck.report.judge import by_rule, disputed, judged
from satcheck.report.report import CROSS_CHECK, OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH

WIDER = 1 + EXACT_WIDTH  # the share of a limit that rounding is granted


def check_severity(
    finding: Finding,
    request: Request,
    most: tuple[Fraction | None, Fraction | None],
    keeps: Callable[[Fraction], bool | None],
) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow. most: proven upper bounds
    of depth and thickness. keeps: whether the gap has at least this length; None: undecided."""
    kept, overlap = None, finding.relation in OVERLAPS
    if request.clearance and not overlap and finding.relation != "near":
        kept = keeps(Fraction(request.clearance))
    judgement = judged(finding, replace(request, severity=None), (0.0, inf), kept)
    if overlap and judgement.severity == "note":
        limits = request.max_depth, request.max_thickness, request.max_volume
        for limit, bound in zip(limits, (*most, None), strict=True):
            if limit is not None and not (bound is not None and bound <= Fraction(limit) * WIDER):
                raise Rejected("that it is within its limits is not certified")
    judgement = by_rule(judgement, request)
    if any(stage.stage == CROSS_CHECK and stage.result == "disagrees" for stage in finding.plan):
        judgement = disputed(judgement, None)
    follows = judgement.severity, judgement.undecided, judgement.rule
    if (finding.severity, finding.undecided, finding.rule) != follows:
        raise Rejected(
            f"its severity is {judgement.severity!r} by the rule {judgement.rule!r}, "
            f"and what is undecided {judgement.undecided!r}"
        )
