"""Other triangles over the same solid: edges split at their middle, diagonals of flat quads turned.

Whether two triangles lie in one plane, and whether their quad is convex, is decided in rational
arithmetic; the middle of an edge is tried where it is a float64 first.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from msgspec import Struct
from numpy.random import Generator
from numpy.typing import NDArray

from satcheck.core import Mesh

Triangles = NDArray[np.uint32]
Exact = tuple[Fraction, Fraction, Fraction]

# Edges looked at for each one that is split or turned.
TRIES = 8


class Retessellated(Struct, frozen=True):
    """rounded: a middle was no float64, so the surface is off by its rounding there."""

    mesh: Mesh
    split: int
    turned: int
    rounded: bool


def retessellate(mesh: Mesh, steps: int, rng: Generator) -> Retessellated:
    """Up to `steps` edges split or diagonals turned, at random."""
    work = _Work(mesh)
    for step in range(steps):
        exactly = [True] * TRIES if step else [*[True] * TRIES, False]
        for exact in exactly:
            tail, head = work.any_edge(rng)
            if (exact and rng.random() < 0.5 and work.turn(tail, head)) or work.split(
                tail, head, exact=exact
            ):
                break
    vertices = np.array(work.vertices, dtype=np.float64)
    return Retessellated(Mesh(vertices, work.triangles), work.splits, work.turns, work.rounded)


class _Work:
    def __init__(self, mesh: Mesh) -> None:
        self.vertices: list[tuple[float, ...]] = [tuple(p) for p in mesh.vertices.tolist()]
        self.triangles: Triangles = mesh.triangles.copy()
        self.coordinates = set(self.vertices)
        self.splits = self.turns = 0
        self.rounded = False

    def any_edge(self, rng: Generator) -> tuple[int, int]:
        triangle = self.triangles[rng.integers(len(self.triangles))].tolist()
        corner = int(rng.integers(3))
        return triangle[corner], triangle[(corner + 1) % 3]

    def _around(self, tail: int, head: int) -> list[tuple[int, int, int]]:
        """The triangles at an edge, each as (row, the edge's place in it, third corner)."""
        has_both = (self.triangles == tail).any(axis=1) & (self.triangles == head).any(axis=1)
        edges = []
        for row in np.flatnonzero(has_both).tolist():
            corners = self.triangles[row].tolist()
            if len(set(corners)) < 3:
                continue
            start = next(k for k in range(3) if corners[(k + 2) % 3] not in (tail, head))
            edges.append((row, start, corners[(start + 2) % 3]))
        return edges

    def split(self, tail: int, head: int, *, exact: bool) -> bool:
        """A new vertex at the middle; False where that would not be exact, or is a vertex."""
        p, q = self.vertices[tail], self.vertices[head]
        middle = tuple(0.5 * a + 0.5 * b for a, b in zip(p, q, strict=True))
        is_exact = all(
            2 * Fraction(m) == Fraction(a) + Fraction(b)
            for m, a, b in zip(middle, p, q, strict=True)
        )
        around = self._around(tail, head)
        if (exact and not is_exact) or middle in self.coordinates or not around:
            return False
        new = len(self.vertices)
        self.vertices.append(middle)
        self.coordinates.add(middle)
        added = []
        for row, start, third in around:
            first, second = (int(self.triangles[row][(start + k) % 3]) for k in range(2))
            self.triangles[row] = (first, new, third)
            added.append((new, second, third))
        self.triangles = np.concatenate([self.triangles, np.array(added, dtype=np.uint32)])
        self.splits += 1
        self.rounded = self.rounded or not is_exact
        return True

    def turn(self, tail: int, head: int) -> bool:
        """The other diagonal of two triangles in one plane that make a convex quad."""
        around = self._around(tail, head)
        if len(around) != 2:
            return False
        (row, start, c), (other, _, d) = around
        a, b = (int(self.triangles[row][(start + k) % 3]) for k in range(2))
        if c == d or self._around(c, d):
            return False
        p, q, r, s = (self._exact(k) for k in (a, b, c, d))
        normal = _cross(_minus(q, p), _minus(r, p))
        if _dot(normal, _minus(s, p)) != 0:
            return False
        corners = ((p, s, r), (s, q, r), (q, p, s), (p, q, r))
        if any(_dot(normal, _cross(_minus(y, x), _minus(z, x))) <= 0 for x, y, z in corners):
            return False
        self.triangles[row], self.triangles[other] = (a, d, c), (d, b, c)
        self.turns += 1
        return True

    def _exact(self, vertex: int) -> Exact:
        x, y, z = self.vertices[vertex]
        return Fraction(x), Fraction(y), Fraction(z)


def _minus(p: Exact, q: Exact) -> Exact:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def _cross(p: Exact, q: Exact) -> Exact:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def _dot(p: Exact, q: Exact) -> Fraction:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
