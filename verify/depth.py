"""Lower bounds of a depth.

Of convex bodies: an inner polytope of the Minkowski difference, which also proves their overlap.

Of other solids: a cover of all shorter translations, each proven to leave an overlap. A triangle
S of A, moved by t, passes through a triangle U of B if t lies inside U - S, a convex polytope. The
solids then have a common interior if the planes of S and U are not parallel, and if every inner
point of either triangle has its solid on exactly one side. Cubes inside such polytopes cover the
ball of shorter translations: an octree around the origin with a pair of triangles for each leaf.
Cubes outside the ball need no proof.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil

from satcheck.report.certificate import Cover, Indices, Polytope, PolytopeProof
from satcheck.verify.cells import look
from satcheck.verify.exact import IntVector, Rejected, cross, dot, normal_of, point, sub
from satcheck.verify.pairs import index
from satcheck.verify.surfaces import common, perhaps_close
from satcheck.verify.world import Corners, Exact

MOST_FACES = 100_000


def inner_radius_exceeds(
    polytope: Polytope | PolytopeProof, a: Exact, b: Exact, radius: Fraction
) -> None:
    """Rejects a polytope that does not contain the ball of this radius (world) around the origin.

    Its vertices are a_i - b_j. Where each directed edge meets its reverse once, and the origin
    lies behind every face, the surface runs around the origin. So every ray from there meets it,
    nowhere nearer than the nearest face plane.
    """
    vertices, faces = polytope.vertices, polytope.faces
    if not 4 <= len(faces) <= MOST_FACES or len(vertices) > MOST_FACES:
        raise Rejected("a polytope has at least 4 faces, and not too many")
    points = [_difference(pair, a, b) for pair in vertices]
    edges: set[tuple[int, int]] = set()
    least = radius * (1 << a.k)
    for face in faces:
        corner = [index(v, len(points)) for v in face]
        p, q, r = (points[v] for v in corner)
        normal = cross(sub(q, p), sub(r, p))
        height = dot(normal, p)
        if height <= 0:
            raise Rejected("the origin is not strictly inside the polytope")
        if height * height < least * least * dot(normal, normal):
            raise Rejected("a face of the polytope is nearer than the lower bound of the depth")
        for k in range(3):
            edge = corner[k - 1], corner[k]
            if edge in edges:
                raise Rejected("the polytope runs an edge twice")
            edges.add(edge)
    if any((q, p) not in edges for p, q in edges):
        raise Rejected("the polytope is not closed")


def _difference(pair: Indices, a: Exact, b: Exact) -> IntVector:
    return sub(a.points[index(pair[0], len(a.points))], b.points[index(pair[1], len(b.points))])


LEVELS = 12  # the most halvings of a cube
MOST_CUBES = 50_000
SPLIT = -1
HalfSpace = tuple[IntVector, int]  # n . t < h, on the lattice
Cube = tuple[IntVector, int]  # its middle and half its edge, in 2**-LEVELS of the lattice


def depth_is_at_least(cover: Cover, a: Exact, b: Exact, depth: Fraction) -> None:
    """Rejects a cover that does not prove that every translation of A shorter than this (world
    units) leaves a common interior.
    """
    if not (a.world.solid and b.world.solid):
        raise Rejected("a cover proves something about solids only")
    if len(cover.cubes) > MOST_CUBES:
        raise Rejected(f"a cover has at most {MOST_CUBES:,} cubes")
    in_a, in_b = len(a.world.triangles), len(b.world.triangles)
    named = [(index(s, in_a), index(t, in_b)) for s, t in cover.pairs]
    for body, triangles in ((a, {s for s, _ in named}), (b, {t for _, t in named})):
        if not_plain(body, sorted(triangles)):
            raise Rejected("a triangle of the cover is no plain part of the boundary of its solid")
    squared = (depth * (1 << a.k)) ** 2
    regions = [
        [
            (n, h)
            for n, h in half_spaces(a.corners(s), b.corners(t))
            if not _holds_ball(n, h, squared)
        ]
        for s, t in named
    ]
    ball = ceil((depth * (1 << a.k + LEVELS)) ** 2)
    pending = [root(depth, a.k)]
    for leaf in cover.cubes:
        while pending and is_outside(pending[-1], ball):
            pending.pop()
        if not pending:
            raise Rejected("a cover has more cubes than the ball needs")
        cube = pending.pop()
        if leaf == SPLIT:
            pending += reversed(children(cube))
        elif not 0 <= leaf < len(regions) or not _holds(regions[leaf], cube):
            raise Rejected("a cube of translations is not shown to overlap")
    if not all(is_outside(cube, ball) for cube in pending):
        raise Rejected("the cover leaves out a part of the ball")


def root(depth: Fraction, k: int) -> Cube:
    """A cube around the ball, with an edge that is a power of two."""
    size = ceil(depth * (1 << k))
    return (0, 0, 0), 1 << (size - 1).bit_length() + LEVELS


def children(cube: Cube) -> list[Cube]:
    (x, y, z), size = cube
    if size & 1:
        raise Rejected("a cube is halved too often")
    h = size >> 1
    return [((x + i, y + j, z + k), h) for k in (-h, h) for j in (-h, h) for i in (-h, h)]


def is_outside(cube: Cube, squared: int) -> bool:
    """Whether no point of the cube is closer to the origin than the root of `squared`."""
    middle, size = cube
    steps = [max(abs(c) - size, 0) for c in middle]
    return dot(steps, steps) >= squared  # type: ignore[no-any-return]


def _holds_ball(n: IntVector, h: int, squared: Fraction) -> bool:
    """Whether the half-space n . t < h holds the open ball; squared: its radius."""
    return h > 0 and h * h >= squared * dot(n, n)


def _holds(region: list[HalfSpace], cube: Cube) -> bool:
    middle, size = cube
    return all(dot(n, middle) + size * sum(map(abs, n)) < h << LEVELS for n, h in region)


def half_spaces(s: Corners, t: Corners) -> list[HalfSpace]:
    """The inside of T - S. Its facets are parallel to one of them, or to an edge of each."""
    edges = [[sub(c[(k + 1) % 3], c[k]) for k in range(3)] for c in (s, t)]
    faces = [cross(e[0], e[1]) for e in edges]
    if not any(cross(*faces)):
        raise Rejected("two parallel triangles show no overlap")
    bounds = []
    for n in (*faces, *(cross(e, f) for e in edges[0] for f in edges[1])):
        if not any(n):
            continue
        on_s, on_t = [dot(n, p) for p in s], [dot(n, p) for p in t]
        bounds.append((n, max(on_t) - min(on_s)))
        bounds.append(((-n[0], -n[1], -n[2]), max(on_s) - min(on_t)))
    return bounds


def not_plain(body: Exact, triangles: list[int]) -> list[int]:
    """Triangles that a cover must not use: without area, crossed by another triangle of the
    surface, or with the solid on both sides or on none."""
    unfit = {t for t in triangles if not any(normal_of(body.corners(t)))}
    for s, u in perhaps_close(body.part(triangles), body):
        t = triangles[s]
        if t not in unfit and t != u and _enters(body.corners(u), body.corners(t)):
            unfit.add(t)
    for t in set(triangles) - unfit:
        [(front, back)] = look(normal_of(body.corners(t)), body.corners(t), [body])
        if front == back:
            unfit.add(t)
    return sorted(unfit)


def _enters(other: Corners, corners: Corners) -> bool:
    """Whether another triangle has a point of the inside of this one."""
    normal = normal_of(corners)
    heights = [dot(normal, sub(p, corners[0])) for p in other]
    if min(heights) >= 0 or max(heights) <= 0:  # it touches the plane at most
        touching = {p for p, height in zip(other, heights, strict=True) if height == 0}
        if len(touching) < len(corners) and touching.issubset(corners):
            return False
    shared = common(corners, other)
    if not shared:
        return False
    # Where a convex set enters the triangle, so does its middle.
    middle = point(sum(p[k] for p in shared) / len(shared) for k in range(3))
    edges = ((corners[k], sub(corners[(k + 1) % 3], corners[k])) for k in range(3))
    return all(dot(cross(normal, edge), sub(middle, p)) > 0 for p, edge in edges)
