"""Convex bodies: an inner polytope of the Minkowski difference proves overlap and a least depth."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from satcheck.verify.evidence import index, member
from satcheck.verify.exact import Rejected, Vector, cross, dot, sub
from satcheck.verify.world import Exact

MOST_FACES = 100_000


def inner_radius_exceeds(certificate: Any, a: Exact, b: Exact, radius: Fraction) -> None:
    """Rejects a polytope that does not hold the ball of this radius (world) around the origin.

    {"vertices": [[i, j], ...], "faces": [[p, q, r], ...]}: its vertices are a_i - b_j. Where each
    directed edge meets its reverse once, and the origin lies behind every face, the surface runs
    around the origin, so every ray from there meets it, nowhere nearer than the nearest face plane.
    """
    vertices, faces = member(certificate, "vertices"), member(certificate, "faces")
    if not isinstance(vertices, list) or not isinstance(faces, list):
        raise Rejected("a polytope has lists of vertices and faces")
    if not 4 <= len(faces) <= MOST_FACES or len(vertices) > MOST_FACES:
        raise Rejected("a polytope has at least 4 faces, and not too many")
    points = [_difference(pair, a, b) for pair in vertices]
    edges: set[tuple[int, int]] = set()
    least = radius * (1 << a.k)
    for face in faces:
        if not isinstance(face, list) or len(face) != 3:
            raise Rejected("a face has three corners")
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


def _difference(pair: Any, a: Exact, b: Exact) -> Vector:
    if not isinstance(pair, list) or len(pair) != 2:
        raise Rejected("a vertex of the polytope is a pair of vertices")
    return sub(a.points[index(pair[0], len(a.points))], b.points[index(pair[1], len(b.points))])
