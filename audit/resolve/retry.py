"""Attempts to shorten the result of the rounds: other starts, and a new search for each body alone.

The rounds start at home and end at a local minimum. Two things may shorten the result:

- One body with a short way out goes first. The others then only resolve what remains.
- A body that was pushed several times may have a shorter way to a place that is free now.

Both need the shortest way of one body while the others stay (`way_alone`). The others become one
mesh, and `core.search_depth` searches the translations that free the body from this mesh. Width and
budget are those of the depth of a pair. A shorter result is kept only if it is proven free.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

import numpy as np

from satcheck import core
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.escape import FREE
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.pull_back import pull_back, swept
from satcheck.audit.resolve.rounds import Rounds
from satcheck.audit.resolve.walls import ORIGIN, BodyPair
from satcheck.core.conventions import Vector

# A body with more triangles around it is not tried.
MOST_TRIANGLES = 500_000
# At most STARTS bodies are tried as the first; at most SINGLES moved bodies are tried alone, in
# each of PASSES passes.
STARTS = 16
SINGLES = 32
PASSES = 3
# A smaller relative decrease of the sum of squares does not count.
LEAST_GAIN = 1e-6


def retry(layout: Layout, overlaps: Collection[BodyPair], longest: float, iterations: int) -> None:
    """Shorten the translations of bodies that no longer overlap.

    overlaps: the pairs that overlapped at home."""
    tried = 0
    for group in _groups(layout, overlaps):
        first = sorted({i for pair in overlaps for i in pair if i in group})
        for i in first[: STARTS - tried]:
            tried += 1
            _start_with(layout, i, group, longest, iterations)
    for _ in range(PASSES):
        if not _each_alone(layout):
            return
        pull_back(layout, (), longest)


def _groups(layout: Layout, overlaps: Iterable[BodyPair]) -> list[frozenset[int]]:
    """The bodies that moved or overlapped, grouped by those that may meet; longest motions
    first."""
    ways = [swept(a.bounds, b.bounds) for a, b in zip(layout.home, layout.placed, strict=True)]
    moved = {i for i, offset in enumerate(layout.offsets) if offset != ORIGIN}
    moved |= {i for pair in overlaps for i in pair} & layout.movable
    group = {i: {i} for i in moved}
    for i, j in (*overlaps, *layout.close_pairs(ways)):
        if i in moved and j in moved and group[i] is not group[j]:
            group[i] |= group[j]
            group.update(dict.fromkeys(group[j], group[i]))
    distinct = {min(members): frozenset(members) for members in group.values()}
    return sorted(distinct.values(), key=lambda group: (-layout.squares(group), min(group)))


def _start_with(
    layout: Layout, i: int, group: frozenset[int], longest: float, iterations: int
) -> None:
    """Move one body first, then the others of its group as far as they still have to move. Moved
    bodies of other groups stay."""
    before, movable = list(layout.offsets), layout.movable
    elsewhere = {j for j, offset in enumerate(before) if offset != ORIGIN and j not in group}
    squares = layout.squares()
    layout.movable = movable - elsewhere
    layout.move(dict.fromkeys(group, ORIGIN))
    way = way_alone(layout, i, min(longest, math.sqrt(squares)))
    if way is not None:
        rounds = Rounds(layout, longest)
        rounds.put(i, way)
        rounds.run(iterations)
        pull_back(layout, rounds.left, longest)
    layout.movable = movable
    worse = layout.squares() > squares * (1 - LEAST_GAIN)
    if way is None or rounds.left or worse:
        layout.move(dict(enumerate(before)))


def _each_alone(layout: Layout) -> bool:
    """Give each moved body its shortest way while the others stay; whether any way got shorter."""
    moved = [i for i, offset in enumerate(layout.offsets) if offset != ORIGIN]
    moved.sort(key=lambda i: -math.hypot(*layout.offsets[i]))
    return sum(_goes_alone(layout, i) for i in moved[:SINGLES]) > 0


def _goes_alone(layout: Layout, i: int) -> bool:
    before: Vector = layout.offsets[i]
    way = way_alone(layout, i, (1 - LEAST_GAIN) * math.hypot(*before))
    if way is None:
        return False
    layout.move({i: way})
    around = [pair for pair in layout.close_pairs() if i in pair]
    if all(state.kind == "free" for state in layout.states(around).values()):
        return True
    layout.move({i: before})
    return False


def way_alone(layout: Layout, i: int, longest: float) -> Vector | None:
    """A translation from home, shorter than `longest`, that frees the body from all others. World
    units. None: none was found, or a body nearby has no inside, is curved, may overlap the body, or
    must keep a clearance from it."""
    home, around = layout.home[i], _around(layout, i, longest)
    if around is None or not math.isfinite(longest):
        return None
    if not around:
        return ORIGIN
    obstacle = _as_one(around)
    if core.mesh_relation(home.surface(), obstacle).relation in FREE:
        return ORIGIN
    settings = layout.settings
    return core.search_depth(
        home.surface(),
        obstacle,
        upper=longest,
        lower=0.0,
        width=settings.depth_width,
        work=settings.work,
        across=settings.across,
    ).way_out


def _around(layout: Layout, i: int, longest: float) -> list[PlacedBody] | None:
    """The bodies that it may meet within `longest`; None: one of them is no solid mesh, may overlap
    the body, or must keep a clearance."""
    home = layout.home[i]
    near = []
    for j, other in enumerate(layout.placed):
        if j == i or not layout.is_checked((i, j)):
            continue
        if core.box_gap(home.bounds, other.bounds) - layout.clearance((i, j)) > longest:
            continue
        if layout.clearance((i, j)) or layout.is_limited((i, j)):
            return None
        near.append(other)
    solid = all(body.solid and body.curved is None for body in (home, *near))
    few = sum(body.mesh.triangle_count for body in near) <= MOST_TRIANGLES
    return near if solid and few else None


def _as_one(bodies: list[PlacedBody]) -> core.Surface:
    if len(bodies) == 1:
        return bodies[0].surface()
    meshes = [body.mesh for body in bodies]
    firsts = np.cumsum([0, *(mesh.vertex_count for mesh in meshes)])
    triangles = [mesh.triangles + first for mesh, first in zip(meshes, firsts, strict=False)]
    mesh = core.Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(triangles).astype(np.uint32),
    )
    return core.Surface(mesh, True)
