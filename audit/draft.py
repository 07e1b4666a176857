"""What the stages have found about a pair, and the finding before it is judged."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.request.trace import Trace
from satcheck.report.judge import quality_of
from satcheck.report.report import Finding, Relation, finding_id

if TYPE_CHECKING:
    from satcheck.audit.figures.depth import Depth
    from satcheck.audit.figures.gap import Gap
    from satcheck.audit.figures.thickness import Thickness
    from satcheck.audit.figures.touch_band import Band
    from satcheck.audit.figures.volume import CommonVolume
    from satcheck.report.components import Components
    from satcheck.report.contacts import Contacts


class Draft(Struct):
    """Each stage fills in what it finds. verdict: of the ladder.

    relation: with the touch band. exact_relation: without it; None: not proven. proven: the
    relation, with the touch band. gap: of bodies without a common interior. band: of an overlap.
    depth, thickness, volume, contacts and components are None if they were not requested.
    """

    pair: Pair
    trace: Trace
    verdict: Verdict
    relation: Relation = "indeterminate"
    exact_relation: Relation | None = None
    proven: bool = True
    reason: str | None = None
    gap: Gap | None = None
    band: Band | None = None
    depth: Depth | None = None
    thickness: Thickness | None = None
    volume: CommonVolume | None = None
    contacts: Contacts | None = None
    components: Components | None = None

    def finding(self) -> Finding:
        """Return the finding, not yet judged."""
        pair, depth, thick, volume = self.pair, self.depth, self.thickness, self.volume
        gap = self.gap if pair.request.clearance is not None else None
        if gap is not None and gap.distance is None:
            gap = None
        figure = gap if depth is None else depth  # a pair has at most one of them
        depths = None if depth is None else (depth.lower, depth.upper)
        gaps = None
        if gap is not None and (pair.closer > 0 or not gap.exact):
            gaps = gap.lower, gap.upper
        return Finding(
            id=finding_id(pair.a.id, pair.b.id),
            a=pair.a.id,
            b=pair.b.id,
            severity="none",
            relation=self.relation,
            exact_relation=self.exact_relation,
            tolerance=pair.tolerance,
            distance=None if gap is None else gap.distance,
            distance_bounds=gaps,
            depth=None if depth is None else depth.upper,
            depth_bounds=depths,
            quality=quality_of(depths, gaps) if self.proven else "estimate",
            normal=None if figure is None else figure.normal,
            mtv=None if depth is None else depth.escape.mtv,
            mtv_moves=None if depth is None else "a",
            mtv_verified=None if depth is None else depth.escape.verified,
            witness=None if figure is None else figure.witness,
            thickness=None if thick is None else thick.upper,
            thickness_bounds=None if thick is None else (thick.lower, thick.upper),
            ball=None if thick is None else thick.ball,
            volume=None if volume is None else volume.volume,
            volume_error=None if volume is None else volume.error,
            contacts=self.contacts,
            components=self.components,
            reason=self.reason,
            plan=tuple(self.trace.stages),
        )
