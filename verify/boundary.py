"""The boundary of a body: the parts of its surface without material on at least one side.

The material of a body is the set of points with a winding number other than 0. A wall without
thickness (outside on both sides) is a sheet and belongs to the boundary. A face inside the material
(inside on both sides) does not. A triangle is cut along everything it shares with other triangles
of its surface. Each cell then belongs to the boundary as a whole or not at all. All points of a
surface that is not solid belong to the boundary.

Two surfaces without an inside may meet and not cross. If a contact is a segment, triangles of both
surfaces stand on its line like the pages of a book. The surfaces cross if, going around the line,
the pages of both alternate. A contact in a single point is no crossing, because a disk without one
point is connected. Coplanar triangles that overlap stay undecided.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache, partial
from itertools import pairwise, product
from typing import Any

from satcheck.verify.cells import Contacts, sides_of
from satcheck.verify.exact import (
    Point,
    Rejected,
    cross,
    dot,
    normal_of,
    sub,
)
from satcheck.verify.surfaces import close_pairs, common
from satcheck.verify.world import Corners, Exact

Piece = tuple[Any, Any, Any]  # the corners of a triangle, rational


def boundary_of(body: Exact, t: int) -> list[Piece]:
    """Closed triangles that make up the boundary part of a triangle."""
    if not body.world.solid:
        return [body.corners(t)]
    return [
        (sides.cell[0], p, q)
        for sides in sides_of([t], body)
        if sides.front != (True,) or sides.back != (True,)
        for p, q in pairwise(sides.cell[1:])
    ]


def meet(a: Exact, b: Exact, contacts: Contacts, across: int | None = None) -> bool:
    """Whether one of these pairs of triangles has a common point of both boundaries. across: of
    prisms of one height along this axis, a point between their ends."""
    of_a, of_b = (cache(partial(boundary_of, body)) for body in (a, b))
    for s, t in contacts:
        for p, q in product(of_a(s), of_b(t)):
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
    greater than `beyond` and at least `least`. Faces within the material of a body are no nearer to
    what is outside of it than its boundary."""
    contacts = []
    for s, t, squared in close_pairs(a, b, max(beyond, least)):
        if squared == 0:
            contacts.append((s, t))
        elif squared <= beyond**2 or squared < least**2:
            raise Rejected("the boundaries are closer than claimed")
    if meet(a, b, contacts):
        raise Rejected("the boundaries meet")
    return contacts


# The most points of a segment that are tried; one must lie on no crossing edge.
SHARES = (Fraction(1, 2), Fraction(2, 5), Fraction(3, 7), Fraction(5, 11), Fraction(6, 13))
CROSSING = 4  # changes around the line: A, B, A, B


def no_crossing(a: Exact, b: Exact, contacts: Contacts) -> None:
    """Rejects surfaces that cross, or lie in each other. contacts: all pairs that meet."""
    of_a: dict[int, list[int]] = {}
    of_b: dict[int, list[int]] = {}
    for s, t in contacts:
        of_a.setdefault(t, []).append(s)
        of_b.setdefault(s, []).append(t)
    for s, t in contacts:
        shared = common(a.corners(s), b.corners(t))
        if len(shared) > 2:
            raise Rejected("two open surfaces lie in each other")
        if len(shared) == 2:
            around = [a.corners(k) for k in of_a[t]], [b.corners(k) for k in of_b[s]]
            if _changes(shared[0], shared[1], *around) >= CROSSING:
                raise Rejected("the surfaces cross")


def _changes(p: Point, q: Point, of_a: list[Corners], of_b: list[Corners]) -> int:
    """The number of changes between pages of A and pages of B, going around the line p q."""
    line = sub(q, p)
    for share in SHARES:
        point: Any = tuple(x + share * along for x, along in zip(p, line, strict=True))
        try:
            pages = [(w, True) for c in of_a for w in _pages(c, point, line)]
            pages += [(w, False) for c in of_b for w in _pages(c, point, line)]
        except _OnAnEdge:
            continue
        return _count(pages, line)
    raise Rejected("every point tried of a contact lies on an edge across it")


class _OnAnEdge(Exception):
    pass


def _pages(corners: Corners, x: Point, line: Any) -> Iterator[Any]:
    """The directions, square to the line, in which a triangle leaves a point of the line."""
    normal = normal_of(corners)
    if not any(normal) or dot(normal, x) != dot(normal, corners[0]):
        return
    edge_inward = None
    for k in range(3):
        edge = sub(corners[(k + 1) % 3], corners[k])
        inward = cross(normal, edge)
        height = dot(inward, x) - dot(inward, corners[k])
        if height < 0:
            return
        if height == 0:
            if any(cross(edge, line)):
                raise _OnAnEdge
            edge_inward = inward
    if edge_inward is not None:
        yield edge_inward
        return
    across = cross(normal, line)
    if not any(across):
        raise _OnAnEdge  # the triangle stands across the line
    yield across
    yield tuple(-c for c in across)


def _count(pages: list[tuple[Any, bool]], line: Any) -> int:
    east = pages[0][0]
    north = cross(line, east)

    def angle(w: Any) -> Fraction:
        """Grows with the way around, from 0 in the east to 4; exact."""
        x, y = Fraction(dot(w, east)), Fraction(dot(w, north))
        share = x / (abs(x) + abs(y))
        return 1 - share if y >= 0 else 3 + share

    turned = sorted((angle(w), of_a) for w, of_a in pages)
    if any(p[0] == q[0] and p[1] != q[1] for p, q in pairwise(turned)):
        raise Rejected("two open surfaces lie in each other")
    return sum(turned[k - 1][1] != turned[k][1] for k in range(len(turned)))
