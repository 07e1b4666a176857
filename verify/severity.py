"""The severity of a finding, held against what its certificate proves.

That an overlap is within its limit, or a gap keeps its clearance, has to be proven. That it is not
follows from the figures of the finding. Volumes are not certified.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import inf

from msgspec.structs import replace

from satcheck.report.judge import by_rule, disputed, judged
from satcheck.report.report import CROSS_CHECK, OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.evidence import vector
from satcheck.verify.exact import Rejected, dot, root


@dataclass(frozen=True, slots=True)
class ProvenFields:
    """Which fields of an accepted finding are proven. distance: how far it may be off; None: it is
    not proven. ball: with the lower end of the thickness. thickness: its upper end."""

    depth: bool = False
    mtv: bool = False
    distance: Fraction | None = None
    normal: bool = False
    contacts: bool = False
    ball: bool = False
    thickness: bool = False


@dataclass(frozen=True, slots=True)
class ProvenFigures:
    """The needs of a judgement besides the relation.

    depth_at_most, thickness_at_most: proven upper bounds. keeps: whether the gap has at least this
    length; None: undecided. rounding: the relative width that a limit is granted.
    """

    depth_at_most: Fraction | None
    thickness_at_most: Fraction | None
    keeps: Callable[[Fraction], bool | None]
    rounding: Fraction

    def within(self, request: Request) -> bool:
        """Return whether the overlap is proven to be within all limits."""
        bounds = (
            (request.max_depth, self.depth_at_most),
            (request.max_thickness, self.thickness_at_most),
            (request.max_volume, None),
        )
        return all(
            bound is not None and bound <= Fraction(limit) * (1 + self.rounding)
            for limit, bound in bounds
            if limit is not None
        )


def check_severity(finding: Finding, request: Request, proven: ProvenFigures) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow."""
    kept, overlap = None, finding.relation in OVERLAPS
    if request.clearance and not overlap and finding.relation != "near":
        kept = proven.keeps(Fraction(request.clearance))
    judgement = judged(finding, replace(request, severity=None), (0.0, inf), kept)
    if overlap and judgement.severity == "note" and not proven.within(request):
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


def proven_depth(finding: Finding, proven: ProvenFields) -> Fraction | None:
    """An upper bound, world units, of the depth that is certified; None: none is."""
    bounds = []
    if proven.depth and finding.depth is not None:
        bounds.append(Fraction(finding.depth))
    if proven.mtv and finding.mtv is not None:
        move = vector(finding.mtv)
        bounds.append(root(dot(move, move))[1])
    return min(bounds, default=None)
