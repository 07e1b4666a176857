"""What lies on both sides of two surfaces: the proof that two solids do not overlap.

Each side of a triangle faces the inside or the outside of A, and of B. These facts change only
where triangles meet. So each triangle is cut along everything it shares with other triangles of
both surfaces. Within a cell the facts are constant, and winding numbers at one point give them.
Cells bound the overlap of two solids, and the set in which they differ. If no cell has that set on
a side, the set is empty. A connected region that the other surface does not meet needs only one
point.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from satcheck.verify.exact import (
    IntVector,
    Point,
    Rejected,
    cross,
    dot,
    normal_of,
    point,
    sub,
    turn,
)
from satcheck.verify.surfaces import common, meeting
from satcheck.verify.world import Corners, Exact

Plane = tuple[
    Fraction, Fraction
]  # s, r: corner 0 + s (corner 1 - corner 0) + r (corner 2 - corner 0)
Segment = tuple[Plane, Plane]
UNIT_CELL: list[Plane] = [
    (Fraction(0), Fraction(0)),
    (Fraction(1), Fraction(0)),
    (Fraction(0), Fraction(1)),
]
ATTEMPTS = 8  # points of a cell, until one lies on no triangle of another plane
MOST_CELLS = 200_000
BLOCK = 256  # triangles whose own partners are looked up at once
FIRST = 4  # triangles of each region, most of which show how it lies


@dataclass(frozen=True, slots=True)
class Sides:
    """The facts in front of a piece of a triangle and behind it: (in A, in B). A surface that is
    not solid has no inside."""

    front: tuple[bool, bool]
    back: tuple[bool, bool]


@dataclass(frozen=True, slots=True)
class CutTriangle:
    """A triangle of a surface, and the convex cells that all it shares with others cut it into."""

    corners: Corners
    normal: IntVector
    cells: list[list[Plane]]


def sides_of(
    a: Exact, b: Exact, contacts: list[tuple[int, int]], triangles: list[int]
) -> Iterator[Sides]:
    """Both sides of every cell of these triangles of A, as `cells_in` has them."""
    for triangle in cells_in(a, b, contacts, triangles):
        for cell in triangle.cells:
            yield sides_of_cell(triangle, cell, a, b)


def cells_in(
    a: Exact, b: Exact, contacts: list[tuple[int, int]], triangles: list[int]
) -> Iterator[CutTriangle]:
    """Those of the triangles of A that have an area. contacts: all pairs in which they meet B."""
    partners: dict[int, list[int]] = {}
    for s, t in contacts:
        partners.setdefault(s, []).append(t)
    total = 0
    for t, own in _with_own_partners(a, triangles):
        corners = a.corners(t)
        normal = normal_of(corners)
        if not any(normal):
            continue
        others = [b.corners(u) for u in partners.get(t, [])], [a.corners(u) for u in own]
        cells = cells_of(corners, normal, *others)
        total += len(cells)
        if total > MOST_CELLS:
            raise Rejected(f"the contact falls into more than {MOST_CELLS} pieces")
        yield CutTriangle(corners, normal, cells)


def chosen(
    a: Exact, b: Exact, contacts: list[tuple[int, int]], wanted: Callable[[bool], bool]
) -> list[int]:
    """The triangles of A that touch B, then a few of each region that B does not meet, and then the
    others. contacts: all pairs that meet. wanted: whether to include a region; its argument:
    whether it lies inside B."""
    touching = {s for s, _ in contacts}
    regions = [
        region
        for region, vertex in _regions(a, touching)
        if wanted(b.world.solid and _winding(b, point(a.points[vertex])) != 0)
    ]
    parts = [slice(FIRST), slice(FIRST, None)]
    return sorted(touching) + [t for part in parts for region in regions for t in region[part]]


def sides_of_cell(triangle: CutTriangle, cell: list[Plane], a: Exact, b: Exact) -> Sides:
    """Of a triangle of A."""
    in_a, in_b = look(triangle.corners, triangle.normal, cell, (a, b))
    return Sides((in_a[0], in_b[0]), (in_a[1], in_b[1]))


def _winding(solid: Exact, p: Point) -> int:
    number = solid.winding(p)
    if number is None:
        raise Rejected("a point that should be off a surface lies on it")
    return number


def _regions(a: Exact, without: set[int]) -> Iterator[tuple[list[int], int]]:
    """The remaining triangles, by regions connected through vertices, with a vertex of each
    region."""
    left = np.ones(len(a.world.triangles), dtype=bool)
    left[list(without)] = False
    index = np.flatnonzero(left)
    if not index.size:
        return
    label = a.world.labels(a.world.triangles[index])
    of = label[a.world.triangles[index, 0]]
    order = np.argsort(of, kind="stable")
    borders = np.flatnonzero(np.diff(of[order])) + 1
    for region in np.split(index[order], borders):
        yield region.tolist(), int(a.world.triangles[region[0], 0])


def own_partners(a: Exact, index: list[int]) -> dict[int, list[int]]:
    """The other triangles of A that meet those of the index; empty if A has no inside."""
    partners: dict[int, list[int]] = {}
    if not a.world.solid or not index:
        return partners
    for s, t in meeting(a.part(index), a):
        if index[s] != t:
            partners.setdefault(index[s], []).append(t)
    return partners


def sheets_among(body: Exact, contacts: list[tuple[int, int]], side: int) -> set[int]:
    """The triangles in contact, on this side of each pair, that have a part without material on
    either side."""
    triangles = sorted({pair[side] for pair in contacts})
    if not body.world.solid:
        return set(triangles)
    sheets = set()
    for t, own in _with_own_partners(body, triangles):
        corners = body.corners(t)
        normal = normal_of(corners)
        if not own or not any(normal):
            continue  # only where it meets its own surface has a triangle the same on both sides
        for cell in cells_of(corners, normal, [body.corners(u) for u in own]):
            if look(corners, normal, cell, [body]) == [(False, False)]:
                sheets.add(t)
                break
    return sheets


def _with_own_partners(a: Exact, chosen: list[int]) -> Iterator[tuple[int, list[int]]]:
    """In blocks, because the first few triangles reveal most false claims."""
    for start in range(0, len(chosen), BLOCK):
        block = chosen[start : start + BLOCK]
        own = own_partners(a, block)
        for t in block:
            yield t, own.get(t, [])


def _cuts(corners: Corners, normal: IntVector, others: list[Corners]) -> list[Segment]:
    """The segments within a triangle along which it meets others.

    An edge between triangles in its plane, run equally often in both directions, is no cut: winding
    numbers do not change across it.
    """
    crossing: set[Segment] = set()
    flat: Counter[Segment] = Counter()
    for other in others:
        shared = [_in_plane(corners, normal, p) for p in common(corners, other)]
        edges = [(shared[k - 1], p) for k, p in enumerate(shared)]
        if len(shared) > 2:
            flat.update(edges)
        elif len(shared) == 2:
            crossing.add(edges[0])
    kept = crossing | {(p, q) for p, q in flat if flat[p, q] != flat[q, p]}
    return [edge for edge in kept if _inside(edge)]


def _in_plane(corners: Corners, normal: IntVector, p: Point) -> Plane:
    origin, e, f = corners[0], sub(corners[1], corners[0]), sub(corners[2], corners[0])
    step = sub(p, origin)
    size = Fraction(dot(normal, normal))
    return dot(cross(step, f), normal) / size, dot(cross(e, step), normal) / size


def _inside(edge: Segment) -> bool:
    """Whether the edge, which lies in the triangle, runs through its open interior."""
    s, r = edge[0][0] + edge[1][0], edge[0][1] + edge[1][1]
    return s > 0 and r > 0 and s + r < 2


def cells_of(corners: Corners, normal: IntVector, *surfaces: list[Corners]) -> list[list[Plane]]:
    """Convex pieces of a triangle, cut along all that it shares with triangles of each surface."""
    cells = [UNIT_CELL]
    for edge in (cut for others in surfaces for cut in _cuts(corners, normal, others)):
        after: list[list[Plane]] = []
        for cell in cells:
            after += _split(cell, edge) if _enters(cell, edge) else [cell]
        cells = after
        if len(cells) > MOST_CELLS:
            raise Rejected(f"the contact falls into more than {MOST_CELLS} pieces")
    return cells


def _enters(cell: list[Plane], edge: Segment) -> bool:
    """Whether a part of the segment, longer than 0, runs through the open cell: M. Cyrus, J. Beck,
    "Generalized two- and three-dimensional clipping" (1978)."""
    start, end = Fraction(0), Fraction(1)
    for k in range(len(cell)):
        at, to = turn(cell[k - 1], cell[k], edge[0]), turn(cell[k - 1], cell[k], edge[1])
        if at <= 0 and to <= 0:
            return False
        if at < 0 < to:
            start = max(start, at / (at - to))
        elif to < 0 < at:
            end = min(end, at / (at - to))
        if start >= end:
            return False
    return True


def _split(cell: list[Plane], edge: Segment) -> list[list[Plane]]:
    """The cell on either side of the line of the segment."""
    turns = [turn(*edge, p) for p in cell]
    halves: list[list[Plane]] = []
    for side in (1, -1):
        kept: list[Plane] = []
        for k, (p, height) in enumerate(zip(cell, turns, strict=True)):
            before = turns[k - 1]
            if before * height < 0:
                q, s = cell[k - 1], before / (before - height)
                kept.append((q[0] + s * (p[0] - q[0]), q[1] + s * (p[1] - q[1])))
            if height * side >= 0:
                kept.append(p)
        halves.append(kept)
    return halves


def in_space(corners: Corners, p: Plane) -> Point:
    return point(u + p[0] * (v - u) + p[1] * (w - u) for u, v, w in zip(*corners, strict=True))


def look(
    corners: Corners, normal: IntVector, cell: list[Plane], bodies: Sequence[Exact]
) -> list[tuple[bool, bool]]:
    """For each body whether it lies in front of and behind a point of the open cell: the middle, or
    a point near it that lies on no triangle of another plane."""
    for attempt in range(ATTEMPTS):
        weights = [1 + (k * attempt) % 7 for k in range(1, len(cell) + 1)]
        s, r = (
            sum((w * p[k] for w, p in zip(weights, cell, strict=True)), Fraction()) / sum(weights)
            for k in range(2)
        )
        at = in_space(corners, (s, r))
        seen = [e.beside(at, normal) if e.world.solid else (0, 0) for e in bodies]
        sides = [(both[0] != 0, both[1] != 0) for both in seen if both is not None]
        if len(sides) == len(seen):
            return sides
    raise Rejected("every point tried of a piece of the contact lies on another triangle")
