"""How thick an overlap is: the diameter of the largest ball that lies in both bodies.

The core narrows a proven interval (`core.search_thickness`). Bodies that are not closed have no
inside that holds a ball for certain, so that their overlaps have no thickness.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.figures.search_progress import shown
from satcheck.audit.request.trace import Trace
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import Ball

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.figures.depth import Depth
    from satcheck.audit.figures.thickness_ahead import Ahead

STAGE = "thickness"


class Thickness(Struct, frozen=True):
    """World units: lower <= true thickness <= upper. ball: proven to lie in both bodies, as thick
    as lower; None where that is 0. proof: of upper, where certificates are asked for."""

    lower: float
    upper: float
    ball: Ball | None = None
    proof: core.ThicknessProof | None = None


def why_not_thick(pair: Pair) -> str | None:
    """Why an overlap has no thickness; None: it has one."""
    if pair.curved:
        return "a curved shape has no triangles"
    if not pair.may("exact") and not (pair.may("hull") and pair.both_convex):
        return f"found on triangles: not at --accuracy {pair.settings.accuracy}"
    return _open(pair.a) or _open(pair.b)


def _open(body: PlacedBody) -> str | None:
    """Why the body is not closed; None: it is."""
    if not body.solid:
        return f"{body.id} has {'holes' if body.body.file.health.holes else 'no inside'}"
    return f"{body.id} has sheets" if body.shared.has_sheets() else None


def measure_thickness(
    pair: Pair, depth: Depth | None, trace: Trace, ahead: Ahead | None = None
) -> Thickness:
    """Of an overlap of closed bodies. depth: where it is known; no overlap is thicker than that.
    ahead: the first search, if it has begun."""
    work, limit = pair.settings.thickness_work, pair.request.max_thickness
    if ahead is None:
        interval = first_search(pair)
        trace.record(STAGE, *_outcome_of(interval))
    else:
        interval = ahead.result()
        trace.add(STAGE, *_outcome_of(interval), ahead.nanoseconds)
    thickness = _thickness_of(interval)
    if limit is not None and thickness.lower <= limit < thickness.upper and interval.work < work:
        closer = _search(pair, EXACT_WIDTH, work - interval.work, limit)
        trace.record(STAGE, *_outcome_of(closer))
        thickness = _narrower(thickness, _thickness_of(closer))
    if pair.closer:
        thickness = _of_curves(pair, thickness)
    most = math.inf if depth is None else max(depth.upper, thickness.lower)
    return replace(thickness, upper=min(thickness.upper, most))


def first_search(pair: Pair, go_on: Callable[[], None] | None = None) -> core.ThicknessInterval:
    """To the width of the settings. go_on: called now and then; what it raises ends the search."""
    return _search(pair, pair.settings.thickness_width, pair.settings.thickness_work, None, go_on)


def _search(
    pair: Pair,
    width: float,
    work: int,
    limit: float | None,
    go_on: Callable[[], None] | None = None,
) -> core.ThicknessInterval:
    """limit: the search ends once the interval lies on one side of it."""
    with shown(STAGE, pair) as show:

        def progress(lower: float, upper: float, share: float) -> None:
            if go_on is not None:
                go_on()
            show(lower, upper, share)

        return core.search_thickness(
            pair.a.surface(),
            pair.b.surface(),
            width=width,
            work=work,
            limit=limit,
            across=across(pair, prove=pair.settings.certificate),
            prove=pair.settings.certificate,
            threads=pair.settings.jobs if pair.alone else 1,
            progress=progress,
        )


def _outcome_of(interval: core.ThicknessInterval) -> tuple[str, str]:
    """The result and the details of a search, for the trace."""
    by = f"from {interval.lower:.6g} to {interval.upper:.6g} by {interval.boxes} boxes of space"
    if interval.stop == "work spent":
        return "budget spent", f"{by}; the budget ended the search"
    return interval.stop, by


def across(pair: Pair, *, prove: bool) -> int:
    """The axis to search along. What is to be proven is searched in space: prisms are higher than
    they are wide, so that the largest ball in both has the diameter of the largest disc."""
    return -1 if prove else pair.settings.across


def _thickness_of(interval: core.ThicknessInterval) -> Thickness:
    ball = None
    if interval.centre is not None and interval.lower > 0:
        ball = Ball(interval.centre, interval.radius)
    return Thickness(max(interval.lower, 0.0), max(interval.upper, 0.0), ball, interval.proof)


def _narrower(one: Thickness, other: Thickness) -> Thickness:
    thicker = max(one, other, key=lambda thickness: thickness.lower)
    thinner = min(one, other, key=lambda thickness: thickness.upper)
    return Thickness(thicker.lower, thinner.upper, thicker.ball, thinner.proof)


def _of_curves(pair: Pair, thickness: Thickness) -> Thickness:
    """In a check in a plane: of curves, from that of the polygons within them."""
    more = max(body.body.file.deviation for body in (pair.a, pair.b))
    return Thickness(thickness.lower, thickness.upper + 2 * more, thickness.ball)
