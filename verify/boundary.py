"""The boundary of a body: the parts of its surface without material on at least one side.

The material of a body is the set of points with a winding number other than 0. A wall without
thickness (outside on both sides) is a sheet and belongs to the boundary. A face inside the material
(inside on both sides) does not. A triangle is cut along everything it shares with other triangles
of its surface. Each cell then belongs to the boundary as a whole or not at all. All points of a
surface that is not solid belong to the boundary.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise, product
from typing import Any

import numpy as np

from satcheck.report.certificate import OnBody
from satcheck.verify.cells import cells_of, in_space, look, own_partners
from satcheck.verify.evidence import on_body
from satcheck.verify.exact import Point, Rejected, cross, dot, nearest_to_origin, sub
from satcheck.verify.surfaces import close_pairs, common
from satcheck.verify.world import Exact

Piece = tuple[Any, Any, Any]  # the corners of a triangle, rational


class Boundary:
    """The boundary by triangles; each triangle is cut once."""

    def __init__(self, body: Exact) -> None:
        self.body = body
        self._pieces: dict[int, list[Piece]] = {}

    def pieces(self, t: int) -> list[Piece]:
        """Closed triangles that make up the boundary part of triangle t."""
        if t not in self._pieces:
            self._pieces[t] = self._cut(t)
        return self._pieces[t]

    def _cut(self, t: int) -> list[Piece]:
        body = self.body
        corners = body.corners(t)
        if not body.world.solid:
            return [corners]
        normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
        if not any(normal):
            return []
        others = [body.corners(u) for u in own_partners(body, [t]).get(t, [])]
        pieces: list[Piece] = []
        for cell in cells_of(corners, normal, others):
            _, [(front, back)] = look(corners, normal, cell, [body])
            if not (front and back):
                polygon = [in_space(corners, p) for p in cell]
                pieces += [(polygon[0], p, q) for p, q in pairwise(polygon[1:])]
        return pieces

    def holds(self, p: Point) -> bool:
        """p: on the lattice of the body."""
        world = self.body.world
        at = [float(c / (1 << self.body.k)) for c in p]
        low, high = np.nextafter(at, -np.inf), np.nextafter(at, np.inf)
        near = np.flatnonzero((world.low <= high).all(axis=1) & (world.high >= low).all(axis=1))
        point: Piece = (p, p, p)
        return any(common(piece, point) for t in near.tolist() for piece in self.pieces(t))


def boundary_point(point: OnBody, body: Exact, *, of_hull: bool) -> Point:
    """The point of the evidence: any point of a convex body, a boundary point of another body."""
    p = on_body(point, body, of_hull=of_hull)
    if not of_hull and not Boundary(body).holds(p):
        raise Rejected("a point lies within the material")
    return p


def contacts_if_apart(
    a: Exact, b: Exact, beyond: Fraction, least: Fraction
) -> list[tuple[int, int]]:
    """The pairs of triangles that meet. Rejects bodies whose boundaries meet, or whose gap is not
    greater than `beyond` and at least `least`."""
    scale = 1 << a.k
    low, high = (beyond * scale) ** 2, (least * scale) ** 2
    of_a, of_b = Boundary(a), Boundary(b)
    contacts = []
    for s, t, squared in close_pairs(a, b, max(beyond, least)):
        if squared == 0:
            contacts.append((s, t))
        if squared > low and squared >= high:
            continue
        for p, q in product(of_a.pieces(s), of_b.pieces(t)):
            step = _distance_squared(p, q)
            if step <= low or step < high:
                raise Rejected("the boundaries are closer than claimed, or meet")
    return contacts


def _distance_squared(p: Piece, q: Piece) -> Fraction:
    if common(p, q):
        return Fraction(0)
    x, _ = nearest_to_origin([sub(v, u) for u in p for v in q])
    return Fraction(dot(x, x))
