"""What lies on both sides of two surfaces: the proof that two solids do not overlap.

Each side of a triangle faces the inside or the outside of A, and of B. These facts change only
where triangles meet. So each triangle is cut along everything it shares with other triangles of
both surfaces. Within a cell the facts are constant, and winding numbers at one point give them.
Cells bound the overlap of two solids, and the set in which they differ. If no cell has that set on
a side, the set is empty. A connected region that the other surface does not meet needs only one
point.

The boundary of a body: the parts of its surface without material on at least one side.

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

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, partial
from itertools import pairwise, product
from operator import mul
from typing import Any

from satcheck.verify.exact import (
    Point,
    Rejected,
    Vector,
    cartesian,
    clipped,
    cross,
    dot,
    grouped,
    half_space,
    homogeneous,
    normal_of,
    opposite,
    point,
    sub,
)
from satcheck.verify.surfaces import close_pairs, common, meeting
from satcheck.verify.world import Corners, Exact, connected

Cell = Sequence[Vector]  # a convex polygon, in the plane of its triangle
Segment = tuple[Point, Point]
Piece = tuple[Any, Any, Any]  # the corners of a triangle, rational
Contacts = Sequence[tuple[int, int]]
ATTEMPTS = 8  # points of a cell, until one lies on no triangle of another plane
MOST_CELLS = 200_000
BLOCK = 256  # triangles looked at at once; the first few reveal most false claims
FIRST = 4  # triangles of each region, most of which show how it lies


@dataclass(frozen=True, slots=True)
class Sides:
    """A cell of a triangle, and whether its front and its back lie in each body. A surface that is
    not solid has no inside."""

    triangle: int
    cell: Cell
    front: tuple[bool, ...]
    back: tuple[bool, ...]


def sides_of(
    triangles: list[int], a: Exact, b: Exact | None = None, contacts: Contacts = ()
) -> Iterator[Sides]:
    """Both sides of the cells that all they share with other triangles of A and B cut these
    triangles of A into. contacts: all pairs in which they meet B."""
    bodies = [a] if b is None else [a, b]
    partners = grouped((s, b.corners(t)) for s, t in contacts) if b is not None else {}
    total = 0
    for start in range(0, len(triangles), BLOCK):
        block = triangles[start : start + BLOCK]
        met = meeting(a.part(block), a) if a.world.solid else ()
        own = grouped((block[s], a.corners(u)) for s, u in met if block[s] != u)
        for t in block:
            corners = a.corners(t)
            if not any(normal_of(corners)):
                continue
            cells = _cells(corners, partners.get(t, []), own.get(t, []))
            total += len(cells)
            if total > MOST_CELLS:
                raise Rejected(f"the contact falls into more than {MOST_CELLS} pieces")
            for cell in cells:
                fronts, backs = zip(*look(normal_of(corners), cell, bodies), strict=True)
                yield Sides(t, cell, fronts, backs)


def chosen(a: Exact, b: Exact, contacts: Contacts, wanted: Callable[[bool], bool]) -> list[int]:
    """The triangles of A that touch B, then a few of each region that B does not meet, and then the
    others. contacts: all pairs that meet. wanted: whether to include a region; its argument:
    whether it lies inside B."""
    touching = {s for s, _ in contacts}
    regions = [
        region
        for region in _regions(a, touching)
        if wanted(b.world.solid and _winding(b, point(a.corners(region[0])[0])) != 0)
    ]
    parts = [slice(FIRST), slice(FIRST, None)]
    return sorted(touching) + [t for part in parts for region in regions for t in region[part]]


def _winding(solid: Exact, p: Point) -> int:
    number = solid.winding(p)
    if number is None:
        raise Rejected("a point that should be off a surface lies on it")
    return number


def _regions(a: Exact, without: set[int]) -> list[list[int]]:
    """The remaining triangles, by regions connected through vertices."""
    left = [t for t in range(len(a.world.triangles)) if t not in without]
    triangles = a.world.triangles[left]
    labels = connected(triangles, len(a.world.vertices))[triangles[:, 0]]
    return list(grouped(zip(labels.tolist(), left, strict=True)).values())


def sheets_among(body: Exact, contacts: Contacts, side: int) -> set[int]:
    """The triangles in contact, on this side of each pair, that have a part without material on
    either side."""
    triangles = sorted({pair[side] for pair in contacts})
    if not body.world.solid:
        return set(triangles)
    beside = sides_of(triangles, body)
    return {sides.triangle for sides in beside if not any(sides.front + sides.back)}


def _cuts(corners: Corners, normal: Vector, others: list[Corners]) -> list[Segment]:
    """The segments within a triangle along which it meets others.

    An edge between triangles in its plane, run equally often in both directions, is no cut: winding
    numbers do not change across it.
    """
    crossing: set[Segment] = set()
    flat: Counter[Segment] = Counter()
    for other in others:
        shared = common(corners, other)
        edges = [(shared[k - 1], p) for k, p in enumerate(shared)]
        if len(shared) > 2:
            flat.update(edges)
        elif len(shared) == 2:
            crossing.add(edges[0])
    kept = crossing | {(p, q) for p, q in flat if flat[p, q] != flat[q, p]}
    return [edge for edge in kept if _enters(corners, edge, normal)]


def _cells(corners: Corners, *surfaces: list[Corners]) -> list[Cell]:
    """Convex pieces of a triangle, cut along all that it shares with triangles of each surface."""
    cells: list[Cell] = [corners]
    normal = normal_of(corners)
    for edge in (cut for others in surfaces for cut in _cuts(corners, normal, others)):
        across = cross(normal, sub(edge[1], edge[0]))
        side = half_space(across, dot(across, edge[0]))
        after: list[Cell] = []
        for cell in cells:
            if _enters(cell, edge, normal):
                region = [homogeneous(p) for p in cell]
                halves = (clipped(region, one) for one in (side, opposite(side)))
                after += [list(map(cartesian, half)) for half in halves]
            else:
                after.append(cell)
        cells = after
        if len(cells) > MOST_CELLS:
            raise Rejected(f"the contact falls into more than {MOST_CELLS} pieces")
    return cells


def _enters(cell: Cell, edge: Segment, normal: Vector) -> bool:
    """Whether a part of the segment, longer than 0, runs through the open cell: M. Cyrus, J. Beck,
    "Generalized two- and three-dimensional clipping" (1978)."""
    start, end = Fraction(0), Fraction(1)
    for k, p in enumerate(cell):
        inward = cross(normal, sub(p, cell[k - 1]))
        at, to = (Fraction(dot(inward, sub(x, p))) for x in edge)
        if at <= 0 and to <= 0:
            return False
        if at < 0 < to:
            start = max(start, at / (at - to))
        elif to < 0 < at:
            end = min(end, at / (at - to))
        if start >= end:
            return False
    return True


def look(normal: Vector, cell: Cell, bodies: Sequence[Exact]) -> list[tuple[bool, bool]]:
    """For each body whether it lies in front of and behind a point of the open cell: the middle, or
    a point near it that lies on no triangle of another plane."""
    for attempt in range(ATTEMPTS):
        weights = [1 + (k * attempt) % 7 for k in range(1, len(cell) + 1)]
        share = Fraction(1, sum(weights))
        at = point(share * sum(map(mul, weights, places)) for places in zip(*cell, strict=True))
        seen = [body.beside(at, normal) for body in bodies]
        sides = [both for both in seen if both is not None]
        if len(sides) == len(seen):
            return sides
    raise Rejected("every point tried of a piece of the contact lies on another triangle")


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
    end = 0 if across is None else abs(a.points[0][across])
    for s, t in contacts:
        for p, q in product(of_a(s), of_b(t)):
            shared = common(p, q)
            # A point at an end does not count: the middle of what is shared is at none.
            if shared and (
                across is None or abs(sum(x[across] for x in shared)) != end * len(shared)
            ):
                return True
    return False


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
    of_a, of_b = grouped((t, s) for s, t in contacts), grouped(contacts)
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
