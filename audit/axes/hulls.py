"""The candidate axes of the convex hulls of two bodies in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.axes.projected_axes import projected
from satcheck.audit.axes.studied import (
    MOST_EDGE_PAIRS,
    MOST_FACET_PAIRS,
    Studied,
    relation_shown,
    require_few,
)
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.core.axes.candidates import EdgePairs, candidates, direction_count, edge_pairs
from satcheck.core.axes.features import Features, features_of
from satcheck.core.axes.shadows import ExactPoints
from satcheck.core.errors import SatcheckError
from satcheck.report.axes import AxesBody, AxisCounts, HullRelation

_SHAPES = ("point", "segment")


def studied_hulls(pair: Pair) -> Studied:
    """Raises SatcheckError (`curved-shape`, `flat-bodies`, `too-many-axes`)."""
    hull_a, hull_b = _hull(pair.a), _hull(pair.b)
    points = np.concatenate([np.asarray(hull.vertices) for hull in (hull_a, hull_b)])
    exact = ExactPoints(points)
    a = features_of(hull_a, 0, points, exact, pair.a.resolution)
    b = features_of(hull_b, hull_a.vertex_count, points, exact, pair.b.resolution)
    stated_a, stated_b = _stated(pair.a, a), _stated(pair.b, b)
    every = len(a.edges) * len(b.edges)
    require_few(stated_a, stated_b, every, MOST_EDGE_PAIRS, "pairs of edges")
    pairs = edge_pairs(a, b)
    _require_few_facets(stated_a, stated_b, ~pairs.noise)
    answer = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), method="gjk")
    relation: HullRelation = "indeterminate" if answer.outcome == "undecided" else answer.outcome
    sides = a.points, b.points
    axes = projected(candidates(a, b, pairs, noise=False), points, exact, sides)
    if relation_shown(axes) != relation:
        _require_few_facets(stated_a, stated_b, pairs.noise)
        axes = projected(candidates(a, b, pairs, noise=True), points, exact, sides)
    if relation_shown(axes) != relation and hull_a.dimension == hull_b.dimension == 2:
        message = "both bodies are flat and in one plane: give --planar with that plane"
        raise SatcheckError("flat-bodies", message)
    return Studied(
        a=stated_a,
        b=stated_b,
        counts=_counts(a, b, pairs, len(axes)),
        axes=axes,
        relation=relation,
        distance=answer.distance,
        gjk_steps=answer.gjk_iterations + answer.epa_iterations,
    )


def _hull(body: PlacedBody) -> core.Polytope:
    if body.curved is not None:
        message = "a curved shape has no faces: every direction is a candidate axis"
        raise SatcheckError("curved-shape", message, body=body.id)
    hull = body.hull()
    if hull.dimension < 2:
        message = f"its hull is a {_SHAPES[hull.dimension]}, which has no faces"
        raise SatcheckError("flat-bodies", message, body=body.id)
    return hull


def _require_few_facets(a: AxesBody, b: AxesBody, rows: NDArray[np.bool_]) -> None:
    what = "pairs of edges that can make a face of their Minkowski difference"
    require_few(a, b, int(rows.sum()), MOST_FACET_PAIRS, what)


def _stated(body: PlacedBody, features: Features) -> AxesBody:
    return AxesBody(
        id=body.id,
        file=body.body.file.path,
        convex=body.convex,
        vertices=len(features.points),
        faces=features.faces,
        edges=features.sides,
    )


def _counts(a: Features, b: Features, pairs: EdgePairs, distinct: int) -> AxisCounts:
    proper = (pairs.rows < (a.sides, b.sides)).all(axis=1) & ~pairs.noise
    return AxisCounts(
        candidates=a.faces + b.faces + a.sides * b.sides,
        edge_pairs=a.sides * b.sides,
        facet_pairs=int(proper.sum()),
        directions=(_normals(a), _normals(b), _edge_directions(a) * _edge_directions(b)),
        distinct=distinct,
    )


def _normals(features: Features) -> int:
    return direction_count(features.normal, features.face_off)


def _edge_directions(features: Features) -> int:
    sides = slice(features.sides)
    return direction_count(features.direction[sides], features.edge_off[sides])
