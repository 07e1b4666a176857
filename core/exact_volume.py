"""The common volume of two small solids as a rational number, without rounding.

A solid is cut into signed convex cells. A convex solid is one cell. Another solid is cut into
tetrahedra that connect its triangles to one of its vertices. Outside of the solid their signs
cancel, like the terms of the divergence theorem. The answer is therefore the sum of the signed
common volumes of all pairs of cells. Cells are clipped by each other's planes: I. E. Sutherland, G.
W. Hodgman, "Reentrant polygon clipping" (1974), with the cap of each cut.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise
from typing import Final

from satcheck._native.core import Mesh

Point = tuple[Fraction, Fraction, Fraction]
Polyhedron = list[list[Point]]  # faces, counter-clockwise from outside
# n and d: the points x with n . x <= d.
HalfSpace = tuple[Point, Fraction]

# Limits: triangles of each mesh, and clips of a face by a plane, which take some seconds.
MOST_TRIANGLES: Final = 500
MOST_CLIPS: Final = 40_000
_TETRAHEDRON: Final = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))


class _Cell:
    __slots__ = ("faces", "high", "low", "sides", "sign")

    def __init__(self, faces: Polyhedron, sign: int, sides: list[HalfSpace]) -> None:
        self.faces, self.sign, self.sides = faces, sign, sides
        points = [p for face in faces for p in face]
        self.low = [min(p[k] for p in points) for k in range(3)]
        self.high = [max(p[k] for p in points) for k in range(3)]

    def meets(self, other: _Cell) -> bool:
        """Whether their boxes have a common interior."""
        return all(self.low[k] < other.high[k] and other.low[k] < self.high[k] for k in range(3))


def exact_common_volume(a: Mesh, b: Mesh) -> Fraction | None:
    """The common volume in cubed units; None: too much work. The winding numbers of both solids
    have to be 0 and 1 only."""
    if max(len(a.triangles), len(b.triangles)) > MOST_TRIANGLES:
        return None
    cells_a, cells_b = _cells(a), _cells(b)
    pairs = [(cell, clipper) for cell in cells_a for clipper in cells_b if cell.meets(clipper)]
    pairs = min(pairs, [(clipper, cell) for cell, clipper in pairs], key=_clips)
    if _clips(pairs) > MOST_CLIPS:
        return None
    total = Fraction(0)
    for cell, clipper in pairs:
        common = cell.faces
        for side in clipper.sides:
            common = clipped(common, side)
            if not common:
                break
        total += cell.sign * clipper.sign * volume(common)
    return total


def _clips(pairs: list[tuple[_Cell, _Cell]]) -> int:
    return sum(len(cell.faces) * len(clipper.sides) for cell, clipper in pairs)


def clipped(solid: Polyhedron, side: HalfSpace) -> Polyhedron:
    """The part of a convex polyhedron in the half-space; empty if it has no volume."""
    normal, limit = side
    heights = [[_dot(normal, p) - limit for p in face] for face in solid]
    if all(h <= 0 for face in heights for h in face):
        return solid
    if all(h >= 0 for face in heights for h in face):
        return []
    kept: Polyhedron = []
    follows: dict[Point, Point] = {}  # corner of the cap -> next corner
    for face, levels in zip(solid, heights, strict=True):
        if all(h >= 0 for h in levels):
            continue
        part = list(_kept(face, levels))
        kept.append([p for p, _ in part])
        for (p, on_p), (q, on_q) in zip(part, part[1:] + part[:1], strict=True):
            if on_p and on_q:
                follows[q] = p
    start = p = next(iter(follows))
    cap = [start]
    while (p := follows[p]) != start:
        cap.append(p)
    return [*kept, cap]


def volume(solid: Polyhedron) -> Fraction:
    """The signed volume, by tetrahedra that connect the faces to one point."""
    if not solid:
        return Fraction(0)
    apex = solid[0][0]
    six = Fraction(0)
    for face in solid:
        p, *rest = (_sub(q, apex) for q in face)
        for q, r in pairwise(rest):
            six += _dot(p, _cross(q, r))
    return six / 6


def _kept(face: list[Point], levels: list[Fraction]) -> Iterator[tuple[Point, bool]]:
    """(corner, whether its height is 0) for the part of a face at heights <= 0."""
    for k, (p, h) in enumerate(zip(face, levels, strict=True)):
        q, g = face[k - 1], levels[k - 1]
        if (h < 0 < g) or (g < 0 < h):
            share = g / (g - h)
            yield (
                (
                    q[0] + share * (p[0] - q[0]),
                    q[1] + share * (p[1] - q[1]),
                    q[2] + share * (p[2] - q[2]),
                ),
                True,
            )
        if h <= 0:
            yield p, h == 0


def _cells(mesh: Mesh) -> list[_Cell]:
    points: list[Point] = [
        (Fraction(float(x)), Fraction(float(y)), Fraction(float(z))) for x, y, z in mesh.vertices
    ]
    faces = [[points[k] for k in triangle] for triangle in mesh.triangles]
    faces = [face for face in faces if any(_normal(face))]
    sides = list(dict.fromkeys(map(_side, faces)))
    used = {p for face in faces for p in face}
    if all(_dot(normal, p) <= limit for normal, limit in sides for p in used):
        return [_Cell(faces, 1, sides)]
    return list(_tetrahedra(faces))


def _tetrahedra(faces: Polyhedron) -> Iterator[_Cell]:
    apex = faces[0][0]
    for p, q, r in faces:
        six = _dot(_sub(p, apex), _cross(_sub(q, apex), _sub(r, apex)))
        if six == 0:
            continue
        corners = (p, q, r, apex) if six > 0 else (p, r, q, apex)
        solid = [[corners[k] for k in face] for face in _TETRAHEDRON]
        yield _Cell(solid, 1 if six > 0 else -1, list(map(_side, solid)))


def _side(face: list[Point]) -> HalfSpace:
    """The half-space behind the face; equal for faces in one plane."""
    n = _normal(face)
    scale = max(abs(c) for c in n)
    unit = n[0] / scale, n[1] / scale, n[2] / scale
    return unit, _dot(unit, face[0])


def _normal(face: list[Point]) -> Point:
    return _cross(_sub(face[1], face[0]), _sub(face[2], face[0]))


def _sub(p: Point, q: Point) -> Point:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def _dot(p: Point, q: Point) -> Fraction:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _cross(p: Point, q: Point) -> Point:
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )
