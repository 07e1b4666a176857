"""Figures of curved shapes: the depth in a mesh that is not convex, and what is not available.

The depth is between that of a mesh inside the shape and that of a mesh around it. A translation
that frees the outer mesh frees the shape, and one that frees the shape frees the inner mesh.
"""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody, SharedMesh
from satcheck.audit.figures.concave_depth import depth_of_move
from satcheck.audit.figures.depth import Depth, measure_depth
from satcheck.audit.ladder.ladder import settle
from satcheck.audit.request.trace import Trace
from satcheck.core import Mesh
from satcheck.core.curved.freeing import move_off
from satcheck.core.rounding import rounding_pad
from satcheck.core.shape_mesh import mesh_around
from satcheck.core.shapes import is_curved
from satcheck.report.report import NOT_AVAILABLE, ON_TRIANGLES, OVERLAPS, Vector
from satcheck.scene.inspect import remeshed


def sandwiched_depth(pair: Pair, move: Vector | None, trace: Trace) -> Depth:
    """move: a translation of A within the touch band that is known to free it."""
    inner, outer = _depth_with(pair, around=False), _depth_with(pair, around=True)
    if outer is None:
        raise AssertionError("what is known to overlap a shape overlaps the mesh around it")
    lower = 0.0 if inner is None else max(min(inner.lower, outer.upper) - _sticks_out(pair), 0.0)
    trace.record("depth", "bounded", "between a mesh inside the curved shape and one around it")
    if move is None and None in (pair.a.curved, pair.b.curved):
        move = move_off(pair.a, pair.b, outer.upper, rounding_pad(pair.largest_coordinate))
    if move is not None:
        trace.record("verify", "separated", "the shape, moved by the MTV")
        return depth_of_move(pair, move, lower)
    verified = "separated" if outer.escape.verified else "failed"
    trace.record("verify", verified, "the mesh around the shape, moved by the MTV")
    return Depth(lower, outer.upper, outer.normal, outer.escape)


def _depth_with(pair: Pair, *, around: bool) -> Depth | None:
    """None where the meshes do not overlap."""
    settings = pair.settings
    if not pair.may("hull"):  # shapes have no oriented boxes, so meshes get none
        settings = replace(settings, accuracy="aabb")
    a, b = _as_mesh(pair, pair.a, around), _as_mesh(pair, pair.b, around)
    meshes = replace(pair, a=a, b=b, settings=settings)
    trace = Trace()
    verdict = settle(meshes, trace)
    return measure_depth(meshes, verdict, None, trace) if verdict.relation in OVERLAPS else None


def _sticks_out(pair: Pair) -> float:
    """World units: how far the mesh within the shape may be outside of it, by rounding."""
    slack = sum(body.curved.slack for body in (pair.a, pair.b) if body.curved is not None)
    return slack + rounding_pad(pair.largest_coordinate)


def _as_mesh(pair: Pair, body: PlacedBody, around: bool) -> PlacedBody:
    curved = body.curved
    if curved is None:
        return body
    file, primitive = body.body.file, body.body.shape
    if around and is_curved(primitive):
        # Grown once more by what placing the shape may have rounded, relative to its size.
        grown = mesh_around(primitive)
        size = 1.0 + 4.0 * curved.slack / min(_extents(grown))
        file = remeshed(file, _scaled(grown, size))
    return PlacedBody(replace(body.body, file=file, shape=None), SharedMesh(file, pair.settings))


def _extents(mesh: Mesh) -> tuple[float, ...]:
    low, high = mesh.bounds
    return tuple(b - a for a, b in zip(low, high, strict=True))


def _scaled(mesh: Mesh, by: float) -> Mesh:
    return mesh.transformed(
        [by if i == j < 3 else float(i == j) for i in range(4) for j in range(4)]
    )


def without_meshes(reason: str | None, pair: Pair, trace: Trace) -> str | None:
    """The reason of a finding; it names the figures that are computed on meshes alone, and so are
    not available for a curved shape."""
    missing = [effect for effect in ON_TRIANGLES if pair.request.wants(effect)]
    for effect in missing:
        trace.record(effect, NOT_AVAILABLE, "a curved shape has no triangles")
    if missing:
        return reason or f"{' and '.join(missing)}: not available for curved shapes"
    return reason
