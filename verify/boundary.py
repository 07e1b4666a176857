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

from satcheck.verify.cells import cells_of, in_space, look, own_partners
from satcheck.verify.exact import Point, Rejected, dot, nearest_to_origin, normal_of, sub
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
        normal = normal_of(corners)
        if not any(normal):
            return []
        others = [body.corners(u) for u in own_partners(body, [t]).get(t, [])]
        pieces: list[Piece] = []
        for cell in cells_of(corners, normal, others):
            [(front, back)] = look(corners, normal, cell, [body])
            if not (front and back):
                polygon = [in_space(corners, p) for p in cell]
                pieces += [(polygon[0], p, q) for p, q in pairwise(polygon[1:])]
        return pieces


def meet(a: Exact, b: Exact, contacts: list[tuple[int, int]], across: int | None = None) -> bool:
    """Whether one of these pairs of triangles has a common point of both boundaries. across: of
    prisms of one height along this axis, a point between their ends."""
    of_a, of_b = Boundary(a), Boundary(b)
    for s, t in contacts:
        for p, q in product(of_a.pieces(s), of_b.pieces(t)):
            shared = common(p, q)
            if shared and (across is None or not _is_at_end(shared, a, across)):
                return True
    return False


def _is_at_end(shared: list[Point], prism: Exact, across: int) -> bool:
    middle = sum((p[across] for p in shared), Fraction()) / len(shared)
    return abs(middle) == abs(prism.points[0][across])


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
