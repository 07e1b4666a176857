"""A convex polytope, or a triangle, by its vertices and faces."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from satcheck.core.curved.exact.faces import Polygon
from satcheck.core.curved.exact.lattice import (
    IntVector,
    Point,
    Reach,
    cross,
    dot,
    integer,
    negated,
    shortened,
    sub,
)
from satcheck.core.rounding import CHAIN_ROUNDOFFS, UNIT_ROUNDOFF

Floats = npt.NDArray[np.float64]
Triangles = npt.NDArray[np.uint32]

# At most this many features of a kind are tried. If a body stands on more, a few prove the same as
# all.
MOST = 4
# Vertices this close to the support along an estimated axis, relative to the size, may be contact
# points. The share is far above the error of the axis; extra vertices cost only time.
NEAR = 1e-5
# Up to this many vertices, all are compared exactly.
_FEW = 16
_ROUNDED = CHAIN_ROUNDOFFS * UNIT_ROUNDOFF


class PolytopeBody:
    """vertices: (n, 3), world; times 2**bits they are integers. triangles: (m, 3), outward, the
    whole border; a single triangle is a flat body."""

    def __init__(self, vertices: Floats, triangles: Triangles, bits: int) -> None:
        self.vertices, self.triangles, self.bits = vertices, triangles, bits
        self.flat = len(triangles) == 1
        self._known: dict[int, IntVector] = {}

    def _vertex(self, k: int) -> IntVector:
        vertex = self._known.get(k)
        if vertex is None:
            x, y, z = (integer(c, self.bits) for c in self.vertices[k].tolist())
            vertex = self._known[k] = (x, y, z)
        return vertex

    def _plane(self, triangle: int) -> tuple[IntVector, int]:
        """(outward normal, its product with the points of the plane)."""
        a, b, c = (self._vertex(k) for k in self.triangles[triangle].tolist())
        n = cross(sub(b, a), sub(c, a))
        return n, dot(n, a)

    def _farthest(self, n: IntVector) -> tuple[int, list[int]]:
        """(the largest product of n with a vertex, the vertices that reach it)."""
        candidates = list(range(len(self.vertices)))
        if len(candidates) > _FEW:
            products = self.vertices @ _floats(n)
            pad = 3 * _ROUNDED * float(np.abs(self.vertices).max())
            candidates = np.flatnonzero(products >= products.max() - pad).tolist()
        exact = [dot(n, self._vertex(k)) for k in candidates]
        most = max(exact)
        return most, [k for k, e in zip(candidates, exact, strict=True) if e == most]

    @property
    def middle(self) -> Point:
        return Polygon(tuple(self.corners())).middle

    def reach(self, n: IntVector) -> Reach:
        """The largest product of n with a point of the body."""
        return Reach(self._farthest(n)[0])

    def face(self, n: IntVector) -> Polygon:
        _, farthest = self._farthest(n)
        return Polygon(tuple((*self._vertex(k), 1) for k in farthest))

    def side(self, p: Point) -> int:
        """1 inside, 0 on the border, -1 outside. A flat body has no inside: 0 on it."""
        if self.flat:
            return 0 if self._is_on_triangle(p) else -1
        side = 1
        for triangle in self._faces_near(p):
            n, height = self._plane(triangle)
            beyond = dot(n, p) - height * p[3]
            if beyond > 0:
                return -1
            if beyond == 0 and any(n):
                side = 0
        return side

    def _faces_near(self, p: Point) -> list[int]:
        """The faces, except those that the point is behind, as proven in float64."""
        scale = p[3] << self.bits
        point = np.array([c / scale for c in p[:3]])
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        heights = np.einsum("ij,ij->i", normals, point - a)
        size = float(np.abs(self.vertices).max() + np.abs(point).max())
        lengths = np.linalg.norm(b - a, axis=1) * np.linalg.norm(c - a, axis=1)
        faces: list[int] = np.flatnonzero(heights >= -_ROUNDED * size * lengths).tolist()
        return faces

    def _is_on_triangle(self, p: Point) -> bool:
        n, height = self._plane(0)
        if not any(n) or dot(n, p) != height * p[3]:
            return False
        corners = [self._vertex(k) for k in self.triangles[0].tolist()]
        for tail, head in zip(corners, corners[1:] + corners[:1], strict=True):
            inward = cross(n, sub(head, tail))
            if dot(inward, p) < dot(inward, tail) * p[3]:
                return False
        return True

    def face_normals(self) -> set[IntVector]:
        """The outward normals, exact, each once."""
        normals = {shortened(self._plane(k)[0]) for k in range(len(self.triangles))}
        return {n for n in normals if any(n)}

    def corners(self) -> list[Point]:
        return [(*self._vertex(k), 1) for k in range(len(self.vertices))]

    def _near(self, toward: IntVector) -> npt.NDArray[np.bool_]:
        """(n,): whether each vertex is nearly the farthest along the axis."""
        products = self.vertices @ _floats(toward)
        spread = np.linalg.norm(np.ptp(self.vertices, axis=0))
        near: npt.NDArray[np.bool_] = products >= products.max() - NEAR * spread
        return near

    def _edges(self) -> npt.NDArray[np.uint32]:
        ends = np.concatenate([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        return np.unique(np.sort(ends, axis=1), axis=0)

    def normals(self, toward: IntVector) -> list[IntVector]:
        """Outward normals of the faces that point most along `toward`."""
        near = np.flatnonzero(self._near(toward)[self.triangles].any(axis=1))
        a, b, c = (self.vertices[self.triangles[near, k]] for k in range(3))
        crossed = np.cross(b - a, c - a)
        lengths = np.linalg.norm(crossed, axis=1)
        lengths[lengths == 0] = math.inf
        along = (crossed @ _floats(toward)) / lengths
        if self.flat:
            along = np.abs(along)
        order = near[np.argsort(-along, kind="stable")][: 4 * MOST].tolist()
        normals = [shortened(self._plane(k)[0]) for k in order]
        if self.flat:
            normals = [n if dot(n, toward) > 0 else negated(n) for n in normals]
        return list(dict.fromkeys(n for n in normals if any(n)))[:MOST]

    def lines(self, toward: IntVector) -> list[tuple[IntVector, IntVector]]:
        """Edges as (point, direction); those across the axis first."""
        edges, near = self._edges(), self._near(toward)
        edges = edges[near[edges].any(axis=1)]
        edges = edges[(self.vertices[edges[:, 1]] != self.vertices[edges[:, 0]]).any(axis=1)]
        along = self.vertices[edges[:, 1]] - self.vertices[edges[:, 0]]
        slope = np.abs(along @ _floats(toward)) / np.linalg.norm(along, axis=1)
        order = edges[np.argsort(slope, kind="stable")][:MOST].tolist()
        ends = [(self._vertex(i), self._vertex(j)) for i, j in order]
        return [(p, shortened(sub(q, p))) for p, q in ends]

    def points(self, toward: IntVector) -> list[IntVector]:
        """Vertices that a contact may depend on."""
        return [self._vertex(k) for k in np.flatnonzero(self._near(toward))[:MOST].tolist()]


def _floats(n: IntVector) -> Floats:
    """A float64 vector along n, of length about 1."""
    largest = max(abs(c) for c in n)
    return np.array([c / largest for c in n])
