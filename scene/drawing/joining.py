"""Joins separate lines into closed outlines.

The ends of the lines are the nodes of a graph. Dead ends are removed first. If every remaining node
joins two lines, the lines form closed outlines. If three or more lines meet at a node, the drawing
does not say which areas are parts.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence

from msgspec import Struct

from satcheck.scene.drawing.contour import Point

# Ends of lines closer than this, relative to the drawing, are joined: the difference is a
# rounding of the written digits and not a gap.
JOIN = 1e-9


class Line(Struct, frozen=True):
    """An open line through its points. deviation: as in Contour."""

    points: tuple[Point, ...]
    deviation: float


class Joined(Struct, frozen=True):
    """loops: closed; the last point precedes the first. dead_ends: some lines lead nowhere.
    repeated: some lines were drawn twice. branching: three or more lines meet at a point."""

    loops: tuple[Line, ...]
    dead_ends: bool
    repeated: bool
    branching: bool


def join(lines: Sequence[Line]) -> Joined:
    size = max((abs(c) for line in lines for p in line.points for c in p), default=0.0)
    nodes = _Nodes(JOIN * size)
    edges: dict[int, tuple[int, int]] = {}
    straight: set[tuple[int, int]] = set()
    repeated = False
    for number, line in enumerate(lines):
        ends = nodes.at(line.points[0]), nodes.at(line.points[-1])
        if len(line.points) == 2:
            key = (min(ends), max(ends))
            if key[0] == key[1]:
                continue
            if key in straight:
                repeated = True
                continue
            straight.add(key)
        edges[number] = ends
    drawn = len(edges)
    at = _without_dead_ends(edges)
    branching = {node for node, there in at.items() if len(there) > 2}
    loops = _loops(lines, edges, at, branching)
    return Joined(tuple(loops), len(edges) < drawn, repeated, bool(branching))


def _without_dead_ends(edges: dict[int, tuple[int, int]]) -> dict[int, list[int]]:
    """Removes lines from `edges` until each node has at least two. Returns the lines at each
    node."""
    at: defaultdict[int, list[int]] = defaultdict(list)
    for number, ends in edges.items():
        for node in ends:
            at[node].append(number)
    loose = [node for node, there in at.items() if len(there) == 1]
    while loose:
        node = loose.pop()
        for number in at.pop(node, []):
            for other in edges.pop(number):
                if other in at:
                    at[other].remove(number)
                    if len(at[other]) == 1:
                        loose.append(other)
    return at


def _loops(
    lines: Sequence[Line],
    edges: dict[int, tuple[int, int]],
    at: dict[int, list[int]],
    branching: set[int],
) -> Iterable[Line]:
    """The loops without a branching node."""
    waiting = dict(edges)
    while waiting:
        first, (start, node) = next(iter(waiting.items()))
        del waiting[first]
        points, deviation = list(lines[first].points), lines[first].deviation
        gap = 0.0
        branches = start in branching or node in branching
        while node != start:
            number = next((n for n in at[node] if n in waiting), None)
            if number is None:
                break
            a, b = waiting.pop(number)
            following = lines[number].points if a == node else lines[number].points[::-1]
            gap = max(gap, math.dist(points[-1], following[0]))
            points += following[1:]
            deviation = max(deviation, lines[number].deviation)
            node = b if a == node else a
            branches |= node in branching
        if not branches:
            gap = max(gap, math.dist(points[-1], points[0]))
            yield Line(tuple(points[:-1]), deviation + gap)


class _Nodes:
    """Numbers points; points within `gap` of each other get one number. Uses a grid of cells."""

    def __init__(self, gap: float) -> None:
        self._gap = gap
        self._cells: defaultdict[tuple[int, int], list[tuple[Point, int]]] = defaultdict(list)
        self._count = 0

    def at(self, point: Point) -> int:
        if self._gap == 0:
            return 0
        i, j = (math.floor(c / self._gap) for c in point)
        for cell in ((i + di, j + dj) for di in (-1, 0, 1) for dj in (-1, 0, 1)):
            for other, number in self._cells.get(cell, ()):
                if math.dist(other, point) <= self._gap:
                    return number
        self._count += 1
        self._cells[i, j].append((point, self._count))
        return self._count
