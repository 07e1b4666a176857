"""The separating axis theorem on one pair: the report about the candidate axes of two bodies of a
scene, of their convex hulls in space, or of those of their outlines in a plane."""

from __future__ import annotations

import numpy as np

from satcheck import core
from satcheck.audit.body import PlacedBody
from satcheck.audit.pair import Pair
from satcheck.audit.settings import Settings
from satcheck.audit.studied_pair import pair_of, two_of
from satcheck.audit.summary import tool
from satcheck.core.axes import (
    Candidates,
    Hull,
    corners_of,
    edge_pairs,
    first_parallel,
    hull_of,
    outline_of,
    shadows,
    unit_of,
    with_faces,
)
from satcheck.core.conventions import Plane, axis_across
from satcheck.core.conventions import axes_of as axes_in
from satcheck.core.errors import SatcheckError
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report import axes as report
from satcheck.scene import Scene

# Candidates that are compared in some seconds.
MOST_EDGE_PAIRS = 10_000_000
MOST_FACET_PAIRS = 250_000
# Of a gap that follows from integers: quotients, root and product.
VALUE_ROUNDOFFS = 8

RELATIONS: dict[str, report.HullRelation] = {
    "separating": "separated",
    "touching": "touching",
    "mtv": "penetrating",
}
# By the sign of the gap.
_STATES: dict[int, report.AxisState] = {1: "gap", 0: "touch", -1: "overlap"}


def axes_of(
    scene: Scene,
    bodies: tuple[str, str] | None = None,
    *,
    planar: Plane | None = None,
    allow_open: bool = False,
) -> report.AxesReport:
    """bodies: the ids of A and B; None: the scene has only two.

    Raises SatcheckError: `not-a-pair`, `no-such-body`, `curved-shape` (it has no faces),
    `flat-bodies` (both are flat and parallel, or one is less than a polygon), `too-many-axes`, and
    the codes of bodies that cannot be used.
    """
    if planar is None:
        scene.require_in_space("add --planar xy")
    else:
        from satcheck.scene.planar.flat_scene import flat_scene

        scene = flat_scene(scene, planar, allow_open=allow_open)
    settings = Settings(planar=planar, allow_open=allow_open)
    pair = pair_of(two_of(scene, bodies), settings)
    first, second = _hulls(pair, planar)
    answer = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), method="gjk")
    relation: report.HullRelation = (
        "indeterminate" if answer.outcome == "undecided" else answer.outcome
    )
    a, b = _stated(pair.a, first, planar), _stated(pair.b, second, planar)
    closer = pair.closer if planar else None
    counts, axes = _compared(first, second, relation, (a, b), closer)
    winner = winner_of(axes)
    if pair.closer and winner is None:
        relation = "indeterminate"
    return report.AxesReport(
        tool=tool(),
        units=pair.a.body.units,
        planar=planar,
        of="bodies" if a.convex and b.convex else "hulls",
        a=a,
        b=b,
        relation=relation,
        distance=answer.distance if planar is None else None,
        tolerance=pair.tolerance,
        gjk_steps=answer.gjk_iterations + answer.epa_iterations if planar is None else None,
        counts=counts,
        early_out=early_out(axes),
        winner=winner if winner and RELATIONS[winner.kind] == relation else None,
        axes=tuple(sorted(axes, key=lambda axis: -axis.gap)),
        left_out=0,
    )


def _hulls(pair: Pair, planar: Plane | None) -> list[Hull]:
    """Return the hulls, in a plane the convex outlines."""
    both = pair.a, pair.b
    if planar is None:
        polytopes = [_polytope(body) for body in both]
        made = zip(polytopes, corners_of(*(each.vertices for each in polytopes)), both, strict=True)
        return [hull_of(polytope, corners, body.resolution) for polytope, corners, body in made]
    from satcheck.scene.planar.region import convex_region

    outlines = []
    for body in both:
        points = convex_region(body.mesh, planar).points
        outlines.append(np.zeros((len(points), 3)))
        outlines[-1][:, axes_in(planar)] = points
    flat = zip(corners_of(*outlines), both, strict=True)
    return [outline_of(corners, axis_across(planar), body.resolution) for corners, body in flat]


def _polytope(body: PlacedBody) -> core.Polytope:
    if body.curved is not None:
        message = "a curved shape has no faces: every direction is a candidate axis"
        raise SatcheckError("curved-shape", message, body=body.id)
    hull = body.hull()
    if hull.dimension < 2:
        message = f"its hull is a {('point', 'segment')[hull.dimension]}, which has no faces"
        raise SatcheckError("flat-bodies", message, body=body.id)
    return hull


def _stated(body: PlacedBody, hull: Hull, planar: Plane | None) -> report.AxesBody:
    file, corners = body.body.file, len(hull.corners.world)
    convex = file.outline is not None if planar else body.convex
    faces, edges = (0, hull.faces) if planar else (hull.faces, hull.sides)
    return report.AxesBody(body.id, file.path, convex, corners, faces, edges)


def _compared(
    a: Hull,
    b: Hull,
    relation: report.HullRelation,
    stated: tuple[report.AxesBody, report.AxesBody],
    closer: float | None,
) -> tuple[report.AxisCounts, list[report.CandidateAxis]]:
    """Return how many candidates there are, and the axes in the order of testing. relation: by the
    check of the two hulls. Pairs of edges that are noise are only looked at where it needs them."""
    count = len(a.edges) * len(b.edges)
    _require_few(*stated, count, MOST_EDGE_PAIRS, "pairs of edges of triangles")
    pairs = edge_pairs(a, b)
    for kept in (pairs.plain, pairs.plain | True):
        what = "pairs of edges that can make a face of their Minkowski difference"
        _require_few(*stated, int(kept.sum()), MOST_FACET_PAIRS, what)
        axes = axes_shown(a, b, pairs.where(kept), closer)
        if closer is not None or relation_shown(axes) == relation:
            break
    else:
        if max(a.faces, b.faces) == 2:
            message = "both bodies are flat and in one plane: give --planar with that plane"
            raise SatcheckError("flat-bodies", message)
    (faces_a, edges_a), (faces_b, edges_b) = a.directions, b.directions
    counts = report.AxisCounts(
        candidates=a.faces + b.faces + a.sides * b.sides,
        edge_pairs=a.sides * b.sides,
        facet_pairs=int(pairs.plain.sum()),
        directions=(faces_a, faces_b, edges_a * edges_b),
        distinct=len(axes),
    )
    return counts, axes


def _require_few(a: report.AxesBody, b: report.AxesBody, count: int, limit: int, what: str) -> None:
    if count <= limit:
        return
    message = (
        f"the hulls of {a.id} ({a.faces:,} faces, {a.edges:,} edges) and {b.id} ({b.faces:,} "
        f"faces, {b.edges:,} edges) have {count:,} {what}, and axes compares {limit:,} at most. "
        "Their number is the product of the numbers of edges. A check asks GJK for a few support "
        "points instead: satcheck A B. For the axes, give meshes with fewer faces"
    )
    raise SatcheckError("too-many-axes", message)


def axes_shown(
    a: Hull, b: Hull, pairs: Candidates, closer: float | None = None
) -> list[report.CandidateAxis]:
    """The axes in the order of testing; of parallel candidates the one with the largest gap.

    closer: in a plane, how much smaller any gap may be than that of the polygons, because they lie
    within curves; None: in space.
    """
    normals, made = with_faces(a, b, pairs)
    unit = unit_of(normals)
    rows = zip(normals, unit, strict=True)
    found = [shadows(normal, along, a.corners, b.corners) for normal, along in rows]
    groups: dict[int, list[int]] = {}
    for row, first in enumerate(first_parallel(unit, made.tolerance).tolist()):
        groups.setdefault(first, []).append(row)
    axes = []
    for number, (first, group) in enumerate(groups.items(), 1):
        best = max((found[row] for row in group), key=lambda each: each.gap)
        index_a, index_b = made.index[first].tolist()
        off = VALUE_ROUNDOFFS * UNIT_ROUNDOFF * abs(best.gap)
        low, high = best.gap - off - (closer or 0.0), best.gap + off
        known = not closer or low > 0 or high < 0
        axes.append(
            report.CandidateAxis(
                number=number,
                kind=_kind(index_a, index_b, planar=closer is not None),
                index_a=None if index_a < 0 else index_a,
                index_b=None if index_b < 0 else index_b,
                candidates=len(
                    {tuple(made.index[row].tolist()) for row in group if made.plain[row]}
                ),
                direction=best.direction,
                shadow_a=best.a,
                shadow_b=best.b,
                gap=best.gap,
                gap_bounds=(low, high),
                state=_STATES[best.sign] if known else "unknown",
            )
        )
    return axes


def _kind(index_a: int, index_b: int, *, planar: bool) -> report.AxisKind:
    if index_b < 0:
        return "edge-a" if planar else "face-a"
    if index_a < 0:
        return "edge-b" if planar else "face-b"
    return "edge-edge"


def winner_of(axes: list[report.CandidateAxis]) -> report.AxesWinner | None:
    """None where an axis is unknown that could change it."""
    best = max(axes, key=lambda axis: axis.gap)
    length = abs(best.gap)
    if best.state == "gap":
        return report.AxesWinner("separating", best.number, length, None)
    if any(axis.state == "unknown" for axis in axes):
        return None
    if best.state == "touch":
        return report.AxesWinner("touching", best.number, 0.0, None)
    x, y, z = (0.0 - length * part for part in best.direction)
    return report.AxesWinner("mtv", best.number, length, (x, y, z))


def relation_shown(axes: list[report.CandidateAxis]) -> report.HullRelation:
    winner = winner_of(axes)
    return "indeterminate" if winner is None else RELATIONS[winner.kind]


def early_out(axes: list[report.CandidateAxis]) -> report.EarlyOut:
    first = next((axis.number for axis in axes if axis.state == "gap"), None)
    stop = first or len(axes)
    return report.EarlyOut(stop, len(axes) - stop, first)
