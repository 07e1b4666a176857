"""Convex bodies: an inner polytope of the Minkowski difference proves overlap and a least depth."""

from __future__ import annotations

from fractions import Fraction

from satcheck.report.certificate import Indices, Polytope, PolytopeProof
from satcheck.verify.evidence import index
from satcheck.verify.exact import IntVector, Rejected, cross, dot, sub
from satcheck.verify.world import Exact

MOST_FACES = 100_000


def inner_radius_exceeds(
    polytope: Polytope | PolytopeProof, a: Exact, b: Exact, radius: Fraction
) -> None:
    """Rejects a polytope that does not contain the ball of this radius (world) around the origin.

    Its vertices are a_i - b_j. Where each directed edge meets its reverse once, and the origin
    lies behind every face, the surface runs around the origin. So every ray from there meets it,
    nowhere nearer than the nearest face plane.
    """
    vertices, faces = polytope.vertices, polytope.faces
    if not 4 <= len(faces) <= MOST_FACES or len(vertices) > MOST_FACES:
        raise Rejected("a polytope has at least 4 faces, and not too many")
    points = [_difference(pair, a, b) for pair in vertices]
    edges: set[tuple[int, int]] = set()
    least = radius * (1 << a.k)
    for face in faces:
        corner = [index(v, len(points)) for v in face]
        p, q, r = (points[v] for v in corner)
        normal = cross(sub(q, p), sub(r, p))
        height = dot(normal, p)
        if height <= 0:
            raise Rejected("the origin is not strictly inside the polytope")
        if height * height < least * least * dot(normal, normal):
            raise Rejected("a face of the polytope is nearer than the lower bound of the depth")
        for k in range(3):
            edge = corner[k - 1], corner[k]
            if edge in edges:
                raise Rejected("the polytope runs an edge twice")
            edges.add(edge)
    if any((q, p) not in edges for p, q in edges):
        raise Rejected("the polytope is not closed")


def _difference(pair: Indices, a: Exact, b: Exact) -> IntVector:
    return sub(a.points[index(pair[0], len(a.points))], b.points[index(pair[1], len(b.points))])
