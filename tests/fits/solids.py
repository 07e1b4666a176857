"""Pairs of solids that fit into each other: pins, plugs, frames, windows, sockets, flanges, slots.

A solid is a list of flat faces, each a polygon with at most one hole, in the frame in which the
faces of the two solids lie in each other exactly. Each face is cut into triangles from a random
corner, so that the diagonals of faces that lie in each other differ. Edges may have T-junctions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from random import Random
from typing import NamedTuple

Point2 = tuple[float, float]
Point = tuple[float, float, float]
Outline = list[Point2]  # counter-clockwise


class Face(NamedTuple):
    """Counter-clockwise seen from outside; the hole clockwise."""

    loop: list[Point]
    hole: list[Point] | None = None


class Solid(NamedTuple):
    vertices: list[Point]
    triangles: list[tuple[int, int, int]]


class Fit(NamedTuple):
    """The second solid fills a hole, a slot or a corner of the first one."""

    kind: str
    outer: list[Face]
    inner: list[Face]


def cross(o: Point2, p: Point2, q: Point2) -> float:
    return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])


def widened(outline: Outline, by: float) -> Outline:
    """Each side moved outwards by that."""
    result = []
    for i, (x, y) in enumerate(outline):
        before, after = outline[i - 1], outline[(i + 1) % len(outline)]
        ways = []
        for (px, py), (qx, qy) in ((before, (x, y)), ((x, y), after)):
            length = math.hypot(qx - px, qy - py)
            ways.append(((qy - py) / length, (px - qx) / length))
        (ax, ay), (bx, by_) = ways
        share = by / (1 + ax * bx + ay * by_)
        result.append((x + share * (ax + bx), y + share * (ay + by_)))
    return result


def at(outline: Outline, z: float) -> list[Point]:
    return [(x, y, z) for x, y in outline]


def walls(outline: Outline, low: float, high: float) -> list[Face]:
    """Seen from outside the outline."""
    sides = zip(outline, outline[1:] + outline[:1], strict=True)
    return [Face([(*p, low), (*q, low), (*q, high), (*p, high)]) for p, q in sides]


def turned_over(face: Face) -> Face:
    return Face(face.loop[::-1], face.hole and face.hole[::-1])


def prism(outline: Outline, low: float, high: float) -> list[Face]:
    return [
        turned_over(Face(at(outline, low))),
        Face(at(outline, high)),
        *walls(outline, low, high),
    ]


def pierced(outline: Outline, hole: Outline, low: float, high: float) -> list[Face]:
    """A prism with a hole all through it."""
    around = hole[::-1]
    return [
        turned_over(Face(at(outline, low), at(around, low))),
        Face(at(outline, high), at(around, high)),
        *walls(outline, low, high),
        *map(turned_over, walls(hole, low, high)),
    ]


def socket(outline: Outline, hole: Outline, low: float, floor: float, high: float) -> list[Face]:
    """A prism with a hole from its top down to a floor."""
    return [
        turned_over(Face(at(outline, low))),
        Face(at(outline, high), at(hole[::-1], high)),
        Face(at(hole, floor)),
        *walls(outline, low, high),
        *map(turned_over, walls(hole, floor, high)),
    ]


def flanged(body: Outline, head: Outline, low: float, under: float, high: float) -> list[Face]:
    """A plug with a wider head, from `under` to `high`."""
    return [
        turned_over(Face(at(body, low))),
        turned_over(Face(at(head, under), at(body[::-1], under))),
        Face(at(head, high)),
        *walls(body, low, under),
        *walls(head, under, high),
    ]


def rectangle(width: float, height: float, x: float = 0.0, y: float = 0.0) -> Outline:
    a, b = width / 2, height / 2
    return [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b)]


def regular(radius: float, corners: int, start: float) -> Outline:
    steps = [start + 2 * math.pi * i / corners for i in range(corners)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in steps]


def solid_of(faces: list[Face], rng: Random, junctions: Random | None = None) -> Solid:
    """junctions: faces get vertices on half of their edges, which their neighbours lack."""
    numbers: dict[Point, int] = {}
    triangles = []
    for face in faces:
        points = [*face.loop, *(face.hole or [])]
        cut = _cut(face, rng)
        if junctions is not None:
            _add_junctions(points, cut, len(face.loop), junctions)
        place = [numbers.setdefault(p, len(numbers)) for p in points]
        for i, j, k in cut:
            triangles.append((place[i], place[j], place[k]))
    return Solid(list(numbers), triangles)


def _add_junctions(
    points: list[Point], cut: list[tuple[int, int, int]], loop: int, rng: Random
) -> None:
    """loop: the number of points of the loop; those of the hole follow."""
    rings = (list(range(loop)), list(range(loop, len(points))))
    edges = [(ring[i - 1], ring[i]) for ring in rings for i in range(len(ring))]
    for i, j in edges:
        if rng.random() < 0.5:
            turned = (
                (n, corners[m:] + corners[:m]) for n, corners in enumerate(cut) for m in (0, 1, 2)
            )
            n, (_, _, k) = next(each for each in turned if each[1][:2] == (i, j))
            share = rng.random()
            x, y, z = (p + share * (q - p) for p, q in zip(points[i], points[j], strict=True))
            cut[n] = (i, len(points), k)
            cut.append((len(points), j, k))
            points.append((x, y, z))


def _cut(face: Face, rng: Random) -> list[tuple[int, int, int]]:
    """Ears of the face, seen along its normal; the loop and the hole are joined by a slit."""
    flat = _flattened(face)
    loop = list(range(len(face.loop)))
    start = rng.randrange(len(loop))
    loop = loop[start:] + loop[:start]
    if face.hole:
        loop = _slit(flat, loop, list(range(len(face.loop), len(flat))))
    ears = []
    while len(loop) > 3:
        i = next(i for i in range(len(loop)) if _is_ear(flat, loop, i))
        ears.append((loop[i - 1], loop[i], loop[(i + 1) % len(loop)]))
        del loop[i]
        loop = loop[1:] + loop[:1]
    return [*ears, (loop[0], loop[1], loop[2])]


def _flattened(face: Face) -> list[Point2]:
    """Without the axis along which the normal is largest."""
    normal = [0.0, 0.0, 0.0]
    for p, q in zip(face.loop, face.loop[1:] + face.loop[:1], strict=True):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            normal[axis] += p[u] * q[v] - p[v] * q[u]
    axis = max(range(3), key=lambda i: abs(normal[i]))
    u, v = (axis + 1) % 3, (axis + 2) % 3
    points = [*face.loop, *(face.hole or [])]
    return [(p[u], p[v]) if normal[axis] > 0 else (p[v], p[u]) for p in points]


def _slit(flat: list[Point2], loop: list[int], hole: list[int]) -> list[int]:
    """From the corners of loop and hole that are nearest to each other."""
    near = min(
        ((i, k) for i in range(len(loop)) for k in range(len(hole))),
        key=lambda ik: math.dist(flat[loop[ik[0]]], flat[hole[ik[1]]]),
    )
    i, k = near
    return [*loop[: i + 1], *hole[k:], *hole[: k + 1], *loop[i:]]


def _is_ear(flat: list[Point2], loop: list[int], i: int) -> bool:
    before, here, after = loop[i - 1], loop[i], loop[(i + 1) % len(loop)]
    o, p, q = flat[before], flat[here], flat[after]
    if cross(o, p, q) <= 0:
        return False
    for other in loop:
        r = flat[other]
        if r in (o, p, q):
            continue
        if cross(o, p, r) >= 0 and cross(p, q, r) >= 0 and cross(q, o, r) >= 0:
            return False
    return True


def _ends(rng: Random, low: float, high: float) -> tuple[float, float]:
    """Of what fills a hole: flush, longer or shorter, on either side."""
    size = high - low
    more = [rng.choice([0.0, 0.0, rng.uniform(0.1, 1.0), rng.uniform(-0.4, -0.1)]) for _ in "ab"]
    return low - size * more[0], high + size * more[1]


def pin(rng: Random, more: float) -> Fit:
    radius, thick = rng.uniform(0.3, 1.0), rng.uniform(0.2, 3.0)
    hole = regular(radius, rng.choice([6, 8, 12, 16, 24, 32, 48]), rng.uniform(0, 1))
    plate = rectangle(rng.uniform(3.0, 6.0), rng.uniform(3.0, 6.0))
    outer = pierced(plate, hole, 0.0, thick)
    return Fit("pin", outer, prism(widened(hole, more), *_ends(rng, 0.0, thick)))


def plug(rng: Random, more: float) -> Fit:
    hole = rectangle(rng.uniform(0.3, 1.5), rng.uniform(0.3, 1.5), rng.uniform(-0.2, 0.2))
    thick = rng.uniform(0.2, 3.0)
    outer = pierced(rectangle(rng.uniform(2.5, 6.0), rng.uniform(2.5, 6.0)), hole, 0.0, thick)
    return Fit("plug", outer, prism(widened(hole, more), *_ends(rng, 0.0, thick)))


def frame(rng: Random, more: float) -> Fit:
    width, height, deep = rng.uniform(1.0, 6.0), rng.uniform(1.0, 6.0), rng.uniform(0.05, 0.5)
    hole, border = rectangle(width, height), rng.uniform(0.05, 0.3)
    outer = pierced(rectangle(width + border, height + border), hole, 0.0, deep)
    return Fit("frame", outer, prism(widened(hole, more), *_ends(rng, 0.0, deep)))


def window(rng: Random, more: float) -> Fit:
    """A frame with a pane's opening of its own, in the opening of a wall."""
    wide, high, deep = rng.uniform(3.0, 12.0), rng.uniform(2.5, 4.0), rng.uniform(0.1, 0.5)
    width, height = rng.uniform(0.5, 2.0), rng.uniform(0.5, 1.5)
    hole = rectangle(width, height, rng.uniform(-0.2, 0.2) * wide, rng.uniform(-0.1, 0.1) * high)
    inner = widened(hole, -0.2 * min(width, height) * rng.uniform(0.2, 1.0))
    front = rng.choice([0.0, 0.3 * deep])
    outer = pierced(rectangle(wide, high), hole, 0.0, deep)
    return Fit("window", outer, pierced(widened(hole, more), inner, front, 0.8 * deep))


def blind(rng: Random, more: float) -> Fit:
    high, floor = rng.uniform(1.0, 3.0), rng.uniform(0.2, 0.6)
    hole = rng.choice(
        [rectangle(rng.uniform(0.3, 1.5), rng.uniform(0.3, 1.5)), regular(0.7, 16, 0.1)]
    )
    outer = socket(rectangle(rng.uniform(2.5, 5.0), rng.uniform(2.5, 5.0)), hole, 0.0, floor, high)
    top = high + rng.choice([0.0, rng.uniform(0.1, 1.0)])
    return Fit("socket", outer, prism(widened(hole, more), floor, top))


def flange(rng: Random, more: float) -> Fit:
    thick, radius = rng.uniform(0.2, 2.0), rng.uniform(0.3, 0.8)
    hole = rng.choice([rectangle(2 * radius, radius), regular(radius, 12, 0.2)])
    outer = pierced(rectangle(4.0, rng.uniform(4.0, 6.0)), hole, 0.0, thick)
    head = widened(hole, rng.uniform(0.1, 0.6))
    low, high = rng.choice([0.0, -0.3 * thick]), thick * rng.uniform(1.1, 2.0)
    return Fit("flange", outer, flanged(widened(hole, more), head, low, thick, high))


def slot(rng: Random, more: float) -> Fit:
    """A T in its slot."""
    neck, head = rng.uniform(0.2, 0.6), rng.uniform(0.8, 1.5)
    low, under, top = rng.uniform(0.2, 0.6), rng.uniform(0.8, 1.2), rng.uniform(1.4, 2.0)
    wide, long = rng.uniform(2.0, 3.0), rng.uniform(0.5, 4.0)
    right = [(neck, top), (neck, under), (head, under), (head, low)]
    left = [(-x, y) for x, y in reversed(right)]
    rail = [(-wide, 0.0), (wide, 0.0), (wide, top), *right, *left, (-wide, top)]
    tee = [*left, *right][::-1]
    tee = [p for i, p in enumerate(tee) if p != tee[i - 1]]
    return Fit("slot", prism(rail, 0.0, long), prism(widened(tee, more), *_ends(rng, 0.0, long)))


def corner(rng: Random, more: float) -> Fit:
    """A block in the corner of an L."""
    x, y, thick = rng.uniform(0.5, 2.0), rng.uniform(0.5, 2.0), rng.uniform(0.2, 1.0)
    long = rng.uniform(0.5, 3.0)
    ell = [(-thick, -thick), (x, -thick), (x, 0.0), (0.0, 0.0), (0.0, y), (-thick, y)]
    block = [(0.0, 0.0), (x * rng.choice([1.0, 0.6]), 0.0), (x / 2, y / 2), (0.0, y)]
    return Fit("corner", prism(ell, 0.0, long), prism(widened(block, more), *_ends(rng, 0.0, long)))


KINDS: list[Callable[[Random, float], Fit]] = [
    pin,
    plug,
    frame,
    window,
    blind,
    flange,
    slot,
    corner,
]
