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
    STEPS_OFF,
    WORST_TOLERANCE,
    Candidates,
    Floats,
    Hull,
    Indices,
    candidates,
    direction_count,
    directions,
    first_parallel,
    hull_of,
    shadows,
)
from satcheck.core.conventions import Plane, axis_across
from satcheck.core.conventions import axes_of as axes_in
from satcheck.core.errors import SatcheckError
from satcheck.report import axes as report
from satcheck.scene import Scene

# Candidates that are compared in some seconds.
MOST_EDGE_PAIRS = 10_000_000
MOST_FACET_PAIRS = 250_000

RELATIONS: dict[str, report.HullRelation] = {
    "separating": "separated",
    "touching": "touching",
    "mtv": "penetrating",
}
# By the sign of the gap.
_STATES: dict[int, report.AxisState] = {1: "gap", 0: "touch", -1: "overlap"}


# Two hulls, or outlines, how many candidates they have, and their axes in the order of testing.
Compared = tuple[report.AxesBody, report.AxesBody, report.AxisCounts, list[report.CandidateAxis]]


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
    hulls = [] if planar else [_polytope(body) for body in (pair.a, pair.b)]
    answer = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), method="gjk")
    relation: report.HullRelation = (
        "indeterminate" if answer.outcome == "undecided" else answer.outcome
    )
    a, b, counts, axes = (
        _in_plane(pair, planar) if planar else _in_space(pair, *hulls, relation=relation)
    )
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


def _polytope(body: PlacedBody) -> core.Polytope:
    if body.curved is not None:
        message = "a curved shape has no faces: every direction is a candidate axis"
        raise SatcheckError("curved-shape", message, body=body.id)
    hull = body.hull()
    if hull.dimension < 2:
        message = f"its hull is a {('point', 'segment')[hull.dimension]}, which has no faces"
        raise SatcheckError("flat-bodies", message, body=body.id)
    return hull


def _in_space(
    pair: Pair, first: core.Polytope, second: core.Polytope, *, relation: report.HullRelation
) -> Compared:
    """relation: by the check of the two hulls. Pairs of edges that are noise are only looked at
    where it needs them."""
    world = np.concatenate((first.vertices, second.vertices))
    a = hull_of(first, 0, world, pair.a.resolution)
    b = hull_of(second, first.vertex_count, world, pair.b.resolution)
    stated = _stated(pair.a, a), _stated(pair.b, b)
    count = len(a.edges) * len(b.edges)
    _require_few(*stated, count, MOST_EDGE_PAIRS, "pairs of edges of triangles")
    made = candidates(a, b)
    faces = len(a.face) + len(b.face)
    for kept in (made.plain, made.plain | True):
        what = "pairs of edges that can make a face of their Minkowski difference"
        _require_few(*stated, int(kept.sum()) - faces, MOST_FACET_PAIRS, what)
        axes = axes_shown(made.where(kept), world, a.points, b.points)
        if relation_shown(axes) == relation:
            break
    else:
        if first.dimension == second.dimension == 2:
            message = "both bodies are flat and in one plane: give --planar with that plane"
            raise SatcheckError("flat-bodies", message)
    counts = report.AxisCounts(
        candidates=a.faces + b.faces + a.sides * b.sides,
        edge_pairs=a.sides * b.sides,
        facet_pairs=int(made.plain.sum()) - faces,
        directions=(
            direction_count(a.normal, a.face_off),
            direction_count(b.normal, b.face_off),
            _edge_directions(a) * _edge_directions(b),
        ),
        distinct=len(axes),
    )
    return *stated, counts, axes


def _edge_directions(hull: Hull) -> int:
    return direction_count(hull.along[: hull.sides], hull.edge_off[: hull.sides])


def _stated(body: PlacedBody, hull: Hull) -> report.AxesBody:
    file, corners = body.body.file.path, len(hull.points)
    return report.AxesBody(body.id, file, body.convex, corners, hull.faces, hull.sides)


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


def _in_plane(pair: Pair, plane: Plane) -> Compared:
    """The bodies are prisms; an axis is an edge of the outline turned by 90 degrees."""
    from satcheck.scene.planar.region import convex_region

    corners = [convex_region(body.mesh, plane).points for body in (pair.a, pair.b)]
    m, n = map(len, corners)
    # The corners in the plane, the origin, and the unit vector across the plane.
    world = np.zeros((m + n + 2, 3))
    world[:-2, axes_in(plane)] = np.concatenate(corners)
    world[-1, axis_across(plane)] = 1.0
    a, b = np.arange(m), m + np.arange(n)
    tails, heads = np.r_[a, b], np.r_[np.roll(a, -1), np.roll(b, -1)]
    axes = np.column_stack((tails, heads, np.full(m + n, m + n), np.full(m + n, m + n + 1)))
    steps = np.repeat((pair.a.resolution, pair.b.resolution), (m, n))
    length = np.linalg.norm(world[heads] - world[tails], axis=1)
    off = np.minimum(STEPS_OFF * steps / length, WORST_TOLERANCE)
    index = np.full((m + n, 2), -1)
    index[a, 0], index[b, 1] = a, b - m
    made = Candidates(axes, off, index, plain=np.full(m + n, True))
    shown = axes_shown(made, world, a, b, closer=pair.closer)
    unit, _ = directions(world, axes)
    differ = direction_count(unit[a], off[a]), direction_count(unit[b], off[b]), 0
    counts = report.AxisCounts(m + n, 0, 0, differ, len(shown))
    sides = ((body.id, body.body.file, n) for body, n in ((pair.a, m), (pair.b, n)))
    first, second = (
        report.AxesBody(id_, file.path, file.outline is not None, corners, 0, corners)
        for id_, file, corners in sides
    )
    return first, second, counts, shown


def axes_shown(
    made: Candidates, world: Floats, a: Indices, b: Indices, *, closer: float | None = None
) -> list[report.CandidateAxis]:
    """The axes in the order of testing; of parallel candidates the one with the largest gap.

    a, b: the points of each body. closer: in a plane, how much smaller any gap may be than that of
    the polygons, because they lie within curves; None: in space.
    """
    found = shadows(world, made.axes, a, b)
    first = first_parallel(found.direction, made.tolerance)
    order = np.argsort(first, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(first[order])) + 1)
    low, high = found.gap - found.off - (closer or 0.0), found.gap + found.off
    axes = []
    for number, group in enumerate(groups, 1):
        row = group[found.gap[group].argmax()]
        index_a, index_b = made.index[group[0]].tolist()
        features = made.index[group[made.plain[group]]].tolist()
        known = not closer or low[row] > 0 or high[row] < 0
        axes.append(
            report.CandidateAxis(
                number=number,
                kind=_kind(index_a, index_b, planar=closer is not None),
                index_a=None if index_a < 0 else index_a,
                index_b=None if index_b < 0 else index_b,
                candidates=len({*map(tuple, features)}),
                direction=tuple((found.direction[row] + 0.0).tolist()),
                shadow_a=tuple((found.a[row] + 0.0).tolist()),
                shadow_b=tuple((found.b[row] + 0.0).tolist()),
                gap=float(found.gap[row]) + 0.0,
                gap_bounds=(float(low[row]) + 0.0, float(high[row]) + 0.0),
                state=_STATES[int(found.sign[row])] if known else "unknown",
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
