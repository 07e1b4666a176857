"""Write kettle.obj and snowflake.obj: `python -m sample_meshes.kitchen`. Same bytes every time.

Two concave solids of which no pair of convex parts tells the way out: a hollow kettle, and a
snowflake that has run through its rim and its handle.
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise

from sample_meshes.make import HERE, Face, Mesh, Point, obj, rounded

TURNS = 32  # of the kettle's body
SIDES = 10  # of its handle and its spout

# Radius and height, from the middle of the bottom round the outside to the middle of the inside.
PROFILE = [
    *((0.0, 0.0), (0.75, 0.0), (0.95, 0.15), (1.05, 0.45), (1.0, 0.8), (0.8, 1.1), (0.5, 1.25)),
    *((0.4, 1.25), (0.74, 1.03), (0.91, 0.77), (0.96, 0.45), (0.88, 0.2), (0.7, 0.09), (0.0, 0.09)),
]
SPOUT = [((0.85, 0.0, 0.4), 0.17), ((1.35, 0.0, 0.7), 0.13), ((1.7, 0.0, 1.2), 0.1)]
HANDLE_RADIUS, HANDLE_THICKNESS, HANDLE_BENDS = 0.72, 0.07, 12

ARM, BRANCH, HALF_WIDTH, HALF_HEIGHT = 1.3, 0.42, 0.055, 0.05
BRANCHES_AT = (0.5, 0.85)
TILT, LIFT, ASIDE = math.radians(20), 1.2, (0.8, 0.25)


def kettle() -> Mesh:
    """The body is hollow and open above; handle and spout are solids that end in its wall."""
    bow = []
    for k in range(HANDLE_BENDS + 1):
        angle = math.pi * k / HANDLE_BENDS
        x, z = HANDLE_RADIUS * math.cos(angle), 1.1 + HANDLE_RADIUS * math.sin(angle)
        bow.append(((0.0, x, z), HANDLE_THICKNESS))
    return rounded(joined([turned(PROFILE), sausage(bow), sausage(SPOUT)]))


def turned(profile: list[tuple[float, float]]) -> Mesh:
    """The solid of revolution of a profile that starts and ends on the z axis."""
    inner = profile[1:-1]
    points: list[Point] = [(0.0, 0.0, profile[0][1]), (0.0, 0.0, profile[-1][1])]
    for k in range(TURNS):
        c, s = math.cos(2 * math.pi * k / TURNS), math.sin(2 * math.pi * k / TURNS)
        points += [(r * c, r * s, z) for r, z in inner]
    count = len(inner)
    faces: list[Face] = []
    for k in range(TURNS):
        here, there = 2 + k * count, 2 + (k + 1) % TURNS * count
        faces += [(0, there, here), (1, here + count - 1, there + count - 1)]
        for j in range(count - 1):
            faces += [(here + j, there + j, there + j + 1), (here + j, there + j + 1, here + j + 1)]
    return Mesh(points, faces)


def sausage(path: list[tuple[Point, float]]) -> Mesh:
    """A tube with closed ends along a path of centres and radii in one plane through the z axis."""
    points: list[Point] = []
    for k, ((x, y, z), radius) in enumerate(path):
        a, b = path[max(k - 1, 0)][0], path[min(k + 1, len(path) - 1)][0]
        along = unit((b[0] - a[0], b[1] - a[1], b[2] - a[2]))
        across = (0.0, 1.0, 0.0) if along[1] == 0 else (1.0, 0.0, 0.0)
        third = cross(along, across)
        for j in range(SIDES):
            c, s = math.cos(2 * math.pi * j / SIDES), math.sin(2 * math.pi * j / SIDES)
            u, v, w = (radius * (c * across[m] + s * third[m]) for m in range(3))
            points.append((x + u, y + v, z + w))
    last = len(points) - SIDES
    faces: list[Face] = [tuple(range(SIDES))[::-1], tuple(range(last, last + SIDES))]
    for k in range(len(path) - 1):
        for j in range(SIDES):
            here, turn = k * SIDES + j, k * SIDES + (j + 1) % SIDES
            faces += [(here, turn, turn + SIDES), (here, turn + SIDES, here + SIDES)]
    return Mesh(points, faces)


def kettle_parts() -> list[list[Point]]:
    """The convex pieces of the kettle's body: corners of each stretch of its wall in each turn."""
    half = len(PROFILE) // 2
    outer, inner = PROFILE[:half], PROFILE[: half - 1 : -1]
    parts = []
    for k in range(TURNS):
        angles = [2 * math.pi * (k + step) / TURNS for step in (0, 1)]
        for j in range(half - 1):
            ring = [outer[j], outer[j + 1], inner[j], inner[j + 1]]
            parts.append([(r * math.cos(a), r * math.sin(a), z) for r, z in ring for a in angles])
    return parts


def snowflake() -> Mesh:
    """Six arms with two pairs of branches each, flat, tilted."""
    flat = extruded(outline(), HALF_HEIGHT)
    return rounded(flat._replace(points=[placed(point) for point in flat.points]))


def snowflake_parts() -> list[list[Point]]:
    """Its convex pieces, by their corners."""
    heights = (-HALF_HEIGHT, HALF_HEIGHT)
    return [[placed((x, y, z)) for x, y, _ in polygon for z in heights] for polygon in outline()]


def placed(point: Point) -> Point:
    x, y, z = point
    c, s = math.cos(TILT), math.sin(TILT)
    return c * x - s * z + ASIDE[0], y + ASIDE[1], s * x + c * z + LIFT


def outline() -> list[tuple[Point, ...]]:
    """Convex polygons in the plane z = 0 that meet along whole edges."""
    polygons: list[tuple[Point, ...]] = []
    centre = [polar(2 * HALF_WIDTH, 60.0 * k + 30) for k in range(6)]
    for k in range(6):
        polygons.append(((0.0, 0.0, 0.0), centre[k - 1], centre[k]))
        polygons += arm(60.0 * k)
    return polygons


def arm(degrees: float) -> list[tuple[Point, ...]]:
    """Convex polygons of one arm, counter-clockwise."""
    w = HALF_WIDTH
    stations = [2 * w * math.cos(math.radians(30))]
    for at in BRANCHES_AT:
        stations += [at, at + 2 * w]
    stations.append(ARM)
    out, polygons = math.radians(60), []
    for low, high in pairwise(stations):
        polygons.append([(low, -w), (high, -w), (high, w), (low, w)])
        if low in BRANCHES_AT:
            dx, dy = BRANCH * math.cos(out), BRANCH * math.sin(out)
            polygons.append([(low, w), (high, w), (high + dx, w + dy), (low + dx, w + dy)])
            polygons.append([(high, -w), (low, -w), (low + dx, -w - dy), (high + dx, -w - dy)])
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [tuple((c * x - s * y, s * x + c * y, 0.0) for x, y in polygon) for polygon in polygons]


def extruded(polygons: list[tuple[Point, ...]], half_height: float) -> Mesh:
    """A plate of convex polygons in the plane z = 0; edges of one polygon alone become walls."""
    index: dict[tuple[float, float], int] = {}
    loops = []
    for polygon in polygons:
        keys = [(round(x, 9), round(y, 9)) for x, y, _ in polygon]
        loops.append([index.setdefault(key, len(index)) for key in keys])
    count = len(index)
    points = [(x, y, z) for z in (-half_height, half_height) for x, y in index]
    edges = Counter(edge for loop in loops for edge in zip(loop, loop[1:] + loop[:1], strict=True))
    faces: list[Face] = []
    for loop in loops:
        faces += [tuple(loop[::-1]), tuple(count + i for i in loop)]
    for i, j in edges:
        if (j, i) not in edges:
            faces.append((i, j, count + j, count + i))
    return Mesh(points, faces)


def joined(meshes: list[Mesh]) -> Mesh:
    points: list[Point] = []
    faces: list[Face] = []
    for mesh in meshes:
        faces += [tuple(len(points) + i for i in face) for face in mesh.faces]
        points += mesh.points
    return Mesh(points, faces)


def polar(radius: float, degrees: float) -> Point:
    angle = math.radians(degrees)
    return radius * math.cos(angle), radius * math.sin(angle), 0.0


def unit(v: Point) -> Point:
    length = math.hypot(*v)
    return v[0] / length, v[1] / length, v[2] / length


def cross(u: Point, v: Point) -> Point:
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def samples() -> dict[str, bytes]:
    """File name to content."""
    return {"kettle.obj": obj(kettle()), "snowflake.obj": obj(snowflake())}


def main() -> None:
    for name, content in samples().items():
        (HERE / name).write_bytes(content)


if __name__ == "__main__":
    main()
