"""The stage `components`: the connected components of an overlap. It runs only on request."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from satcheck import core
from satcheck.audit.draft import Draft
from satcheck.audit.pair import Pair
from satcheck.audit.stages.contacts import MAX_TRIANGLE_PAIRS
from satcheck.core.conventions import SMALLEST_SIZE
from satcheck.report.contacts import Component, Components, Passing
from satcheck.report.report import OVERLAPS, Vector

STAGE = "components"
TOO_MUCH = "too many triangles meet, or it takes more steps than a pair may"


class Ball(Struct, frozen=True):
    """lower <= thickness of a component <= upper. centre: of a ball as thick as lower; None: that
    is 0."""

    lower: float
    upper: float
    centre: Vector | None = None


def find_components(draft: Draft) -> None:
    """Find the components of the exact relation, whatever the touch band."""
    pair = draft.pair
    if draft.exact_proven and draft.exact not in OVERLAPS:
        draft.components = Components()
        return
    if not pair.both_solid:
        draft.record(STAGE, "not resolved", "a body is not closed")
        draft.components = Components(resolved=False)
        return
    a, b = pair.a.surface(), pair.b.surface()
    overlap = core.overlap_components(a, b, MAX_TRIANGLE_PAIRS)
    items = [
        _described(component, ball, pair)
        for component, ball in zip(overlap.components, _balls(pair, overlap), strict=True)
    ]
    items.sort(key=lambda item: (item.thickness_bounds or (0.0, 0.0))[1], reverse=True)
    if overlap.within_limits:
        detail = "" if overlap.resolved else "there may be others: a surface meets itself"
        draft.record(STAGE, f"{len(items)} found", detail)
    else:
        draft.record(STAGE, "not resolved", TOO_MUCH)
    draft.components = Components(tuple(items), overlap.resolved)


def _balls(pair: Pair, overlap: core.OverlapComponents) -> Iterator[Ball]:
    """The thickness of each component; what is not convex is searched, within the budget of the
    pair."""
    a, b, width = pair.a.surface(), pair.b.surface(), pair.settings.width
    components = overlap.components
    work = pair.thickness_work
    for place, hull in enumerate(core.component_balls(a, b, overlap)):
        component, ball = components[place], Ball(hull.lower, hull.upper, hull.centre)
        is_open = ball.upper - ball.lower > width * ball.upper
        size = max(high - low for low, high in zip(*component.bounds, strict=True))
        if component.resolved and is_open and size >= SMALLEST_SIZE:  # else it is not searched
            others = [other.bounds for other in components[:place] + components[place + 1 :]]
            share = work // (len(components) - place)
            with pair.searching(
                f"component {place + 1} of {len(components)}, thickness"
            ) as progress:
                search = core.search_thickness(
                    a, b, width=width, work=share, within=component, progress=progress
                )
            work -= min(work, search.work)
            ball = _narrowed(ball, search, others if overlap.resolved else None)
        yield ball


def _narrowed(
    ball: Ball, search: core.ThicknessInterval, others: list[tuple[Vector, Vector]] | None
) -> Ball:
    """others: the bounds of the other components, None: not known. A ball with its centre in them
    may belong to another component, and says nothing."""
    upper, centre = min(ball.upper, max(search.upper, 0.0)), search.centre
    same = Ball(min(ball.lower, upper), upper, ball.centre)
    if centre is None or others is None or search.lower <= ball.lower:
        return same
    if any(_holds(box, centre) for box in others):
        return same
    return Ball(min(search.lower, upper), upper, centre)


def _holds(box: tuple[Vector, Vector], point: Vector) -> bool:
    return all(low <= c <= high for low, c, high in zip(box[0], point, box[1], strict=True))


def _described(component: core.OverlapComponent, ball: Ball, pair: Pair) -> Component:
    asked = pair.request.wants("volume")
    return Component(
        bounds=component.bounds,
        point=component.point if ball.centre is None else ball.centre,
        thickness_bounds=(ball.lower, ball.upper) if component.resolved else None,
        volume=max(component.volume, 0.0) if asked else None,
        volume_error=component.volume_error if asked else None,
        curves=component.curves,
        curve_length=component.curve_length,
        passes=_passing(component.a_through_b, component.b_through_a),
        resolved=component.resolved,
    )


def _passing(a_through_b: bool | None, b_through_a: bool | None) -> Passing | None:
    if a_through_b is None or b_through_a is None:
        return None
    if a_through_b and b_through_a:
        return "both"
    return "a-through-b" if a_through_b else "b-through-a" if b_through_a else "none"
