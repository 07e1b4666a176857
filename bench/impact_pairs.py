"""Pairs whose parts meet exactly, for `bench.impacts`: corners, edges and faces without an excuse.

The situations are described by Bolun Wang, Zachary Ferguson, Teseo Schneider, Xin Jiang, Marco
Attene, Daniele Panozzo, "A Large-Scale Benchmark and an Inclusion-Based Algorithm for Continuous
Collision Detection" (2021): those of Kenny Erleben, "Methodology for Assessing Mesh-Based Contact
Point Methods" (2018), and single triangles. The bodies of a situation touch as they are built. They
then move into each other, up to each other, or past each other, exactly or off by a little. A
random matrix of small integers turns and shears all this: it keeps what meets exactly.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from itertools import product

from msgspec import Struct

from bench.swept_truth import Convex, Meeting, Point, meeting

# Coordinates are integers times 2**-44, below 2**53, so that float64 holds them all.
ONE = 1 << 44
LITTLE = ONE >> 20
# Less than the rounding of a pose: the answer may be a touch.
HAIR = 1

DOWN, ALONG_X, ALONG_Y = (0, 0, -1), (1, 0, 0), (0, 1, 0)
Pieces = list[Convex]


class Setup(Struct, frozen=True):
    """A and B touch. into: a direction that makes A enter B. past: directions in which A may slide
    both ways without entering B."""

    a: Pieces
    b: Pieces
    past: Sequence[Point] = ()
    into: Point = DOWN


class ImpactPair(Struct, frozen=True):
    """A moves by t * move. slight: rounding may hide how the bodies meet."""

    family: str
    a: Pieces
    move: Point
    b: Pieces
    slight: bool = False

    def truth(self) -> Meeting:
        return meeting(self.a, self.move, self.b)


def impact_pairs(rounds: int) -> Iterator[ImpactPair]:
    """All motions of every situation, so often, and as many pairs of triangles."""
    draw = random.Random(2021)
    for _, (name, build) in product(range(rounds), SITUATIONS.items()):
        pairs = list(_motions(name, build(draw), draw))
        matrix = _matrix(draw)
        yield from (_mapped(pair, matrix) for pair in pairs)
        yield from (_triangles(draw) for _ in pairs)


def _motions(name: str, setup: Setup, draw: random.Random) -> Iterator[ImpactPair]:
    start, more = draw.randint(1, 3) * ONE, draw.randint(1, 4) * ONE // 4
    ways = [(setup.into, -start, start + more), (setup.into, -start, start)]
    ways += [(way, -start, 2 * start) for way in setup.past]
    for (way, since, length), off in product(ways, (0, -LITTLE, LITTLE, -HAIR, HAIR)):
        at = _plus(_times(way, since), _times(setup.into, off))
        a = [_moved(piece, at) for piece in setup.a]
        slight = abs(off) == HAIR
        yield ImpactPair(name, a, _times(way, length), setup.b, slight)


def _triangles(draw: random.Random) -> ImpactPair:
    """On so few points that corners, edges and planes often agree, and motions lie in a plane."""
    a, b = _triangle(draw), _triangle(draw)
    way = draw.randint(-4, 4), draw.randint(-4, 4), draw.randint(-4, 4)
    return ImpactPair("two triangles", [a], _times(way, ONE), [b])


def _triangle(draw: random.Random) -> Convex:
    while True:
        points = [tuple(draw.randint(0, 3) * ONE for _ in range(3)) for _ in range(3)]
        (p, q, r), face = points, (0, 1, 2)
        u, v = ([c - d for c, d in zip(s, p, strict=True)] for s in (q, r))
        if any(u[i] * v[j] != u[j] * v[i] for i, j in ((0, 1), (0, 2), (1, 2))):
            return Convex(points, [face])  # type: ignore[arg-type]


def _half(draw: random.Random) -> int:
    return draw.randint(2, 6) * ONE // 4


def _spike(draw: random.Random, *, up: bool, slope: int = 0) -> Convex:
    """Its tip is the origin. slope: of its width against its height; 0: any."""
    height = ONE * draw.randint(1, 3) * (-1 if up else 1)
    half = abs(height) // slope if slope else _half(draw)
    base = [(x, y, height) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    sides = [(0, k, k % 4 + 1) for k in range(1, 5)]
    return _convex([(0, 0, 0), *base], [*sides, (1, 2, 3), (1, 3, 4)])


def _wedge(draw: random.Random, *, up: bool, along_x: bool, slope: int = 0) -> Convex:
    """The middle of its edge is the origin."""
    height = ONE * draw.randint(1, 3) * (-1 if up else 1)
    half, length = abs(height) // slope if slope else _half(draw), _half(draw)
    ends = (-length, length)
    points: list[Point] = [(x, 0, 0) for x in ends]
    points += [(x, y, height) for x in ends for y in (-half, half)]
    if not along_x:
        points = [(y, x, z) for x, y, z in points]
    quads = [*_quad(0, 1, 4, 2), *_quad(0, 1, 5, 3), *_quad(2, 4, 5, 3)]
    return _convex(points, [(0, 2, 3), (1, 4, 5), *quads])


def _box(low: Point, high: Point) -> Convex:
    points = [(x, y, z) for x, y, z in product(*zip(low, high, strict=True))]
    sides = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return _convex(points, [triangle for side in sides for triangle in _quad(*side)])


def _cube(draw: random.Random, x: int, y: int) -> Convex:
    half = _half(draw)
    return _box((x - half, y - half, 0), (x + half, y + half, 2 * half))


def _blocks(crack: int) -> Pieces:
    """Their tops lie in z = 0. crack: half the width between them, across x."""
    far, deep = 6 * ONE, -3 * ONE
    return [_box((-far, -far, deep), (-crack, far, 0)), _box((crack, -far, deep), (far, far, 0))]


def _plate() -> Pieces:
    """Four blocks side by side: edges inside the face z = 0, and walls inside the body."""
    far = 6 * ONE
    ends = ((-far, 0), (0, far))
    return [_box((x[0], y[0], -ONE), (x[1], y[1], 0)) for x, y in product(ends, ends)]


def _spike_in_crack(draw: random.Random) -> Setup:
    """The spike is as wide as the crack at a depth of 1/4."""
    depth = ONE // 4
    a = _moved(_spike(draw, up=False, slope=2), (0, 0, -depth))
    return Setup([a], _blocks(depth // 2), [ALONG_Y])


def _wedge_in_crack(draw: random.Random) -> Setup:
    depth = ONE // 4
    a = _moved(_wedge(draw, up=False, along_x=False, slope=2), (0, 0, -depth))
    return Setup([a], _blocks(depth // 2), [ALONG_Y])


def _spike_in_hole(draw: random.Random) -> Setup:
    depth = ONE // 4
    a = _moved(_spike(draw, up=False, slope=2), (0, 0, -depth))
    half, far = depth // 2, 6 * ONE
    ends = ((-far, -half), (half, far))
    bars = [_box((-half, low, -3 * ONE), (half, high, 0)) for low, high in ends]
    return Setup([a], [*_blocks(half), *bars])


def _wedges(draw: random.Random) -> Setup:
    a = _wedge(draw, up=False, along_x=draw.random() < 0.5)
    return Setup([a], [_wedge(draw, up=True, along_x=draw.random() < 0.5)], [ALONG_X, ALONG_Y])


def _spike_on_wedge(draw: random.Random) -> Setup:
    b = _wedge(draw, up=True, along_x=True)
    return Setup([_spike(draw, up=False)], [b], [ALONG_X, ALONG_Y])


def _on_cliff(draw: random.Random) -> Setup:
    """A cube above the edge of a cliff, its side in the wall or half of it over the edge."""
    cliff = _box((-6 * ONE, -6 * ONE, -3 * ONE), (0, 6 * ONE, 0))
    cube = _cube(draw, 0, draw.randint(-2, 2) * ONE)
    if draw.random() < 0.5:
        return Setup([cube], [cliff], [ALONG_X, ALONG_Y])
    low = min(p[0] for p in cube.points)
    beside = _moved(cube, (-low, 0, -draw.randint(1, 3) * ONE // 4))
    return Setup([beside], [cliff], [DOWN, ALONG_Y], into=(-1, 0, 0))


def _spikes(draw: random.Random) -> Setup:
    return Setup([_spike(draw, up=False)], [_spike(draw, up=True)], [ALONG_X, (1, 1, 0)])


def _on_plate(build: Callable[[random.Random], Convex]) -> Callable[[random.Random], Setup]:
    slides = [ALONG_X, (1, 1, 0), (1, 2, 0)]
    return lambda draw: Setup([build(draw)], _plate(), slides)


SITUATIONS: dict[str, Callable[[random.Random], Setup]] = {
    "spikes": _spikes,
    "spike and wedge": _spike_on_wedge,
    "wedges": _wedges,
    "sliding spike": _on_plate(lambda draw: _spike(draw, up=False)),
    "sliding wedge": _on_plate(lambda draw: _wedge(draw, up=False, along_x=True)),
    "spike and crack": _spike_in_crack,
    "wedge and crack": _wedge_in_crack,
    "spike and hole": _spike_in_hole,
    "cube and cliff": _on_cliff,
    "cube, internal edges": _on_plate(lambda draw: _cube(draw, 0, draw.randint(-1, 1) * ONE)),
}


def _quad(p: int, q: int, r: int, s: int) -> list[tuple[int, int, int]]:
    return [(p, q, r), (p, r, s)]


def _convex(points: Sequence[Point], triangles: Sequence[tuple[int, int, int]]) -> Convex:
    """The faces outward, whichever way they are given."""
    return Convex(points, [_outward(points, t) for t in triangles])


def _outward(points: Sequence[Point], t: tuple[int, int, int]) -> tuple[int, int, int]:
    p, q, r = (points[k] for k in t)
    inside = [sum(column) for column in zip(*points, strict=True)]
    rows = [
        [q[k] - p[k] for k in range(3)],
        [r[k] - p[k] for k in range(3)],
        [inside[k] - len(points) * p[k] for k in range(3)],
    ]
    return (t[0], t[2], t[1]) if _determinant(rows) > 0 else t


def _matrix(draw: random.Random) -> list[list[int]]:
    while True:
        rows = [[draw.randint(-3, 3) for _ in range(3)] for _ in range(3)]
        if _determinant(rows):
            return rows


def _determinant(rows: Sequence[Sequence[int]]) -> int:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def _mapped(pair: ImpactPair, matrix: list[list[int]]) -> ImpactPair:
    a, b = (
        [_convex([_image(matrix, p) for p in piece.points], piece.triangles) for piece in pieces]
        for pieces in (pair.a, pair.b)
    )
    return ImpactPair(pair.family, a, _image(matrix, pair.move), b, pair.slight)


def _image(matrix: list[list[int]], p: Point) -> Point:
    x, y, z = (sum(m * c for m, c in zip(row, p, strict=True)) for row in matrix)
    return x, y, z


def _moved(piece: Convex, by: Point) -> Convex:
    return Convex([_plus(p, by) for p in piece.points], piece.triangles)


def _plus(p: Point, q: Point) -> Point:
    return p[0] + q[0], p[1] + q[1], p[2] + q[2]


def _times(p: Point, factor: int) -> Point:
    return p[0] * factor, p[1] * factor, p[2] * factor
