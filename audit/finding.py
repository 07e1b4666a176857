"""The finding of one pair: the verdict of the ladder, the requested figures, and their words.

The exact gap decides whether a clearance is kept, even if the touch band calls the pair touching.
An overlap has no gap, so it keeps no clearance.
"""

from __future__ import annotations

import hashlib
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.answer import Answer
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.verdict import Verdict
from satcheck.audit.figures.depth import Depth, measure_depth
from satcheck.audit.figures.gap import Gap, measure_gap
from satcheck.audit.figures.touch_band import Band, band_of, touch_band
from satcheck.audit.figures.volume import NOTHING, common_volume
from satcheck.audit.ladder.enclosing_pieces import open_pieces_around
from satcheck.audit.ladder.ladder import boxes_verdict, settle
from satcheck.audit.request.trace import Trace
from satcheck.audit.severity import of_estimate
from satcheck.report.components import Components
from satcheck.report.contacts import Contacts
from satcheck.report.judge import EXACT_WIDTH, disputed, judged
from satcheck.report.report import OVERLAPS, Finding, Quality, Relation, Vector
from satcheck.scene.loading.readers import is_complete

if TYPE_CHECKING:
    from satcheck.audit.figures.thickness_ahead import Ahead
    from satcheck.core import Climb

ID_DIGITS = 12
INCOMPLETE = "not proven: the reader of a file may have left something out"
OPEN_BAND = "undecided: whether that is within the tolerance"


class Examined(Struct, frozen=True):
    """A finding and the results that it follows from. answer: None if the relation is undecided."""

    finding: Finding
    verdict: Verdict
    answer: Answer | None = None


def finding_id(a: str, b: str) -> str:
    """An id that depends on the two bodies only, and not on their order, poses or result."""
    key = f"{a}\0{b}" if a < b else f"{b}\0{a}"
    return hashlib.sha256(key.encode(errors="surrogatepass")).hexdigest()[:ID_DIGITS]


def examine(pair: Pair, trace: Trace, climb: Climb | None = None) -> Examined:
    """Computes everything that is requested for one pair. Warnings go to the trace. climb: the
    climb of the core; None: not made yet."""
    verdict = settle(pair, trace, climb)
    reason = _why_open(pair, verdict)
    if reason is not None:
        return Examined(indeterminate(pair.a.id, pair.b.id, reason, trace), verdict)
    with _thickness_ahead(pair, verdict) as ahead:
        if verdict.relation in OVERLAPS:
            answer = _overlapping(pair, verdict, trace)
        else:
            answer = _apart(pair, verdict, trace)
        if isinstance(answer, str):
            reason = f"undecided: {answer}"
            return Examined(indeterminate(pair.a.id, pair.b.id, reason, trace), verdict)
        answer = _with_extras(answer, pair, verdict, trace, ahead)
    contradiction = _contradiction(pair, verdict, trace)
    draft, gap = _draft(pair, _capped(answer, pair), trace), answer.gap
    bounds, kept = ((0.0, 0.0), None) if gap is None else ((gap.lower, gap.upper), gap.kept)
    judgement = judged(draft, pair.request, bounds, kept)
    if answer.quality == "estimate":
        judgement = of_estimate(judgement, draft, pair, overlaps=verdict.overlaps)
    if contradiction is not None:
        judgement = disputed(judgement, contradiction)
    finding = replace(
        draft,
        severity=judgement.severity,
        rule=judgement.rule,
        undecided=judgement.undecided,
        reason=draft.reason or judgement.reason,
    )
    return Examined(finding, verdict, answer)


def apart_by_boxes(pair: Pair) -> Examined:
    """A pair that the broad phase settled."""
    trace = Trace()
    verdict = boxes_verdict(pair, trace)
    if verdict is None:
        raise RuntimeError(f"the broad phase dropped {pair.a.id} and {pair.b.id}")
    answer = Answer(
        "separated",
        "separated",
        "exact",
        volume=NOTHING if pair.request.wants("volume") else None,
        contacts=Contacts() if pair.request.wants("contacts") else None,
        components=Components() if pair.request.wants("components") else None,
    )
    return Examined(_draft(pair, _capped(answer, pair), trace), verdict, answer)


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


def _capped(answer: Answer, pair: Pair) -> Answer:
    """Return the answer as an estimate if a reader may have left out what would overlap. The issue
    of the file keeps the check from passing, until somebody accepts it."""
    known = all(is_complete(placed.body.file.format) for placed in (pair.a, pair.b))
    if known or answer.relation in OVERLAPS:
        return answer
    return replace(answer, quality="estimate", reason=answer.reason or INCOMPLETE)


def _why_open(pair: Pair, verdict: Verdict) -> str | None:
    """The reason why the relation is undecided; None: it is decided."""
    if verdict.relation == "indeterminate":
        return verdict.reason or "undecided"
    if verdict.relation in ("separated", "touching"):
        return open_pieces_around(pair)
    return None


def _thickness_ahead(pair: Pair, verdict: Verdict) -> AbstractContextManager[Ahead | None]:
    """The search for the thickness of the only pair, if it runs beside that for the depth."""
    both = pair.request.wants("depth") and pair.request.wants("thickness")
    if not (pair.alone and both and verdict.relation in OVERLAPS):
        return nullcontext()
    from satcheck.audit.figures.thickness_ahead import thickness_ahead

    return thickness_ahead(pair)


def _with_extras(
    answer: Answer, pair: Pair, verdict: Verdict, trace: Trace, ahead: Ahead | None
) -> Answer:
    """Adds the figures that are computed only on request."""
    asked = pair.request.by
    if "thickness" in asked and verdict.relation in OVERLAPS:
        answer = _with_thickness(answer, pair, trace, ahead)
    if pair.curved:
        from satcheck.audit.figures.curved import without_meshes

        reason = without_meshes(answer.reason, pair, trace)
        return answer if reason is answer.reason else replace(answer, reason=reason)
    if "volume" in asked:
        volume = common_volume(pair, verdict, trace)
        answer = replace(answer, volume=volume, reason=answer.reason or volume.refusal)
    if "contacts" in asked:
        from satcheck.audit.figures.contacts import find_contacts

        answer = replace(answer, contacts=find_contacts(pair, verdict, trace))
    if "components" in asked:
        from satcheck.audit.figures.components import find_components

        answer = replace(answer, components=find_components(pair, verdict, trace))
    return answer


def _with_thickness(answer: Answer, pair: Pair, trace: Trace, ahead: Ahead | None) -> Answer:
    from satcheck.audit.figures.thickness import STAGE, measure_thickness, why_not_thick

    why_not = why_not_thick(pair)
    if why_not is None:
        return replace(answer, thickness=measure_thickness(pair, answer.depth, trace, ahead))
    trace.record(STAGE, "not known", why_not)
    return replace(answer, reason=answer.reason or f"no thickness: {why_not}")


def _contradiction(pair: Pair, verdict: Verdict, trace: Trace) -> str | None:
    """The answer of another library that contradicts the relation; None: no contradiction."""
    if pair.peers is None or pair.curved:
        return None
    from satcheck.audit.cross_check import say

    return say(pair, verdict, pair.peers, trace)


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


def _overlapping(pair: Pair, verdict: Verdict, trace: Trace) -> Answer | str:
    """The answer for an overlap. A text instead: the reason why it is unknown whether the overlap
    is within the tolerance."""
    band = touch_band(pair, verdict, trace)
    guess = band.side == "within" and not verdict.proven
    depth = None if guess else _depth(pair, verdict, band.move, trace)
    if depth is not None and band.side in ("open", "hidden"):
        band = _band_of_depth(pair, depth) or band
    if band.side == "hidden":
        return band.why
    is_open = pair.curved and verdict.signed_distance is not None and band.side == "open"
    relation: Relation = "touching" if band.side == "within" else verdict.relation
    proven = shown = verdict.proven
    reason = _weakness(pair, verdict) or (OPEN_BAND if is_open else None)
    if pair.excuses and relation in OVERLAPS:
        reason = reason or _unexcused(pair, band)
    if pair.closer:
        from satcheck.audit.figures.curve_error import depth_of_curves, overlap_of_curves

        depth = depth and depth_of_curves(pair, verdict, depth, trace)
        shown = proven and overlap_of_curves(pair, verdict)
    return Answer(
        relation,
        verdict.relation if shown else None,
        _depth_quality(depth, proven=proven),
        reason,
        band=band,
        depth=depth,
    )


def _unexcused(pair: Pair, band: Band) -> str | None:
    """The reason why a surface tolerance does not apply; None: it applies."""
    from satcheck.audit.figures.thickness import why_not_thick

    why_not = why_not_thick(pair) or band.unexcused
    return None if why_not is None else f"the surface tolerance excuses nothing: {why_not}"


def _depth(pair: Pair, verdict: Verdict, move: Vector | None, trace: Trace) -> Depth | None:
    return measure_depth(pair, verdict, move, trace) if pair.request.wants("depth") else None


def _band_of_depth(pair: Pair, depth: Depth) -> Band | None:
    """The touch band by the translation that frees A; None: it is not verified, or the depth
    exceeds the tolerance."""
    if not depth.escape.verified or depth.lower > pair.tolerance:
        return None
    return band_of(pair, depth.escape.mtv)


def _depth_quality(depth: Depth | None, *, proven: bool) -> Quality:
    if not proven:
        return "estimate"
    if depth is None or depth.upper - depth.lower <= EXACT_WIDTH * depth.upper:
        return "exact"
    return "bounded"


def _apart(pair: Pair, verdict: Verdict, trace: Trace) -> Answer:
    gap = measure_gap(pair, verdict, trace)
    if pair.closer:
        from satcheck.audit.figures.curve_error import gap_of_curves

        gap = gap_of_curves(pair, gap)
    relation, proven, reason = verdict.relation, verdict.proven, _weakness(pair, verdict)
    if gap.within:
        relation = "touching"
        # The band is proven, even if it is unknown whether the bodies overlap a little.
        proven = proven or _overlaps_within(verdict, pair.tolerance)
    elif relation == "separated":
        guess = gap.kept is None and gap.distance is None
        if gap.kept is False or guess:
            relation = "near"
        elif gap.within is None:
            reason = reason or OPEN_BAND
        if guess:
            proven, reason = False, _open_gap(pair)
    shown = verdict.proven
    if pair.closer and gap.lower == 0:  # the curves may meet
        shown = False
        if pair.tolerance < pair.closer:
            proven, reason = False, reason or _within_curves(pair)
    at_best: Quality = "bounded" if _has_bounds(pair, gap) else "exact"
    quality = at_best if proven else "estimate"
    return Answer(relation, verdict.relation if shown else None, quality, reason, gap=gap)


def _has_bounds(pair: Pair, gap: Gap) -> bool:
    """Return whether the finding states bounds of the gap."""
    return _is_shown(pair, gap) and (pair.closer > 0 or not gap.exact)


def _is_shown(pair: Pair, gap: Gap) -> bool:
    """Return whether the finding states the gap."""
    return pair.request.clearance is not None and gap.distance is not None


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


def _draft(pair: Pair, answer: Answer, trace: Trace) -> Finding:
    """Return the finding, not yet judged."""
    depth, thick, volume = answer.depth, answer.thickness, answer.volume
    gap = answer.gap if answer.gap is not None and _is_shown(pair, answer.gap) else None
    bounds = gap is not None and _has_bounds(pair, gap)
    figure = gap if depth is None else depth  # a pair has at most one of them
    return Finding(
        id=finding_id(pair.a.id, pair.b.id),
        a=pair.a.id,
        b=pair.b.id,
        severity="none",
        relation=answer.relation,
        exact_relation=answer.exact_relation,
        tolerance=pair.tolerance,
        distance=None if gap is None else gap.distance,
        distance_bounds=None if gap is None or not bounds else (gap.lower, gap.upper),
        depth=None if depth is None else depth.upper,
        depth_bounds=None if depth is None else (depth.lower, depth.upper),
        quality=answer.quality,
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
        contacts=answer.contacts,
        components=answer.components,
        reason=answer.reason,
        plan=tuple(trace.stages),
    )
