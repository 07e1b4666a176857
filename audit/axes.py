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
from satcheck.core.axes.candidates import (
    STEPS_OFF,
    WORST_TOLERANCE,
    Candidates,
    Features,
    candidates,
    direction_count,
    edge_pairs,
    features_of,
    first_parallel,
)
from satcheck.core.axes.shadows import Floats, Indices, Points, shadows
from satcheck.core.conventions import Plane, axis_across
from satcheck.core.conventions import axes_of as axes_in
from satcheck.core.errors import SatcheckError
from satcheck.report.axes import (
    AxesBody,
    AxesReport,
    AxesWinner,
    AxisCounts,
    AxisKind,
    AxisState,
    CandidateAxis,
    EarlyOut,
    HullRelation,
)
from satcheck.scene import Scene

# Candidates that are compared in some seconds.
MOST_EDGE_PAIRS = 10_000_000
MOST_FACET_PAIRS = 250_000


RELATIONS: dict[str, HullRelation] = {
    "separating": "separated",
    "touching": "touching",
    "mtv": "penetrating",
}


def axes_of(
    scene: Scene,
    bodies: tuple[str, str] | None = None,
    *,
    planar: Plane | None = None,
    allow_open: bool = False,
) -> AxesReport:
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
    return _hulls(pair) if planar is None else _outlines(pair, planar)


def _report(
    pair: Pair,
    a: AxesBody,
    b: AxesBody,
    counts: AxisCounts,
    axes: list[CandidateAxis],
    relation: HullRelation,
    answer: core.PairResult | None = None,
) -> AxesReport:
    """axes: in the order of testing. relation, answer: of the check of convex pairs; no answer in a
    plane."""
    winner = winner_of(axes)
    return AxesReport(
        tool=tool(),
        units=pair.a.body.units,
        planar=pair.settings.planar,
        of="bodies" if a.convex and b.convex else "hulls",
        a=a,
        b=b,
        relation=relation,
        distance=None if answer is None else answer.distance,
        tolerance=pair.tolerance,
        gjk_steps=None if answer is None else answer.gjk_iterations + answer.epa_iterations,
        counts=counts,
        early_out=early_out(axes),
        winner=winner if winner and RELATIONS[winner.kind] == relation else None,
        axes=tuple(sorted(axes, key=lambda axis: -axis.gap)),
        left_out=0,
    )


def _hulls(pair: Pair) -> AxesReport:
    hull_a, hull_b = _hull(pair.a), _hull(pair.b)
    points = Points(np.concatenate((hull_a.vertices, hull_b.vertices)))
    a = features_of(hull_a, 0, points, pair.a.resolution)
    b = features_of(hull_b, hull_a.vertex_count, points, pair.b.resolution)
    stated = _stated(pair.a, a), _stated(pair.b, b)
    count = len(a.edges) * len(b.edges)
    _require_few(*stated, count, MOST_EDGE_PAIRS, "pairs of edges of triangles")
    pairs = edge_pairs(a, b)
    answer = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), method="gjk")
    relation: HullRelation = "indeterminate" if answer.outcome == "undecided" else answer.outcome
    axes: list[CandidateAxis] = []
    for noise in (False, True):
        if not axes or relation_shown(axes) != relation:
            what = "pairs of edges that can make a face of their Minkowski difference"
            _require_few(*stated, int((pairs.noise == noise).sum()), MOST_FACET_PAIRS, what)
            made = candidates(a, b, pairs, noise=noise)
            axes = axes_shown(made, points, a.points, b.points)
    if relation_shown(axes) != relation and hull_a.dimension == hull_b.dimension == 2:
        message = "both bodies are flat and in one plane: give --planar with that plane"
        raise SatcheckError("flat-bodies", message)
    proper = (pairs.rows < (a.sides, b.sides)).all(axis=1) & ~pairs.noise
    counts = AxisCounts(
        candidates=a.faces + b.faces + a.sides * b.sides,
        edge_pairs=a.sides * b.sides,
        facet_pairs=int(proper.sum()),
        directions=(
            direction_count(a.normal, a.face_off),
            direction_count(b.normal, b.face_off),
            _edge_directions(a) * _edge_directions(b),
        ),
        distinct=len(axes),
    )
    return _report(pair, *stated, counts, axes, relation, answer)


def _edge_directions(features: Features) -> int:
    sides = slice(features.sides)
    return direction_count(features.direction[sides], features.edge_off[sides])


def _hull(body: PlacedBody) -> core.Polytope:
    if body.curved is not None:
        message = "a curved shape has no faces: every direction is a candidate axis"
        raise SatcheckError("curved-shape", message, body=body.id)
    hull = body.hull()
    if hull.dimension < 2:
        message = f"its hull is a {('point', 'segment')[hull.dimension]}, which has no faces"
        raise SatcheckError("flat-bodies", message, body=body.id)
    return hull


def _stated(body: PlacedBody, features: Features) -> AxesBody:
    file, convex = body.body.file.path, body.convex
    return AxesBody(body.id, file, convex, len(features.points), features.faces, features.sides)


def _require_few(a: AxesBody, b: AxesBody, count: int, limit: int, what: str) -> None:
    if count <= limit:
        return
    message = (
        f"the hulls of {a.id} ({a.faces:,} faces, {a.edges:,} edges) and {b.id} ({b.faces:,} "
        f"faces, {b.edges:,} edges) have {count:,} {what}, and axes compares {limit:,} at most. "
        "Their number is the product of the numbers of edges. A check asks GJK for a few support "
        "points instead: satcheck A B. For the axes, give meshes with fewer faces"
    )
    raise SatcheckError("too-many-axes", message)


def _outlines(pair: Pair, plane: Plane) -> AxesReport:
    """The bodies of a pair in a plane are prisms; an axis is an edge of the outline turned by 90
    degrees."""
    corners_a, corners_b = _corners(pair.a, plane), _corners(pair.b, plane)
    m, n = len(corners_a), len(corners_b)
    # The corners in the plane, the origin, and the unit vector across the plane.
    world = np.zeros((m + n + 2, 3))
    world[:-2, axes_in(plane)] = np.concatenate((corners_a, corners_b))
    world[-1, axis_across(plane)] = 1.0
    a, b = np.arange(m), m + np.arange(n)
    edges = np.column_stack((np.r_[a, b], np.r_[np.roll(a, -1), np.roll(b, -1)]))
    along = world[edges[:, 1]] - world[edges[:, 0]]
    length = np.linalg.norm(along, axis=1)
    steps = np.repeat((pair.a.resolution, pair.b.resolution), (m, n))
    off = np.minimum(STEPS_OFF * steps / length, WORST_TOLERANCE)
    none = np.full(m + n, -1)
    made = Candidates(
        axes=np.column_stack((edges, np.full(m + n, m + n), np.full(m + n, m + n + 1))),
        tolerance=off,
        index=np.column_stack((np.r_[a, none[:n]], np.r_[none[:m], b - m])),
        counted=np.full(m + n, True),
    )
    axes = axes_shown(made, Points(world), a, b, closer=pair.closer)
    outcome = core.check_pair(_prism(corners_a), _prism(corners_b), query="overlap").outcome
    known = not pair.closer or winner_of(axes) is not None
    unit = along / length[:, None]
    directions = direction_count(unit[:m], off[:m]), direction_count(unit[m:], off[m:]), 0
    counts = AxisCounts(m + n, 0, 0, directions, len(axes))
    relation: HullRelation = "indeterminate" if not known or outcome == "undecided" else outcome
    return _report(pair, _outlined(pair.a, m), _outlined(pair.b, n), counts, axes, relation)


def _corners(body: PlacedBody, plane: Plane) -> Floats:
    """(n, 2), counter-clockwise, of the hull of the outline."""
    from satcheck.scene.planar.region import convex_region

    return np.ascontiguousarray(convex_region(body.mesh, plane).points)


def _prism(corners: Floats) -> core.Hull:
    """Two prisms of one height are apart, touch, or overlap as their outlines do."""
    ends = [np.column_stack((corners, np.full(len(corners), z))) for z in (0.0, 1.0)]
    return core.Hull(np.concatenate(ends))


def _outlined(body: PlacedBody, corners: int) -> AxesBody:
    file = body.body.file
    return AxesBody(body.id, file.path, file.outline is not None, corners, 0, corners)


def axes_shown(
    candidates: Candidates, points: Points, a: Indices, b: Indices, *, closer: float | None = None
) -> list[CandidateAxis]:
    """The axes in the order of testing; of parallel candidates the one with the largest gap.

    a, b: the points of each body. closer: in a plane, how much smaller any gap may be than that of
    the polygons, because they lie within curves; None: in space.
    """
    result = shadows(points, candidates.axes, a, b)
    first = first_parallel(result.direction, candidates.tolerance)
    order = np.argsort(first, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(first[order])) + 1)
    made = []
    for number, group in enumerate(groups, 1):
        row = group[result.gap[group].argmax()]
        low = result.gap[row] - result.off[row] - (closer or 0.0)
        high = result.gap[row] + result.off[row]
        index_a, index_b = candidates.index[group[0]].tolist()
        features = candidates.index[group[candidates.counted[group]]].tolist()
        x, y, z = (result.direction[row] + 0.0).tolist()
        made.append(
            CandidateAxis(
                number=number,
                kind=_kind(index_a, index_b, planar=closer is not None),
                index_a=None if index_a < 0 else index_a,
                index_b=None if index_b < 0 else index_b,
                candidates=len({*map(tuple, features)}),
                direction=(x, y, z),
                shadow_a=_interval(result.a[row]),
                shadow_b=_interval(result.b[row]),
                gap=float(result.gap[row]) + 0.0,
                gap_bounds=(float(low) + 0.0, float(high) + 0.0),
                state=_state(int(result.sign[row]), known=not closer or low > 0 or high < 0),
            )
        )
    return made


def _kind(index_a: int, index_b: int, *, planar: bool) -> AxisKind:
    if index_b < 0:
        return "edge-a" if planar else "face-a"
    if index_a < 0:
        return "edge-b" if planar else "face-b"
    return "edge-edge"


def _state(sign: int, *, known: bool) -> AxisState:
    if not known:
        return "unknown"
    return "gap" if sign > 0 else "overlap" if sign < 0 else "touch"


def _interval(values: Floats) -> tuple[float, float]:
    low, high = (values + 0.0).tolist()
    return low, high


def winner_of(axes: list[CandidateAxis]) -> AxesWinner | None:
    """None where an axis is unknown that could change it."""
    best = max(axes, key=lambda axis: axis.gap)
    length = abs(best.gap)
    if best.state == "gap":
        return AxesWinner("separating", best.number, length, None)
    if any(axis.state == "unknown" for axis in axes):
        return None
    if best.state == "touch":
        return AxesWinner("touching", best.number, 0.0, None)
    x, y, z = (0.0 - length * part for part in best.direction)
    return AxesWinner("mtv", best.number, length, (x, y, z))


def relation_shown(axes: list[CandidateAxis]) -> HullRelation:
    winner = winner_of(axes)
    return "indeterminate" if winner is None else RELATIONS[winner.kind]


def early_out(axes: list[CandidateAxis]) -> EarlyOut:
    first = next((axis.number for axis in axes if axis.state == "gap"), None)
    stop = first or len(axes)
    return EarlyOut(stop, len(axes) - stop, first)
