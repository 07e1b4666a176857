"""Push bodies apart: overlapping pairs along their verified ways out, the deepest first, until
none is left.

After M. Müller et al., "Position based dynamics" (2007), without time and velocities. Two bodies
share a push, unless one had to make way for a body that stays, directly or through others: it gives
way no more, as in the shock propagation of E. Guendelman et al., "Nonconvex Rigid Bodies with
Stacking" (2003).

If pushing does not help, one body goes to a free place. Each body is then taken as a
discrete-orientation polytope: Klosowski et al., "Efficient Collision Detection Using Bounding
Volume Hierarchies of k-DOPs" (1998), with 26 planes. Along a ray of translations two such polytopes
overlap in one interval, so the first point outside of all intervals is certainly free. A shorter
free translation may exist.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection
from itertools import product

import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache
from satcheck.audit.body import PlacedBody, largest_coordinate
from satcheck.audit.resolve.conflicts import BodyPair, Checked, check_at_rest, longer, translated
from satcheck.audit.settings import Settings
from satcheck.audit.vectors import added, dot, scaled
from satcheck.core.conventions import Vector
from satcheck.core.half_space import plane_of
from satcheck.core.rounding import rounding_pad
from satcheck.scene import Scene

ORIGIN: Vector = (0.0, 0.0, 0.0)
# A round pushes all overlaps if there are more than these; else at most one for each body, its
# deepest: shallow overlaps often end with the deep ones.
MANY = 64
# After HOLD pushes one body of a pair is held while the other makes way; after PATIENCE pushes one
# goes to a free place.
HOLD, PATIENCE = 3, 12
# Rounding may leave a rest of an overlap. Each push of a pair goes beyond it, by this factor more.
REPAIR_GROWTH = 4.0

Progress = Callable[[int, int], None]
Array = npt.NDArray[np.float64]

# One of each opposite pair of directions to the faces, edges and corners of a cube.
AXES = np.array(
    [
        np.array(way) / math.sqrt(sum(map(abs, way)))
        for way in product((-1, 0, 1), repeat=3)
        if way > (0, 0, 0)
    ]
)
RAYS = np.concatenate([AXES, -AXES])
# The cosine of the angle between an axis and a normal that count as parallel.
PARALLEL = 1 - 1e-12


class Pushing:
    """offsets: of the bodies, by id. left: pairs that were given up, with the reason. rounds: so
    far. failing: pairs that fail where the bodies are."""

    def __init__(
        self, scene: Scene, settings: Settings, staying: Collection[str], longest: float
    ) -> None:
        """scene: sorted, at rest and strict. settings: they ask for the depth."""
        self._scene = scene
        self._settings = settings
        self._longest = longest
        self._home = {body.id: body for body in scene.bodies}
        self._bodies = dict(self._home)
        self._cache = BodyCache()
        self._pushes: Counter[BodyPair] = Counter()
        # 0: the body stays. k: it made way for a body of rank k - 1. inf: it is free to share.
        self._ranks = {id_: 0.0 if id_ in staying else math.inf for id_ in self._home}
        self._movable = frozenset(self._home) - frozenset(staying)
        self.offsets = dict.fromkeys(self._home, ORIGIN)
        self.left: dict[BodyPair, str] = {}
        self.failing: Collection[BodyPair] = ()
        self.rounds = 0

    def run(self, most: int, progress: Progress | None = None) -> None:
        """Push until only pairs in `left` overlap, at most `most` rounds. Then move bodies that
        still overlap to free places."""
        seen = self._check()
        extent = {id_: extents(body) for id_, body in self._cache.placed.items()}
        started = 0
        while overlaps := self._overlaps(seen):
            started = max(started, len(overlaps))
            if progress is not None:
                progress(started - len(overlaps), started)
            stuck = [next(iter(overlaps))]
            if self.rounds < most:
                stuck = self._push_all(overlaps)
                self.rounds += 1
            taken: set[str] = set()
            for pair in stuck:
                if taken.isdisjoint(pair):
                    taken.update(pair)
                    self._take_out(pair, extent, seen)
            seen = self._check()

    def _check(self) -> Checked:
        scene = replace(self._scene, bodies=tuple(self._bodies.values()))
        seen = check_at_rest(scene, self._settings, self._cache)
        self.failing = seen.conflicts
        return seen

    def _overlaps(self, seen: Checked) -> dict[BodyPair, Vector]:
        """Return the pushes of pairs with a movable body, the longest first."""
        pushes = {
            pair: conflict.push or ORIGIN
            for pair, conflict in seen.conflicts.items()
            if pair not in self.left and not self._movable.isdisjoint(pair)
        }
        return dict(sorted(pushes.items(), key=lambda entry: -math.hypot(*entry[1])))

    def _push_all(self, overlaps: dict[BodyPair, Vector]) -> list[BodyPair]:
        """Return the pairs that no push helps."""
        goals = {
            pair: added(self._apart(pair), self._farther(pair, push))
            for pair, push in overlaps.items()
        }
        taken: set[str] = set()
        stuck = []
        for pair, push in overlaps.items():
            if len(overlaps) <= MANY and not taken.isdisjoint(pair):
                continue
            taken.update(pair)
            self._pushes[pair] += 1
            hopeless = not any(push) or self._pushes[pair] > PATIENCE
            if hopeless or not self._push(pair, goals[pair], push):
                stuck.append(pair)
        return stuck

    def _apart(self, pair: BodyPair) -> Vector:
        """Return by how much more A was moved than B."""
        return added(self.offsets[pair[0]], scaled(self.offsets[pair[1]], -1.0))

    def _farther(self, pair: BodyPair, push: Vector) -> Vector:
        if not self._pushes[pair] or not any(push):
            return push
        pad = rounding_pad(largest_coordinate(*(self._cache.placed[id_].bounds for id_ in pair)))
        return longer(push, pad * REPAIR_GROWTH ** self._pushes[pair])

    def _push(self, pair: BodyPair, goal: Vector, push: Vector) -> bool:
        """Push the pair as far as other pushes of the round have not. Return False where neither
        body may go so far."""
        ranks, (a, b) = self._ranks, pair
        rest = added(goal, scaled(self._apart(pair), -1.0))
        along = dot(push, rest)
        if along <= 0.0:
            return True
        rest = scaled(push, along / dot(push, push))
        if ranks[a] == ranks[b] and self._pushes[pair] > HOLD:
            held, other = sorted(pair, key=lambda id_: math.hypot(*self.offsets[id_]))
            ranks[held] = min(ranks[held], 1.0)
            ranks[other] = ranks[held] + 1.0
        usual = 0.5 if ranks[a] == ranks[b] else float(ranks[a] > ranks[b])
        for share in (usual, 1.0, 0.0):
            shares = {id_: part for id_, part in ((a, share), (b, share - 1.0)) if part}
            ways = {id_: added(self.offsets[id_], scaled(rest, p)) for id_, p in shares.items()}
            if all(ranks[id_] and math.hypot(*way) <= self._longest for id_, way in ways.items()):
                for one, other in ((a, b), (b, a)):
                    if other not in ways:
                        ranks[one] = min(ranks[one], ranks[other] + 1.0)
                for id_, way in ways.items():
                    self._move(id_, way)
                return True
        return False

    def _move(self, id_: str, offset: Vector) -> None:
        """Put the body at this translation from home."""
        self.offsets[id_] = offset
        self._bodies[id_] = translated(self._home[id_], offset)

    def _take_out(self, pair: BodyPair, extent: dict[str, np.ndarray], seen: Checked) -> None:
        """Move the body with the shorter way to a free place, where it stays. If none has a free
        place, give up the pair. extent: of the bodies at home."""
        ways = []
        for id_ in self._movable.intersection(pair):
            way = self._free_place(id_, extent, seen)
            if way is not None:
                ways.append((math.hypot(*way), id_, way))
        if not ways:
            self.left[pair] = "no free place was found within the longest motion allowed"
            return
        _, id_, way = min(ways)
        self._move(id_, way)
        self._ranks[id_] = 0.0

    def _free_place(self, id_: str, extent: dict[str, np.ndarray], seen: Checked) -> Vector | None:
        assert self._cache.book is not None
        place = {other: number for number, other in enumerate(self._scene.order)}
        others = [
            other
            for other in extent
            if other != id_ and self._cache.book.is_checked(place[id_], place[other])
        ]
        requests = [seen.planner.request(*sorted((place[id_], place[k]))) for k in others]
        shifts = np.array([self.offsets[other] for other in others]) @ AXES.T
        gaps = np.array([request.clearance or 0.0 for request in requests])
        there = np.stack([extent[other] for other in others]) + shifts[:, None]
        return free_place(extent[id_], there, gaps, self._longest)


def extents(body: PlacedBody) -> Array:
    """(2, axes): the lowest and the highest projections on the axes. A half space ends along its
    normal alone."""
    along = body.mesh.vertices @ AXES.T
    low, high = along.min(axis=0), along.max(axis=0)
    if body.endless:
        up = AXES @ np.array(plane_of(body.body.transform).unit)
        low, high = np.where(up < -PARALLEL, low, -np.inf), np.where(up > PARALLEL, high, np.inf)
    return np.stack([low, high])


def free_place(body: Array, others: Array, gaps: Array, longest: float) -> Vector | None:
    """Return a translation of the body, of at most `longest`, that keeps a gap from each other one.
    None: no ray has one.

    body: its extents. others: (bodies, 2, axes). gaps: (bodies,).
    """
    reach = np.abs(np.concatenate([body.ravel(), others.ravel()]))
    pad = gaps[:, None] + 2 * rounding_pad(float(reach.max(where=np.isfinite(reach), initial=0.0)))
    # It overlaps another one at s along a ray while below < s * rate < above on each axis.
    below, above = others[:, 0] - pad - body[1], others[:, 1] + pad - body[0]
    ways = [(_first_free(*_blocked(below, above, AXES @ ray)), ray) for ray in RAYS]
    length, ray = min(ways, key=lambda way: way[0])
    if length > longest or math.isinf(length):
        return None
    x, y, z = (length * ray).tolist()
    return x, y, z


def _blocked(below: Array, above: Array, rates: Array) -> tuple[Array, Array]:
    """(starts, ends) of the interval of a ray that each body blocks. rates: how fast a point of the
    ray moves along each axis."""
    level = np.abs(rates) < 1e-12
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = below / rates, above / rates
    meets = (below < 0) & (above > 0)
    start = np.where(level, np.where(meets, -np.inf, np.inf), np.minimum(*ends))
    stop = np.where(level, np.where(meets, np.inf, -np.inf), np.maximum(*ends))
    return start.max(axis=1), stop.min(axis=1)


def _first_free(start: Array, stop: Array) -> float:
    """Return the least s >= 0 outside of all intervals; inf: an interval has no end."""
    blocked = (start < stop) & (stop > 0)
    at = 0.0
    for low, high in sorted(zip(start[blocked].tolist(), stop[blocked].tolist(), strict=True)):
        if low >= at:
            break
        at = max(at, high)
    return at
