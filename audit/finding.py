"""The finding of one pair: its stages in order, then the judgement of what they found.

The exact gap decides whether a clearance is kept, even if the touch band calls the pair touching.
An overlap has no gap, so it keeps no clearance. What decides `touching` is `report.judge.named`.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter_ns
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.draft import Band, Depth, Draft
from satcheck.audit.stages.components import find_components
from satcheck.audit.stages.contacts import find_contacts
from satcheck.audit.stages.cross_check import ask_peers
from satcheck.audit.stages.depth import measure_depth
from satcheck.audit.stages.gap import measure_gap
from satcheck.audit.stages.relation import apart_by_boxes, settle, why_open
from satcheck.audit.stages.thickness import measure_thickness, thickness_ahead, why_not_thick
from satcheck.audit.stages.touch_band import band_of, touch_band
from satcheck.audit.stages.volume import measure_volume
from satcheck.report.contacts import Components, Contacts
from satcheck.report.judge import (
    Judgement,
    by_rule,
    clearance_judgement,
    disputed,
    judged,
    named,
)
from satcheck.report.report import OVERLAPS, Effect, Finding

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair
    from satcheck.core import Climb

INCOMPLETE = "not proven: the reader of a file may have left something out"
OPEN_BAND = "undecided: whether that is within the tolerance"
OPEN_GAP = "the gap is not known: measuring it takes too many steps"


def _find_part_pairs(draft: Draft) -> None:
    from satcheck.audit.stages.part_pairs import find_part_pairs  # a check without parts is faster

    find_part_pairs(draft)


# The stages that run on request, in their order, after those that decide the relation. A curved
# shape has none of those on triangles.
STAGES: dict[Effect, Callable[[Draft], None]] = {
    "thickness": measure_thickness,
    "volume": measure_volume,
    "contacts": find_contacts,
    "components": find_components,
    "part-pairs": _find_part_pairs,
    "cross-check": ask_peers,
}


def examine(draft: Draft, climb: Climb | None = None) -> Finding:
    """Compute everything that is requested for the pair of a draft, which keeps what the stages
    find. climb: of the core; None: not made yet."""
    settle(draft, climb)
    undecided = why_open(draft)
    if undecided is None:
        with thickness_ahead(draft):
            if draft.exact in OVERLAPS:
                undecided = _find_overlap(draft)
            else:
                _find_gap(draft)
            if undecided is None:
                _run_on_request(draft)
    return _judged_draft(draft) if undecided is None else draft.indeterminate(undecided)


def measure(draft: Draft) -> Finding:
    """Return the finding of a drafted overlap with the depth and the thickness that its request
    asks for by now."""
    draft.since = perf_counter_ns()
    wants = draft.pair.request.wants
    undecided = _find_overlap(draft) if wants("depth") and draft.depth is None else None
    if undecided is not None:
        return draft.indeterminate(undecided)
    if wants("thickness") and draft.thickness is None:
        measure_thickness(draft)
    return _judged_draft(draft)


def examine_boxes(draft: Draft) -> Finding:
    """Return the finding of a pair that the broad phase settled."""
    if not apart_by_boxes(draft):
        raise RuntimeError(f"the broad phase dropped {draft.pair.a.id} and {draft.pair.b.id}")
    asked = draft.pair.request.by
    draft.relation = draft.exact_relation = "separated"
    draft.volume = draft.volume_error = 0.0 if "volume" in asked else None
    draft.contacts = Contacts() if "contacts" in asked else None
    draft.components = Components() if "components" in asked else None
    _cap(draft)
    return draft.finding(Judgement("none"))


def deep_overlap(pair: Pair) -> Finding:
    """Return the finding of bodies that are proven to overlap by more than the touch band, while
    neither holds the other. No figure is requested."""
    draft = Draft(pair, relation="penetrating", exact_relation="penetrating")
    draft.record("sort", "penetrating", "an overlap beyond the touch band")
    return _judged_draft(draft)


def _run_on_request(draft: Draft) -> None:
    by = draft.pair.request.by
    if by.keys().isdisjoint(STAGES):
        return
    if draft.pair.curved:
        from satcheck.audit.stages.curved import note_unavailable

        if draft.pair.request.wants("thickness"):
            measure_thickness(draft)
        if draft.pair.request.wants("part-pairs"):
            _find_part_pairs(draft)
        note_unavailable(draft)
        return
    for effect, run in STAGES.items():
        if effect in by:
            run(draft)


def _find_overlap(draft: Draft) -> str | None:
    """Find what is known of an overlap. Returns why it is unknown whether the overlap is within the
    tolerance; None: it is known."""
    pair = draft.pair
    band, depth = draft.band or touch_band(draft), None
    guess = band.side == "within" and not draft.exact_proven
    if pair.request.wants("depth") and not guess:
        depth = measure_depth(draft, band.move)
        if band.side in ("open", "hidden"):
            band = _band_of_depth(pair, depth) or band
    if band.side == "hidden":
        return f"undecided: {band.why}"
    is_open = pair.curved and draft.signed is not None and band.side == "open"
    draft.relation = named(draft.exact, band.side == "within")
    shown = draft.exact_proven
    draft.reason = _weakness(draft) or (OPEN_BAND if is_open else None)
    if pair.excuses and draft.relation in OVERLAPS:
        draft.reason = draft.reason or _unexcused(pair, band)
    if pair.closer:
        from satcheck.audit.stages.in_plane import depth_of_curves, overlap_of_curves

        depth = depth and depth_of_curves(draft, depth)
        shown = shown and overlap_of_curves(draft)
    draft.exact_relation = draft.exact if shown else None
    draft.proven, draft.band, draft.depth = draft.exact_proven, band, depth
    return None


def _band_of_depth(pair: Pair, depth: Depth) -> Band | None:
    """Return the touch band by the translation that frees A; None: it is not verified, or the depth
    exceeds the tolerance."""
    if not depth.escape.verified or depth.lower > pair.tolerance:
        return None
    return band_of(pair, depth.escape.mtv)


def _unexcused(pair: Pair, band: Band) -> str | None:
    """Return why a surface tolerance does not apply; None: it applies."""
    why_not = why_not_thick(pair) or band.unexcused
    return None if why_not is None else f"the surface tolerance excuses nothing: {why_not}"


def _find_gap(draft: Draft) -> None:
    """Find what is known of bodies without a common interior."""
    pair, gap = draft.pair, measure_gap(draft)
    if pair.closer:
        from satcheck.audit.stages.in_plane import gap_of_curves

        gap = gap_of_curves(pair, gap)
    proven, reason = draft.exact_proven, _weakness(draft)
    is_unmeasured = gap.distance is None and draft.climb is not None and draft.climb.too_few_steps
    kept = True if gap.kept is None and (gap.distance is not None or is_unmeasured) else gap.kept
    draft.relation = named(draft.exact, gap.within, kept)
    if gap.within:
        # The band is proven, even if it is unknown whether the bodies overlap a little.
        lower = None if draft.signed is None else draft.signed.lower
        proven = proven or (lower is not None and lower >= -pair.tolerance)
    elif draft.relation == "near" and kept is None:
        proven, reason = False, _open_gap(pair)
    elif draft.relation == "separated" and gap.within is None:
        reason = reason or (OPEN_GAP if is_unmeasured else OPEN_BAND)
        proven = proven and not (is_unmeasured and pair.settings.fail_on == "note")
    shown = draft.exact_proven
    if pair.closer and gap.lower == 0:  # the curves may meet
        shown = False
        if pair.tolerance < pair.closer:
            proven = False
            reason = reason or (
                f"undecided: the curves may be {pair.closer:.3g} off their polygons"
            )
    draft.gap, draft.reason, draft.proven = gap, reason, proven
    draft.exact_relation = draft.exact if shown else None


def _open_gap(pair: Pair) -> str:
    if not pair.may("exact"):
        return f"the gap is {_unproven(pair)}"
    return "the gap may be less: the fill of a hole may be nearer than the surface"


def _weakness(draft: Draft) -> str | None:
    """Return why an answer is weaker than a proof; None: it is proven. Separate hulls prove their
    relation."""
    if draft.weak is not None or draft.exact_proven:
        return draft.weak
    pair = draft.pair
    return "a degenerate contact was sampled" if pair.may("exact") else _unproven(pair)


def _unproven(pair: Pair) -> str:
    return f"not proven at --accuracy {pair.settings.accuracy}"


def _judged_draft(draft: Draft) -> Finding:
    """Return the finding that the stages have drafted, with its severity."""
    pair, gap = draft.pair, draft.gap
    was_proven = draft.proven
    _cap(draft)
    bounds, kept = ((0.0, 0.0), None) if gap is None else ((gap.lower, gap.upper), gap.kept)
    judgement = judged(draft, pair.request, bounds, kept)
    if not was_proven:
        judgement = _of_estimate(judgement, draft)
    if draft.disputed is not None:
        judgement = disputed(judgement, draft.disputed)
    return draft.finding(judgement)


def _of_estimate(judgement: Judgement, draft: Draft) -> Judgement:
    """Return the judgement of an estimate. An unproven relation does not pass, and an unproven
    overlap does not fail, unless --accuracy or --allow-open accepts estimates."""
    pair, settings = draft.pair, draft.pair.settings
    if settings.accuracy != "exact" or pair.open_on_purpose:
        return judgement
    if draft.relation in OVERLAPS and draft.overlaps:
        is_verified = draft.depth is not None and draft.depth.escape.verified
        is_proven = is_verified or not judgement.passes
        return judgement if is_proven else judgement.warned("relation")
    if draft.relation in OVERLAPS:  # or a gap that may keep no clearance
        close = clearance_judgement(pair.request, 0.0, 0.0)
        if close is not None and close.severity == "error":
            return by_rule(close, pair.request).warned("relation")
        return replace(judgement, severity="warning").warned("relation")
    return judgement.warned("relation") if judgement.passes else judgement


def _cap(draft: Draft) -> None:
    """Make the draft an estimate if a reader may have left out what would overlap. The issue of the
    file keeps the check from passing, until somebody accepts it."""
    known = draft.pair.a.shared.is_complete and draft.pair.b.shared.is_complete
    if not known and draft.relation not in OVERLAPS:
        draft.proven, draft.reason = False, draft.reason or INCOMPLETE
