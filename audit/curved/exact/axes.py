"""Candidates for an axis along which two bodies touch, exact, near an estimated one.

Flat faces give their normals. Otherwise contacts hang on points and straight lines: the axis runs
between two points, across two lines, from a line to a point across the line.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from satcheck.audit.curved.exact.body import ExactBody
from satcheck.audit.curved.exact.lattice import (
    Vector,
    cross,
    dot,
    negated,
    shortened,
    sub,
)


def candidates(a: ExactBody, b: ExactBody, toward: Vector) -> Iterator[Vector]:
    """From A to B, each once."""
    seen: set[Vector] = set()
    for raw in _raw(a, b, toward):
        n = shortened(raw)
        if dot(n, toward) < 0:
            n = negated(n)
        if any(n) and n not in seen:
            seen.add(n)
            yield n


def _raw(a: ExactBody, b: ExactBody, toward: Vector) -> Iterator[Vector]:
    yield from a.normals(toward)
    yield from map(negated, b.normals(negated(toward)))
    largest = max(range(3), key=lambda k: abs(toward[k]))
    yield (int(largest == 0), int(largest == 1), int(largest == 2))
    lines_a, lines_b = a.lines(toward), b.lines(negated(toward))
    points_a, points_b = a.points(toward), b.points(negated(toward))
    for (_, along), (_, across) in product(lines_a, lines_b):
        yield cross(along, across)
    for lines, points in ((lines_a, points_b), (lines_b, points_a)):
        for (p, along), q in product(lines, points):
            yield _across(along, sub(q, p))
    for p, q in product(points_a, points_b):
        yield sub(q, p)
    yield toward


def _across(along: Vector, step: Vector) -> Vector:
    """The part of a step that is perpendicular to a line, times its squared length."""
    square, share = dot(along, along), dot(along, step)
    x, y, z = (square * s - share * d for s, d in zip(step, along, strict=True))
    return x, y, z
