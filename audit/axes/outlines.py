"""The candidate axes of the convex hulls of two outlines in a plane: their edge normals."""

from __future__ import annotations

import numpy as np

from satcheck import core
from satcheck.audit.axes.projected_axes import projected
from satcheck.audit.axes.studied import Studied
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.core.axes.candidates import AxisKind, Candidates, direction_count
from satcheck.core.axes.features import STEPS_OFF, WORST_TOLERANCE
from satcheck.core.axes.shadows import ExactPoints, Floats, Indices
from satcheck.core.conventions import Plane, axes_of, axis_across
from satcheck.report.axes import AxesBody, AxisCounts
from satcheck.scene.planar.region import convex_region


def studied_outlines(pair: Pair, plane: Plane) -> Studied:
    """The bodies of a pair in a plane are prisms; an axis is an edge of the outline turned by 90
    degrees."""
    corners_a, corners_b = _corners(pair.a, plane), _corners(pair.b, plane)
    points = _in_world(corners_a, corners_b, plane)
    sides = np.arange(len(corners_a)), len(corners_a) + np.arange(len(corners_b))
    edges = _edges(sides[0]), _edges(sides[1])
    steps = pair.a.resolution, pair.b.resolution
    off = [_off(points, some, step) for some, step in zip(edges, steps, strict=True)]
    candidates = Candidates(
        corners=np.concatenate([_turned(some, len(points)) for some in edges]),
        tolerance=np.concatenate(off),
        kind=_kinds("edge-a", len(edges[0])) + _kinds("edge-b", len(edges[1])),
        index_a=np.concatenate((np.arange(len(edges[0])), np.full(len(edges[1]), -1))),
        index_b=np.concatenate((np.full(len(edges[0]), -1), np.arange(len(edges[1])))),
        counted=np.full(len(points) - 2, True),
    )
    axes = projected(candidates, points, ExactPoints(points), sides, pair.closer)
    outcome = core.check_polygon_pair(corners_a, corners_b, query="overlap").outcome
    known = not pair.closer or axes.winner() is not None
    directions = [
        direction_count(_along(points, some), tolerance)
        for some, tolerance in zip(edges, off, strict=True)
    ]
    return Studied(
        a=_stated(pair.a, len(corners_a)),
        b=_stated(pair.b, len(corners_b)),
        counts=AxisCounts(
            candidates=len(candidates.corners),
            edge_pairs=0,
            facet_pairs=0,
            directions=(directions[0], directions[1], 0),
            distinct=len(axes),
        ),
        axes=axes,
        relation="indeterminate" if not known or outcome == "undecided" else outcome,
    )


def _corners(body: PlacedBody, plane: Plane) -> Floats:
    """(n, 2), counter-clockwise, of the hull of the outline."""
    return np.ascontiguousarray(convex_region(body.mesh, plane).points)


def _in_world(a: Floats, b: Floats, plane: Plane) -> Floats:
    """The corners in the plane, the origin, and the unit vector across the plane."""
    points = np.zeros((len(a) + len(b) + 2, 3))
    points[:-2, axes_of(plane)] = np.concatenate((a, b))
    points[-1, axis_across(plane)] = 1.0
    return points


def _edges(corners: Indices) -> Indices:
    return np.column_stack((corners, np.roll(corners, -1)))


def _turned(edges: Indices, points: int) -> Indices:
    """The axes across edges: their cross products with the last point, from the one before it."""
    across = np.tile((points - 2, points - 1), (len(edges), 1))
    return np.column_stack((edges, across))


def _along(points: Floats, edges: Indices) -> Floats:
    along = points[edges[:, 1]] - points[edges[:, 0]]
    unit: Floats = along / np.linalg.norm(along, axis=1)[:, None]
    return unit


def _off(points: Floats, edges: Indices, step: float) -> Floats:
    length = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    off: Floats = np.minimum(STEPS_OFF * step / length, WORST_TOLERANCE)
    return off


def _kinds(kind: AxisKind, count: int) -> tuple[AxisKind, ...]:
    return (kind,) * count


def _stated(body: PlacedBody, corners: int) -> AxesBody:
    return AxesBody(
        id=body.id,
        file=body.body.file.path,
        convex=body.body.file.outline is not None,
        vertices=corners,
        faces=0,
        edges=corners,
    )
