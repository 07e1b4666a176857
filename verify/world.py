"""A body in the world, read again from its file and placed by its pose, and its winding numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from math import gcd
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.verify.exact import (
    Floats,
    Homogeneous,
    IntVector,
    Point,
    Reach,
    Rejected,
    Vector,
    cross,
    dot,
    half_spaces,
    height,
    homogeneous,
    integers,
    lattice,
    normal_of,
    point,
    sign,
    sub,
)

Indices = NDArray[np.int64]
SPLITTER = 2.0**27 + 1  # T. J. Dekker (1971): halves of 26 bits


class World:
    """vertices: (n, 3) float64, triangles: (m, 3). solid: bounds material.

    Winding numbers define the material of a solid. They are well defined because every directed
    edge occurs as often as its reverse. `Shape` has checked that in the file, and equal points stay
    equal when moved.
    """

    def __init__(self, vertices: Floats, triangles: Indices, solid: bool) -> None:
        self.vertices, self.triangles, self.solid = vertices, triangles, solid
        if not np.isfinite(vertices).all():
            raise Rejected("a coordinate is not finite")
        corners = vertices[triangles]
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        return self.low.min(axis=0), self.high.max(axis=0)

    @cached_property
    def used(self) -> tuple[Indices, Floats, float]:
        """The vertices that triangles have: their numbers, their places, the largest coordinate."""
        used = np.flatnonzero(np.bincount(self.triangles.ravel()))
        points = self.vertices[used]
        return used, points, float(np.abs(points).max())

    @cached_property
    def lattice(self) -> int:
        return lattice(self.vertices)

    def moved(self, offset: Sequence[float]) -> World:
        """Each coordinate rounded once."""
        return World(self.vertices + np.array(offset), self.triangles, self.solid)


def stick_out(a: Exact, b: Exact, closer: Fraction, across: int | None) -> bool:
    """Return whether each body sticks out of the box of the other by more than a length. across: an
    axis along which that does not count.

    A triangle that sticks out bounds material there or is a part of a sheet, if it has an area.
    """
    return _sticks_out(a, b, closer, across) and _sticks_out(b, a, closer, across)


def _sticks_out(a: Exact, b: Exact, closer: Fraction, across: int | None) -> bool:
    axes = [k for k in range(3) if k != across]
    low, high = b.world.bounds
    is_out = ((a.world.low < low) | (a.world.high > high))[:, axes].any(axis=1)
    least, most = integers(np.array([low, high]), b.k)
    for corners in map(a.corners, np.flatnonzero(is_out).tolist()):
        beyond = max(max(least[k] - p[k], p[k] - most[k]) for p in corners for k in axes)
        if beyond > closer * a.scale and any(normal_of(corners)):
            return True
    return False


def placed(
    vertices: Floats, triangles: Indices, solid: bool, pose: Sequence[float] | None
) -> World:
    """world = pose * (x, y, z, 1), row-major; each coordinate summed in twice the precision and
    rounded once: T. Ogita, S. M. Rump, S. Oishi, "Accurate Sum and Dot Product" (2005), Dot2.
    A reflection turns the triangles."""
    if pose is None:
        return World(vertices + 0.0, triangles, solid)
    rows = [(pose[4 * k], pose[4 * k + 1], pose[4 * k + 2]) for k in range(3)]
    scale = lattice(np.array(rows))
    x, y, z = integers(np.array(rows), scale)
    handedness = sign(dot(x, cross(y, z)))
    if handedness == 0 or tuple(pose[12:]) != (0.0, 0.0, 0.0, 1.0):
        raise Rejected("the pose is singular or not affine")
    total = np.tile([float(pose[4 * k + 3]) for k in range(3)], (len(vertices), 1))
    correction = np.zeros_like(total)
    # An overflow gives an infinite coordinate, which World refuses.
    with np.errstate(over="ignore", invalid="ignore"):
        for a, b in zip(np.array(rows).T, vertices.T[..., None], strict=True):
            product, (a_high, a_low), (b_high, b_low) = a * b, _halved(a), _halved(b)
            error = a_low * b_low - (product - a_high * b_high - a_low * b_high - a_high * b_low)
            before, total = total, total + product
            back = total - before
            rest = (before - (total - back)) + (product - back)
            correction = correction + (rest + error)
        moved = total + correction + 0.0
    return World(moved, triangles if handedness > 0 else triangles[:, [0, 2, 1]], solid)


def _halved(a: Floats) -> tuple[Floats, Floats]:
    """Two numbers of half as many bits, whose sum a number is."""
    high = SPLITTER * a - (SPLITTER * a - a)
    return high, a - high


def connected(triangles: Indices, count: int) -> Indices:
    """For each of so many corners the least one that is connected with it through triangles."""
    label = np.arange(count)
    while True:  # each triangle takes the least label of its corners, labels follow labels
        least = label[triangles].min(axis=1)
        before = label.copy()
        for corner in range(3):
            np.minimum.at(label, label[triangles[:, corner]], least)
            np.minimum.at(label, triangles[:, corner], least)
        label = label[label]
        if (label == before).all():
            return label


def is_flat(points: Floats) -> bool:
    """Whether they lie in one plane, exactly."""
    exact = integers(points, lattice(points))
    spokes = [sub(p, exact[0]) for p in exact]
    along = next(filter(any, spokes), (0, 0, 0))
    normal = next((n for v in spokes if any(n := cross(along, v))), (0, 0, 0))
    return all(dot(normal, v) == 0 for v in spokes)


def welded(vertices: Floats, triangles: Indices) -> tuple[Floats, Indices]:
    """The points that triangles have, each once, and the triangles by them."""
    used = vertices[triangles.ravel()] + 0.0  # -0.0 is 0.0
    points, number = np.unique(used, axis=0, return_inverse=True)
    return points, number.reshape(-1, 3)


def rounded(vector: Sequence[Any]) -> Floats:
    """About this direction, its largest component about 1."""
    largest = max(map(abs, vector))
    return np.array([float(c / largest) for c in vector])


class Exact:
    """A body on the lattice of a pair: its points are integers. scale: the factor from world
    units."""

    def __init__(self, world: World, k: int) -> None:
        self.world, self.k, self.scale = world, k, 1 << k

    def at(self, p: Iterable[Any]) -> Point:
        """A point of the world on the lattice."""
        return point(Fraction(c) * self.scale for c in p)

    @cached_property
    def points(self) -> list[IntVector]:
        return integers(self.world.vertices, self.k)

    def part(self, triangles: list[int]) -> Exact:
        """A surface of some of the triangles, with the same points."""
        world = World(self.world.vertices, self.world.triangles[triangles], solid=False)
        return Exact(world, self.k)

    def corners(self, t: int) -> tuple[IntVector, IntVector, IntVector]:
        i, j, k = self.world.triangles[t].tolist()
        return self.points[i], self.points[j], self.points[k]

    def farthest(self, normal: Sequence[Any]) -> tuple[int, Any]:
        """A vertex that lies farthest along the normal, and normal . vertex, exactly."""
        used, points, largest = self.world.used
        along = [k for k, c in enumerate(normal) if c]
        if len(along) == 1:  # no sum, so no rounding
            heights = points[:, along[0]] * sign(normal[along[0]])
            near = [int(heights.argmax())]
        else:
            direction = rounded(normal)
            heights = points @ direction
            # Three products, two sums, and the rounding of the direction: 6 roundoffs cover them.
            error = 8 * 2.0**-53 * largest * sum(map(abs, direction.tolist())) + 2.0**-1000
            near = np.flatnonzero(heights >= heights.max() - 2 * error).tolist()
        exact = [dot(normal, p) for p in integers(points[near], self.k)]
        best = max(range(len(exact)), key=exact.__getitem__)
        return int(used[near[best]]), exact[best]

    def extent(self, normal: Sequence[Any]) -> Any:
        return self.farthest(normal)[1]

    def reach(self, n: Point) -> Reach:
        """How far it reaches along n, times the length of n, world units."""
        return Reach(Fraction(self.extent(n)) / self.scale)

    def planes(self) -> Iterator[tuple[IntVector, int]]:
        """(n, h): the plane n . p = h of each triangle that has an area, once; n points outward."""
        seen: set[tuple[IntVector, int]] = set()
        for corners in map(self.corners, range(len(self.world.triangles))):
            x, y, z = normal_of(corners)
            if divisor := gcd(x, y, z):
                normal = x // divisor, y // divisor, z // divisor
                plane = normal, dot(normal, corners[0])
                if plane not in seen:
                    seen.add(plane)
                    yield plane

    @cached_property
    def six_volumes(self) -> int:
        """Six times the signed volume that a balanced surface winds around."""
        triangles = map(self.corners, range(len(self.world.triangles)))
        return sum(dot(a, cross(b, c)) for a, b, c in triangles)

    def winding(self, p: Point) -> int | None:
        """How often the surface runs around p; None where p lies on it."""
        crossings = self.ray(p, 0, None)
        return None if crossings is None else crossings[0]

    def beside(self, p: Point, normal: Vector) -> tuple[bool, bool] | None:
        """Whether material lies in front of and behind a point of a plane, next to it; None where p
        also lies on a triangle of another plane. What is not solid has none."""
        if not self.world.solid:
            return False, False
        axis = max(range(3), key=lambda k: abs(normal[k]))
        crossings = self.ray(p, axis, normal)
        if crossings is None:
            return None
        ahead, flush = crossings
        sides = ahead != 0, ahead + flush != 0
        return sides if normal[axis] > 0 else sides[::-1]

    def ray(self, p: Point, axis: int, plane: Vector | None) -> tuple[int, int] | None:
        """Signed crossings of the ray from p along +axis: beyond p, and in p's own plane.

        Ties are broken as if p were moved across the ray by (e, e^2), e > 0 and infinitely small.
        A sum over a balanced surface does not depend on that.
        """
        x = homogeneous(p)
        ahead = flush = 0
        for t in self._in_the_way(p, axis):
            corners = self.corners(t)
            normal = normal_of(corners)
            above = dot(normal, x) - dot(normal, corners[0]) * x[3]
            side = projected_side(corners, x, axis)
            if above * side < 0:
                ahead += side
            elif above == 0:
                if plane is not None and any(normal) and not any(cross(normal, plane)):
                    flush += side
                elif all(height(space, x) <= 0 for space in half_spaces(corners)):
                    return None
        return ahead, flush

    def _in_the_way(self, p: Point, axis: int) -> list[int]:
        """Triangles whose boxes meet the ray, and a few whose do not."""
        at = [float(c / self.scale) for c in p]
        down, up = np.nextafter(at, -np.inf), np.nextafter(at, np.inf)
        low, high = self.world.low, self.world.high
        hit = high[:, axis] >= down[axis]
        for k in ((axis + 1) % 3, (axis + 2) % 3):
            hit &= (low[:, k] <= up[k]) & (high[:, k] >= down[k])
        return np.flatnonzero(hit).tolist()


Corners = tuple[IntVector, IntVector, IntVector]


def projected_side(corners: Corners, x: Homogeneous, axis: int) -> int:
    """+1 or -1 where the point, moved a little, is in the triangle seen along the axis: the sign of
    its normal there; else 0."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    w = x[3]
    sides = set()
    for k in range(3):
        u, v = corners[k], corners[(k + 1) % 3]
        along_i, along_j = v[i] - u[i], v[j] - u[j]
        turn = along_i * (x[j] - u[j] * w) - along_j * (x[i] - u[i] * w)
        sides.add(sign(turn or -along_j or along_i))
    return sides.pop() if len(sides) == 1 else 0


def count_by_triangle(
    vertices: Floats, triangles: Indices, wound: bool
) -> Counter[tuple[tuple[float, ...], ...]]:
    """The triangles by coordinates, from their least corner on; not wound: sorted."""
    count: Counter[tuple[tuple[float, ...], ...]] = Counter()
    for corners in vertices[triangles].tolist():
        points = [tuple(c) for c in corners]
        first = points.index(min(points))
        count[(*points[first:], *points[:first]) if wound else tuple(sorted(points))] += 1
    return count
