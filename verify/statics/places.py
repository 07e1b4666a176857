"""The contacts of two meshes, found again from all pairs of near triangles.

The definition is that of docs/support.md: a vertex over a face, or an edge across an edge, within
the tolerance, with a normal that separates the two bodies there. Directions are computed in
float64; every comparison has a slack of SLACK of the tolerance in favour of a contact, so that none
is missed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from satcheck.verify.exact import Floats
from satcheck.verify.patches import next_points
from satcheck.verify.surfaces import near_pairs
from satcheck.verify.world import Exact, Indices, World

SLACK = 1e-6
# Edges whose directions differ by less than this sine are parallel: their ends decide.
PARALLEL = 1e-6
# With more pairs of near triangles a check would take too long.
MOST_NEAR = 300_000
# The sine of an angle below which two faces are one plane; that of the search is smaller.
FLAT = 1e-10


@dataclass(frozen=True, slots=True)
class Place:
    """at: world. normal: unit, from B to A. height: of A over B along it. exact: no tolerance bends
    the normal or widens the place, up to rounding."""

    at: Floats
    normal: Floats
    height: float
    exact: bool

    @property
    def turned(self) -> Place:
        """As a contact of B and A."""
        return replace(self, normal=-self.normal)


class Surface:
    """A mesh in the world, with the neighbours of its vertices and the faces of its edges. A sheet
    has a face on either side."""

    def __init__(self, world: World) -> None:
        triangles = world.triangles
        if not world.solid:
            triangles = np.concatenate([triangles, triangles[:, ::-1]])
        corners = world.vertices[triangles]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(across, axis=1)
        sound = size > 0
        self.triangles: Indices = triangles[sound]
        self.normals: Floats = across[sound] / size[sound, None]
        self.points = world.vertices
        self._sharp: dict[tuple[int, int], bool] = {}
        self.exact = Exact(World(world.vertices, self.triangles, solid=False), 0)

    @cached_property
    def around(self) -> dict[int, tuple[Indices, Indices]]:
        """vertex -> (its neighbours, its faces)."""
        faces: dict[int, list[int]] = {}
        for t, corners in enumerate(self.triangles.tolist()):
            for v in corners:
                faces.setdefault(v, []).append(t)
        return {
            v: (np.setdiff1d(self.triangles[own], [v]), np.array(own)) for v, own in faces.items()
        }

    @cached_property
    def edges(self) -> dict[tuple[int, int], list[tuple[int, int]]]:
        """(u, v), u < v -> (face, its third vertex) of each face at the edge."""
        edges: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for t, (i, j, k) in enumerate(self.triangles.tolist()):
            for u, v, w in ((i, j, k), (j, k, i), (k, i, j)):
                edges.setdefault((min(u, v), max(u, v)), []).append((t, w))
        return edges

    def is_sharp(self, edge: tuple[int, int]) -> bool:
        """Whether its faces lie in several planes: a flat edge is no corner of any patch."""
        if edge not in self._sharp:
            first, *others = (self.normals[t] for t, _ in self.edges[edge])
            self._sharp[edge] = not others or any(
                first @ n < 0 or np.abs(_cross(first, n)).max() > FLAT for n in others
            )
        return self._sharp[edge]


def places_of(a: Surface, b: Surface, tolerance: float, rounding: float) -> list[Place]:
    """All contacts of A and B."""
    near = tolerance * (1 + SLACK)
    places: list[Place] = []
    of_a: set[tuple[int, int]] = set()
    of_b: set[tuple[int, int]] = set()
    edges: set[tuple[tuple[int, int], tuple[int, int]]] = set()
    for s, t in near_pairs(a.exact, b.exact, near, MOST_NEAR):
        for i, j in zip(s.tolist(), t.tolist(), strict=True):
            p, q = a.triangles[i].tolist(), b.triangles[j].tolist()
            of_a |= {(v, j) for v in p}
            of_b |= {(v, i) for v in q}
            edges |= {
                (e, f) for e in _sides(p) if a.is_sharp(e) for f in _sides(q) if b.is_sharp(f)
            }
    places += _on_faces(a, b, sorted(of_a), near, rounding, 1.0)
    places += _on_faces(b, a, sorted(of_b), near, rounding, -1.0)
    for p, q in sorted(edges):
        places += _across(a, b, p, q, near, rounding)
    return places


def _sides(corners: list[int]) -> list[tuple[int, int]]:
    i, j, k = corners
    return [(min(u, v), max(u, v)) for u, v in ((i, j), (j, k), (k, i))]


def _on_faces(
    a: Surface, b: Surface, pairs: list[tuple[int, int]], near: float, rounding: float, sign: float
) -> Iterator[Place]:
    """Vertices of a over faces of b. sign: -1.0 where a is B."""
    v, face = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    points, normals = a.points[v], b.normals[face]
    feet = points + next_points(b.points[b.triangles[face]] - points[:, None])
    steps = points - feet
    for k in np.flatnonzero(np.einsum("nk,nk->n", steps, steps) <= near * near).tolist():
        p, n, step = points[k], normals[k], steps[k]
        neighbours, faces = a.around[int(v[k])]
        lowest = float(((a.points[neighbours] - p) @ n).min())
        if lowest < -2 * near or (a.normals[faces] @ n).min() >= SLACK:
            continue
        height = float(step @ n)
        aside = float(np.linalg.norm(step - height * n))
        exact = lowest >= -2 * rounding and aside <= rounding
        yield Place(feet[k], sign * n, height, exact)


def _across(
    a: Surface,
    b: Surface,
    p: tuple[int, int],
    q: tuple[int, int],
    near: float,
    rounding: float,
) -> Iterator[Place]:
    """An edge of A across an edge of B; the normal may have either sign."""
    p0, p1, q0, q1 = (*a.points[list(p)], *b.points[list(q)])
    u, v = p1 - p0, q1 - q0
    n = _cross(u, v)
    length, sine = np.linalg.norm(u) * np.linalg.norm(v), np.linalg.norm(n)
    if sine <= PARALLEL * length:
        return
    n = n / sine
    on_a, on_b = _nearest(p0, u, q0, v)
    step = on_a - on_b
    if step @ step > near * near:
        return
    for normal in (n, -n):
        low, out_a = _below(a, p, p0, normal)
        high, out_b = _below(b, q, q0, -normal)
        if min(low, high) < -2 * near or out_a >= SLACK or out_b >= SLACK:
            continue
        height = float(step @ normal)
        aside = float(np.linalg.norm(step - height * normal))
        exact = min(low, high) >= -2 * rounding and aside <= rounding
        yield Place(0.5 * (on_a + on_b), normal, height, exact)


def _below(s: Surface, edge: tuple[int, int], at: Floats, n: Floats) -> tuple[float, float]:
    """How far the faces of an edge reach below it along n, and the least n . normal of them."""
    faces = s.edges[edge]
    wings = s.points[[w for _, w in faces]]
    return float(((wings - at) @ n).min()), float((s.normals[[t for t, _ in faces]] @ n).min())


def _nearest(p: Floats, u: Floats, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """The nearest points of two lines that are not parallel, moved to the ends of the segments."""
    w = p - q
    uu, uv, vv, uw, vw = (float(x @ y) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    n = _cross(u, v)
    area = float(n @ n)
    s = min(max((uv * vw - vv * uw) / area, 0.0), 1.0)
    t = min(max((uu * vw - uv * uw) / area, 0.0), 1.0)
    return p + s * u, q + t * v


def _cross(u: Floats, v: Floats) -> Floats:
    """Of two vectors; np.cross takes ten times as long for a single pair."""
    (a, b, c), (d, e, f) = u.tolist(), v.tolist()
    return np.array((b * f - c * e, c * d - a * f, a * e - b * d))


def places_of_ball(
    centre: Floats, radius: float, mesh: Surface, tolerance: float, rounding: float
) -> list[Place]:
    """Of a ball (A), whose centre is outside of the mesh (B)."""
    near = tolerance * (1 + SLACK)
    corners = mesh.points[mesh.triangles]
    reach = radius + near
    low, high = corners.min(axis=1), corners.max(axis=1)
    close = np.flatnonzero(((low <= centre + reach) & (high >= centre - reach)).all(axis=1))
    feet = centre + next_points(corners[close] - centre)
    places = []
    for t, foot in zip(close.tolist(), feet, strict=True):
        step = centre - foot
        distance = float(np.linalg.norm(step))
        if abs(distance - radius) > near or step @ mesh.normals[t] <= 0:
            continue
        n = step / distance
        beside = [
            corners[u]
            for u, x in zip(close, feet, strict=True)
            if np.linalg.norm(x - foot) <= rounding
        ]
        if all(float(((c - foot) @ n).max()) <= 4 * rounding for c in beside):
            places.append(Place(foot, n, distance - radius, True))
    return places


def place_of_balls(
    centre: Floats, radius: float, other: Floats, other_radius: float, tolerance: float
) -> list[Place]:
    """Of two balls, A first."""
    step = centre - other
    distance = float(np.linalg.norm(step))
    height = distance - radius - other_radius
    if abs(height) > tolerance * (1 + SLACK) or distance == 0:
        return []
    n = step / distance
    return [Place(other + n * (other_radius + 0.5 * height), n, height, True)]
