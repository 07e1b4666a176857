"""The contacts of the bodies of a report, found again, and how deep two bodies may overlap.

The definition of a contact is that of docs/support.md: a vertex over a face, or an edge across an
edge, within the tolerance, with a normal that separates the two bodies there. Directions are
computed in float64; every comparison has a slack of SLACK of the tolerance in favour of a contact,
so that none is missed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from satcheck.report.certificate import SurfacesProof
from satcheck.report.statics import BodyContact, ContactPoint
from satcheck.verify.bodies import Placed, box_gaps
from satcheck.verify.exact import Floats, NotCertified, Rejected, cross, grouped
from satcheck.verify.findings import prove_way_out
from satcheck.verify.pairs import vector
from satcheck.verify.relations import check_apart
from satcheck.verify.surfaces import near_pairs, next_points
from satcheck.verify.world import Exact, Indices, World

SLACK = 1e-6
# Edges whose directions differ by less than this sine are parallel: their ends decide.
PARALLEL = 1e-6
# With more pairs of near triangles a check would take too long.
MOST_NEAR = 300_000
# The sine of an angle below which two faces are one plane; that of the search is smaller.
FLAT = 1e-10
# How far two computations of one contact may be off: of the largest coordinate, and of a normal.
SAME_PLACE, SAME_NORMAL = 1e-9, 1e-6
# Of the rounding of coordinates, as in the search for contacts, and as much to spare.
ROUNDING, SHARE = 2.0**-46, 0.02
# Directions in which an overlap may be shallow. With more, none is looked for.
MOST_WAYS = 30


class Contacts:
    """bodies: of the report, by id. tolerance: of contacts."""

    def __init__(self, bodies: Mapping[str, Placed], tolerance: float) -> None:
        self._bodies, self._tolerance = bodies, tolerance
        self._found, self._shallow = cache(self._places), cache(self._is_shallow)

    def near(self, name: str) -> list[str]:
        """Other bodies whose boxes are within the tolerance, or unknown."""
        low, high = self._boxes
        own = list(self._bodies).index(name)
        gap = np.maximum(low - high[own], low[own] - high).max(axis=1)
        near = gap <= self._tolerance * (1 + SLACK)
        return [
            id_ for id_, is_near in zip(self._bodies, near, strict=True) if is_near and id_ != name
        ]

    @cached_property
    def _boxes(self) -> Floats:
        """The lower ends of all boxes, and the upper ones, (2, n, 3)."""
        everywhere = np.full(3, -np.inf), np.full(3, np.inf)
        boxes = [body.bounds or everywhere for body in self._bodies.values()]
        return np.array(boxes).reshape(-1, 2, 3).swapaxes(0, 1)

    def between(self, a: str, b: str) -> list[Place]:
        """Contacts of A and B, normals from B to A. Raises NotCertified if they cannot be found."""
        if b < a:
            return [place.turned for place in self.between(b, a)]
        try:
            return self._found(a, b)
        except Rejected as why:
            raise NotCertified(f"the contacts of {a} and {b}: {why}") from None

    def _places(self, a: str, b: str) -> list[Place]:
        one, other, tolerance = self._bodies[a], self._bodies[b], self._tolerance
        if max(box_gaps(one, other)) > tolerance * (1 + SLACK):
            return []
        rounding = self.rounding(a, b)
        of_a, of_b = self._surfaces.get(a), self._surfaces.get(b)
        if of_a is not None and of_b is not None:
            return places_of(of_a, of_b, tolerance, rounding)
        if of_b is not None:
            centre, radius = one.ball
            return places_of_ball(np.array(centre), radius, of_b, tolerance, rounding)
        if of_a is not None:
            return [place.turned for place in self._places(b, a)]
        (p, r), (q, s) = one.ball, other.ball
        step = np.subtract(p, q)
        distance = float(np.linalg.norm(step))
        height = distance - r - s
        if abs(height) > tolerance * (1 + SLACK) or distance == 0:
            return []
        n = step / distance
        return [Place(np.array(q) + n * (s + 0.5 * height), n, height, True)]

    @cached_property
    def _surfaces(self) -> dict[str, Surface]:
        return {
            id_: Surface(body.world) for id_, body in self._bodies.items() if body.world is not None
        }

    def at(self, contact: BodyContact, point: ContactPoint) -> Place:
        """The contact of the bodies at this point and along this normal."""
        far = SAME_PLACE * max(self.largest(contact.a), self.largest(contact.b))
        at, normal = np.array(point.at), np.array(point.normal)
        same = [
            place
            for place in self.between(contact.a, contact.b)
            if np.abs(place.at - at).max() <= far
            and np.abs(place.normal - normal).max() <= SAME_NORMAL
        ]
        if not same:
            raise Rejected(f"{contact.a} and {contact.b} have no contact where a force acts")
        return min(same, key=lambda place: (not place.exact, np.abs(place.normal - normal).max()))

    def is_strict(self, a: str, b: str, place: Place) -> bool:
        """Whether the contact is as near as the nearest one, and needs no tolerance."""
        exact = [p.height for p in self.between(a, b) if p.exact]
        return place.exact and place.height <= min(exact) + 4 * self.rounding(a, b)

    def check_shallow(self, a: str, b: str) -> None:
        """Raises NotCertified if A and B may overlap by more than the tolerance: they may, unless A
        is seen to be free once it is moved by the tolerance along the normal of a contact. So may
        bodies that are thinner than the tolerance."""
        a, b = sorted((a, b))
        if not self._shallow(a, b):
            raise NotCertified(f"how deep {a} and {b} overlap is not certified")

    def _is_shallow(self, a: str, b: str) -> bool:
        one, other = self._bodies[a], self._bodies[b]
        reach = self._tolerance * (1 + SLACK)
        if one.world is None or other.world is None:
            return _passes(check_apart, one, other, -reach)
        places = self.between(a, b)
        if not places:
            return _passes(check_apart, one, other, self._tolerance)
        normals = np.unique([place.normal for place in places], axis=0)
        p, q = (world.used[1] for world in (one.world, other.world))
        if any(np.ptp(p @ n) + np.ptp(q @ n) <= 2 * reach for n in normals):
            return False  # so thin that a contact may be on the far side
        if any((p @ n).min() - (q @ n).max() >= -reach for n in normals):
            return True
        ways = np.unique(np.round(normals, 9), axis=0)[:MOST_WAYS] * reach
        return any(
            _passes(prove_way_out, vector(way), SurfacesProof(), one, other)
            for way in ways.tolist()
        )

    def largest(self, name: str) -> float:
        """The largest coordinate."""
        low, high = self._bounds(name)
        return float(max(np.abs(low).max(), np.abs(high).max()))

    def size(self, name: str) -> float:
        """The diagonal of the box."""
        low, high = self._bounds(name)
        return float(np.linalg.norm(high - low))

    def _bounds(self, name: str) -> tuple[Floats, Floats]:
        bounds = self._bodies[name].bounds
        if bounds is None:
            raise Rejected(f"{name} cannot be read")
        return bounds

    def rounding(self, a: str, b: str) -> float:
        """How far coordinates of A and B may be off by themselves."""
        written = self._bodies[a].resolution + self._bodies[b].resolution
        largest = max(self.largest(a), self.largest(b))
        return min(2 * written, SHARE * self._tolerance) + ROUNDING * largest


def _passes(check: Callable[..., None], *arguments: object) -> bool:
    try:
        check(*arguments)
    except Rejected:
        return False
    return True


@dataclass(frozen=True, slots=True)
class Place:
    """at: world. normal: unit, from B to A. height: of A over B along it. exact: no tolerance bends
    the normal or widens the place, up to rounding."""

    at: Floats
    normal: Floats
    height: float
    exact: bool

    @classmethod
    def of(cls, at: Floats, step: Floats, n: Floats, low: float, rounding: float) -> Place:
        """step: from B to A, next to each other there. low: how far faces reach below it along
        n."""
        height = float(step @ n)
        aside = float(np.linalg.norm(step - height * n))
        return cls(at, n, height, low >= -2 * rounding and aside <= rounding)

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
        faces = grouped((v, t) for t, c in enumerate(self.triangles.tolist()) for v in c)
        return {
            v: (np.setdiff1d(self.triangles[own], [v]), np.array(own)) for v, own in faces.items()
        }

    @cached_property
    def edges(self) -> dict[tuple[int, int], list[tuple[int, int]]]:
        """(u, v), u < v -> (face, its third vertex) of each face at the edge."""
        return grouped(
            (side, (t, corners[k - 1]))
            for t, corners in enumerate(self.triangles.tolist())
            for k, side in enumerate(_sides(corners))
        )

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
    places += _on_faces(a, b, sorted(of_a), near, rounding)
    places += (place.turned for place in _on_faces(b, a, sorted(of_b), near, rounding))
    for p, q in sorted(edges):
        places += _across(a, b, p, q, near, rounding)
    return places


def _sides(corners: list[int]) -> list[tuple[int, int]]:
    i, j, k = corners
    return [(min(u, v), max(u, v)) for u, v in ((i, j), (j, k), (k, i))]


def _on_faces(
    a: Surface, b: Surface, pairs: list[tuple[int, int]], near: float, rounding: float
) -> Iterator[Place]:
    """Vertices of A over faces of B."""
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
        yield Place.of(feet[k], step, n, lowest, rounding)


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
    on_a, on_b = _nearest(p0, u, q0, v, float(n @ n))
    step = on_a - on_b
    if step @ step > near * near:
        return
    for normal in (n / sine, -n / sine):
        low, out_a = _below(a, p, p0, normal)
        high, out_b = _below(b, q, q0, -normal)
        if min(low, high) < -2 * near or out_a >= SLACK or out_b >= SLACK:
            continue
        yield Place.of(0.5 * (on_a + on_b), step, normal, min(low, high), rounding)


def _below(s: Surface, edge: tuple[int, int], at: Floats, n: Floats) -> tuple[float, float]:
    """How far the faces of an edge reach below it along n, and the least n . normal of them."""
    faces = s.edges[edge]
    wings = s.points[[w for _, w in faces]]
    return float(((wings - at) @ n).min()), float((s.normals[[t for t, _ in faces]] @ n).min())


def _nearest(p: Floats, u: Floats, q: Floats, v: Floats, area: float) -> tuple[Floats, Floats]:
    """The nearest points of two lines that are not parallel, moved to the ends of the segments.
    area: |u x v|^2."""
    w = p - q
    uu, uv, vv, uw, vw = (float(x @ y) for x, y in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    s = min(max((uv * vw - vv * uw) / area, 0.0), 1.0)
    t = min(max((uu * vw - uv * uw) / area, 0.0), 1.0)
    return p + s * u, q + t * v


def _cross(u: Floats, v: Floats) -> Floats:
    """Of two vectors; np.cross takes ten times as long for a single pair."""
    return np.array(cross(u.tolist(), v.tolist()))


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
