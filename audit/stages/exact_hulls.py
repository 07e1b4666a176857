"""Axes, polytopes and common points of the hulls of two bodies, in exact arithmetic.

GJK and EPA run on the vertex differences, on the integer lattice of the pair. float64 only chooses
the next face to expand, so there is no tolerance.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from msgspec import Struct

from satcheck.verify.exact import IntVector, Point, cross, dot, nearest_to_origin, sub
from satcheck.verify.pairs import Pair

MOST_EXPANSIONS = 2000
Vertex = tuple[int, int]  # a_i - b_j


class Nearest(Struct, frozen=True):
    """point: of the Minkowski difference A - B, next to the origin, on the lattice; weights: of the
    vertex differences that it is made of."""

    point: Point
    weights: dict[Vertex, Fraction]


class Expanded(Struct, frozen=True):
    """axis: along which the bodies do not overlap, or overlap least; vertices, faces: the polytope
    around the origin, where there is one."""

    axis: IntVector
    overlaps: bool
    vertices: list[Vertex]
    faces: list[tuple[int, int, int]]


class Difference:
    """The Minkowski difference A - B by its support."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair

    def support(self, n: Any) -> tuple[Vertex, IntVector]:
        i, _ = self.pair.a.farthest(n)
        j, _ = self.pair.b.farthest([-c for c in n])
        return (i, j), self.point((i, j))

    def point(self, vertex: Vertex) -> IntVector:
        return sub(self.pair.a.points[vertex[0]], self.pair.b.points[vertex[1]])


def nearest_point(pair: Pair) -> Nearest:
    """E. G. Gilbert, D. W. Johnson, S. S. Keerthi (1988). Ends because each simplex is nearer."""
    difference = Difference(pair)
    vertex, first = difference.support((1, 0, 0))
    simplex = {vertex: first}
    x: Point = (Fraction(first[0]), Fraction(first[1]), Fraction(first[2]))
    weights = {vertex: Fraction(1)}
    while any(x):
        vertex, w = difference.support([-c for c in x])
        if dot(x, w) >= dot(x, x):
            break
        simplex[vertex] = w
        names = list(simplex)
        x, used = nearest_to_origin([simplex[name] for name in names])
        weights = {names[k]: weight for k, weight in used.items() if weight}
        simplex = {name: simplex[name] for name in weights}
    return Nearest(x, weights)


def expanded(pair: Pair, radius: Fraction) -> Expanded | None:
    """The face of least signed distance is expanded until one shows that the bodies do not overlap,
    or all are at least `radius` (world units) away, or are faces of the difference itself.

    G. van den Bergen, "Proximity queries and penetration depth computation" (2001), on signed
    distances, so that the origin may start outside. None for a flat difference.
    """
    polytope = _Polytope(Difference(pair))
    if not polytope.start():
        return None
    least = float(radius * (1 << pair.a.k))
    for _ in range(MOST_EXPANSIONS):
        face = min(polytope.faces, key=polytope.distance.__getitem__)
        normal, height = polytope.plane[face]
        if height > 0 and polytope.distance[face] > least * (1 + 1e-12):
            return polytope.result(normal)
        vertex, w = polytope.difference.support(normal)
        reach = dot(normal, w)
        if reach <= 0:
            return Expanded(normal, False, [], [])
        if reach == height:
            return polytope.result(normal)
        polytope.expand(vertex, w)
    return None


class _Polytope:
    def __init__(self, difference: Difference) -> None:
        self.difference = difference
        self.vertices: list[Vertex] = []
        self.points: list[IntVector] = []
        self.faces: set[tuple[int, int, int]] = set()
        self.plane: dict[tuple[int, int, int], tuple[IntVector, int]] = {}
        self.distance: dict[tuple[int, int, int], float] = {}

    def start(self) -> bool:
        """A tetrahedron of support points; whether there is one."""
        axes = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
        support = dict(self.difference.support(n) for n in axes)
        names = list(support)
        first = names[0]
        far = max(
            names,
            key=lambda v: dot(sub(support[v], support[first]), sub(support[v], support[first])),
        )
        along = sub(support[far], support[first])
        if not any(along):
            return False
        third = max(names, key=lambda v: _square(cross(along, sub(support[v], support[first]))))
        normal = cross(along, sub(support[third], support[first]))
        if not any(normal):
            basis = [cross(along, u) for u in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
            third, normal = self._off(support, first, basis, lambda p: cross(along, p))
            if third is None:
                return False
        fourth, height = self._off(support, first, [normal], lambda p: (dot(normal, p), 0, 0))
        if fourth is None:
            return False
        order = [first, far, third, fourth] if height[0] < 0 else [first, third, far, fourth]
        self.vertices = order
        self.points = [support[v] for v in order]
        for face in ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)):
            self._add(face)
        return True

    def _off(
        self,
        support: dict[Vertex, IntVector],
        first: Vertex,
        axes: list[IntVector],
        measure: Any,
    ) -> Any:
        """A support point along one of the axes, either way, that the measure does not call 0."""
        for n in axes:
            if not any(n):
                continue
            for way in (n, (-n[0], -n[1], -n[2])):
                vertex, w = self.difference.support(way)
                value = measure(sub(w, support[first]))
                if any(value):
                    support[vertex] = w
                    return vertex, value
        return None, (0, 0, 0)

    def _add(self, face: tuple[int, int, int]) -> None:
        p, q, r = (self.points[v] for v in face)
        normal = cross(sub(q, p), sub(r, p))
        height = dot(normal, p)
        self.faces.add(face)
        self.plane[face] = normal, height
        size = math.sqrt(Fraction(height * height, _square(normal)))
        self.distance[face] = size if height > 0 else -size

    def expand(self, vertex: Vertex, w: IntVector) -> None:
        """Faces that w is in front of go; what is left open is closed with w."""
        seen = {f for f in self.faces if dot(self.plane[f][0], w) > self.plane[f][1]}
        edges = {(f[k - 1], f[k]) for f in seen for k in range(3)}
        self.faces -= seen
        self.vertices.append(vertex)
        self.points.append(w)
        for p, q in edges:
            if (q, p) not in edges:
                self._add((p, q, len(self.points) - 1))

    def result(self, normal: IntVector) -> Expanded:
        used = sorted({v for face in self.faces for v in face})
        place = {v: k for k, v in enumerate(used)}
        faces = sorted((place[p], place[q], place[r]) for p, q, r in self.faces)
        return Expanded(normal, True, [self.vertices[v] for v in used], faces)


def _square(v: IntVector) -> int:
    return dot(v, v)  # type: ignore[no-any-return]


def shortened(v: IntVector | Point) -> IntVector:
    """The same direction in the smallest integers."""
    scale = math.lcm(*(Fraction(c).denominator for c in v))
    whole = [int(c * scale) for c in v]
    divisor = math.gcd(*whole) or 1
    return whole[0] // divisor, whole[1] // divisor, whole[2] // divisor
