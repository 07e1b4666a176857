"""The finding of one pair: the verdict of the ladder, the requested figures, and their words.

The exact gap decides whether a clearance is kept, even if the touch band calls the pair touching.
An overlap has no gap, so it keeps no clearance.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.draft import Draft
from satcheck.audit.figures.depth import Depth, measure_depth
from satcheck.audit.figures.gap import measure_gap
from satcheck.audit.figures.touch_band import Band, band_of, touch_band
from satcheck.audit.figures.volume import NOTHING, common_volume
from satcheck.audit.ladder.enclosing_pieces import open_pieces_around
from satcheck.audit.ladder.ladder import boxes_verdict, settle, why_open
from satcheck.audit.request.trace import Trace
from satcheck.report.components import Components
from satcheck.report.contacts import Contacts
from satcheck.report.judge import (
    Judgement,
    by_rule,
    clearance_judgement,
    disputed,
    judged,
    named,
)
from satcheck.report.report import OVERLAPS, Finding, finding_id
from satcheck.scene.files.readers import is_complete

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.audit.figures.thickness_ahead import Ahead
    from satcheck.core import Climb

INCOMPLETE = "not proven: the reader of a file may have left something out"
OPEN_BAND = "undecided: whether that is within the tolerance"


class Examined(Struct, frozen=True):
    """A finding and what it follows from."""

    finding: Finding
    draft: Draft


def examine(pair: Pair, trace: Trace, climb: Climb | None = None) -> Examined:
    """Computes everything that is requested for one pair. Warnings go to the trace. climb: the
    climb of the core; None: not made yet."""
    draft = Draft(pair, trace, settle(pair, trace, climb))
    undecided = _why_open(draft)
    if undecided is None:
        with _thickness_ahead(draft) as ahead:
            if draft.verdict.relation in OVERLAPS:
                undecided = _overlap(draft)
            else:
                _gap(draft)
            if undecided is None:
                _add_extras(draft, ahead)
    if undecided is not None:
        return Examined(indeterminate(pair.a.id, pair.b.id, undecided, trace), draft)
    return Examined(_judged(draft), draft)


def _judged(draft: Draft) -> Finding:
    """Return the finding that the stages have drafted, with its severity."""
    pair, gap = draft.pair, draft.gap
    contradiction = _contradiction(draft)
    was_proven = draft.proven
    _cap(draft)
    finding = draft.finding()
    bounds, kept = ((0.0, 0.0), None) if gap is None else ((gap.lower, gap.upper), gap.kept)
    judgement = judged(finding, pair.request, bounds, kept)
    if not was_proven:
        judgement = _of_estimate(judgement, finding, pair, overlaps=draft.verdict.overlaps)
    if contradiction is not None:
        judgement = disputed(judgement, contradiction)
    return replace(
        finding,
        severity=judgement.severity,
        rule=judgement.rule,
        undecided=judgement.undecided,
        reason=finding.reason or judgement.reason,
    )


def _of_estimate(
    judgement: Judgement, finding: Finding, pair: Pair, *, overlaps: bool
) -> Judgement:
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


def apart_by_boxes(pair: Pair) -> Examined:
    """A pair that the broad phase settled."""
    trace, asked = Trace(), pair.request.by
    verdict = boxes_verdict(pair, trace)
    if verdict is None:
        raise RuntimeError(f"the broad phase dropped {pair.a.id} and {pair.b.id}")
    draft = Draft(pair, trace, verdict, "separated", "separated")
    draft.volume = NOTHING if "volume" in asked else None
    draft.contacts = Contacts() if "contacts" in asked else None
    draft.components = Components() if "components" in asked else None
    _cap(draft)
    return Examined(draft.finding(), draft)


def deep_overlap(pair: Pair) -> Finding:
    """Return the finding of bodies that are proven to overlap by more than the touch band, while
    neither holds the other. No figure is requested."""
    trace = Trace()
    trace.record("sort", "penetrating", "an overlap beyond the touch band")
    verdict = Verdict("penetrating", proven=True)
    return _judged(Draft(pair, trace, verdict, "penetrating", "penetrating"))


def open_by_fill(pair: Pair, hole: core.OpenHole) -> Finding:
    """Return the finding of bodies with separate surfaces of which the fill of this hole decides
    whether they overlap."""
    trace = Trace()
    trace.record("sort", "indeterminate", "the fill of a hole decides")
    return indeterminate(pair.a.id, pair.b.id, why_open(pair, hole), trace)


def indeterminate(a: str, b: str, reason: str, trace: Trace) -> Finding:
    return Finding(
        id=finding_id(a, b),
        a=a,
        b=b,
        severity="warning",
        undecided="relation",
        relation="indeterminate",
        reason=reason,
        plan=tuple(trace.stages),
    )


def _cap(draft: Draft) -> None:
    """Make the draft an estimate if a reader may have left out what would overlap. The issue of the
    file keeps the check from passing, until somebody accepts it."""
    bodies = draft.pair.a, draft.pair.b
    known = all(is_complete(placed.body.file.format) for placed in bodies)
    if not known and draft.relation not in OVERLAPS:
        draft.proven, draft.reason = False, draft.reason or INCOMPLETE


def _why_open(draft: Draft) -> str | None:
    """Return the reason why the relation is undecided; None: it is decided."""
    relation = draft.verdict.relation
    if relation == "indeterminate":
        return draft.verdict.reason or "undecided"
    return open_pieces_around(draft.pair) if relation in ("separated", "touching") else None


def _thickness_ahead(draft: Draft) -> AbstractContextManager[Ahead | None]:
    """The search for the thickness of the only pair, if it runs beside that for the depth."""
    pair = draft.pair
    both = pair.request.wants("depth") and pair.request.wants("thickness")
    if not (pair.alone and both and draft.verdict.relation in OVERLAPS):
        return nullcontext()
    from satcheck.audit.figures.thickness_ahead import thickness_ahead

    return thickness_ahead(pair)


def _add_extras(draft: Draft, ahead: Ahead | None) -> None:
    """Adds the figures that are computed only on request."""
    pair, verdict, trace, asked = draft.pair, draft.verdict, draft.trace, draft.pair.request.by
    if "thickness" in asked and verdict.relation in OVERLAPS:
        _add_thickness(draft, ahead)
    if pair.curved:
        from satcheck.audit.figures.curved import without_meshes

        draft.reason = without_meshes(draft.reason, pair, trace)
        return
    if "volume" in asked:
        draft.volume = common_volume(pair, verdict, trace)
        draft.reason = draft.reason or draft.volume.refusal
    if "contacts" in asked:
        from satcheck.audit.figures.contacts import find_contacts

        draft.contacts = find_contacts(pair, verdict, trace)
    if "components" in asked:
        from satcheck.audit.figures.components import find_components

        draft.components = find_components(pair, verdict, trace)


def _add_thickness(draft: Draft, ahead: Ahead | None) -> None:
    from satcheck.audit.figures.thickness import STAGE, measure_thickness, why_not_thick

    why_not = why_not_thick(draft.pair)
    if why_not is None:
        draft.thickness = measure_thickness(draft.pair, draft.depth, draft.trace, ahead)
        return
    draft.trace.record(STAGE, "not known", why_not)
    draft.reason = draft.reason or f"no thickness: {why_not}"


def _contradiction(draft: Draft) -> str | None:
    """The answer of another library that contradicts the relation; None: no contradiction."""
    if draft.pair.peers is None or draft.pair.curved:
        return None
    from satcheck.audit.cross_check import say

    return say(draft.pair, draft.verdict, draft.pair.peers, draft.trace)


def _weakness(pair: Pair, verdict: Verdict) -> str | None:
    """The reason why an answer is weaker than a proof; None: it is proven. Separate hulls prove
    their relation."""
    if verdict.reason is not None:
        return verdict.reason
    if not verdict.proven:
        return _unproven(pair) if not pair.may("exact") else "a degenerate contact was sampled"
    return None


def _unproven(pair: Pair) -> str:
    return f"not proven at --accuracy {pair.settings.accuracy}"


def _overlap(draft: Draft) -> str | None:
    """Fills in what is known of an overlap. Returns why it is unknown whether the overlap is within
    the tolerance; None: it is known."""
    pair, verdict, trace = draft.pair, draft.verdict, draft.trace
    band = touch_band(pair, verdict, trace)
    guess = band.side == "within" and not verdict.proven
    depth = None
    if pair.request.wants("depth") and not guess:
        depth = measure_depth(pair, verdict, band.move, trace)
    if depth is not None and band.side in ("open", "hidden"):
        band = _band_of_depth(pair, depth) or band
    if band.side == "hidden":
        return f"undecided: {band.why}"
    is_open = pair.curved and verdict.signed_distance is not None and band.side == "open"
    draft.relation = named(verdict.relation, band.side == "within")
    shown = verdict.proven
    draft.reason = _weakness(pair, verdict) or (OPEN_BAND if is_open else None)
    if pair.excuses and draft.relation in OVERLAPS:
        draft.reason = draft.reason or _unexcused(pair, band)
    if pair.closer:
        from satcheck.audit.figures.curve_error import depth_of_curves, overlap_of_curves

        depth = depth and depth_of_curves(pair, verdict, depth, trace)
        shown = shown and overlap_of_curves(pair, verdict)
    draft.exact_relation = verdict.relation if shown else None
    draft.proven, draft.band, draft.depth = verdict.proven, band, depth
    return None


def _unexcused(pair: Pair, band: Band) -> str | None:
    """The reason why a surface tolerance does not apply; None: it applies."""
    from satcheck.audit.figures.thickness import why_not_thick

    why_not = why_not_thick(pair) or band.unexcused
    return None if why_not is None else f"the surface tolerance excuses nothing: {why_not}"


def _band_of_depth(pair: Pair, depth: Depth) -> Band | None:
    """The touch band by the translation that frees A; None: it is not verified, or the depth
    exceeds the tolerance."""
    if not depth.escape.verified or depth.lower > pair.tolerance:
        return None
    return band_of(pair, depth.escape.mtv)


def _gap(draft: Draft) -> None:
    """Fills in what is known of bodies without a common interior."""
    pair, verdict = draft.pair, draft.verdict
    gap = measure_gap(pair, verdict, draft.trace)
    if pair.closer:
        from satcheck.audit.figures.curve_error import gap_of_curves

        gap = gap_of_curves(pair, gap)
    proven, reason = verdict.proven, _weakness(pair, verdict)
    kept = True if gap.kept is None and gap.distance is not None else gap.kept
    draft.relation = relation = named(verdict.relation, gap.within, kept)
    if gap.within:
        # The band is proven, even if it is unknown whether the bodies overlap a little.
        proven = proven or _overlaps_within(verdict, pair.tolerance)
    elif relation == "near" and kept is None:
        proven, reason = False, _open_gap(pair)
    elif relation == "separated" and gap.within is None:
        reason = reason or OPEN_BAND
    shown = verdict.proven
    if pair.closer and gap.lower == 0:  # the curves may meet
        shown = False
        if pair.tolerance < pair.closer:
            proven, reason = False, reason or _within_curves(pair)
    draft.gap, draft.reason = gap, reason
    draft.exact_relation, draft.proven = verdict.relation if shown else None, proven


def _within_curves(pair: Pair) -> str:
    return f"undecided: the curves may be {pair.closer:.3g} off their polygons"


def _overlaps_within(verdict: Verdict, tolerance: float) -> bool:
    """Return whether any overlap of two convex bodies is proven to be at most the tolerance
    deep."""
    lower = None if verdict.signed_distance is None else verdict.signed_distance.lower
    return lower is not None and lower >= -tolerance


def _open_gap(pair: Pair) -> str:
    if not pair.may("exact"):
        return f"the gap is {_unproven(pair)}"
    return "the gap may be less: the fill of a hole may be nearer than the surface"
