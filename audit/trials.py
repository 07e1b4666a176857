"""Exact answers to "is A free once translated?", up to a number that is fixed beforehand."""

from __future__ import annotations

from collections import deque

from satcheck import core
from satcheck.audit.pair import Pair
from satcheck.audit.report import Vector
from satcheck.audit.triangles import crossing_hulls
from satcheck.audit.verify import FREE

# Exact trials for a pair of small meshes, and how many triangles the trials may visit in all, so
# that large meshes get fewer. A number and not a time: the same input gives the same answer.
MOST_TRIALS = 1000
LEAST_TRIALS = 24
TRIANGLES_IN_ALL = 8_000_000
# Crossing triangles that are remembered: they often still cross at the next translation.
BLOCKERS = 32


class Trials:
    """left: how many exact trials may still be made; made: how many were."""

    def __init__(self, pair: Pair) -> None:
        # The smaller mesh is moved, B the other way where it is B: its tree is built per trial.
        self._moves_a = pair.a.mesh.triangle_count <= pair.b.mesh.triangle_count
        self._pair = pair
        self._blockers: deque[tuple[core.Hull, core.Hull]] = deque(maxlen=BLOCKERS)
        size = pair.a.mesh.triangle_count + pair.b.mesh.triangle_count
        self.left = min(max(TRIANGLES_IN_ALL // size, LEAST_TRIALS), MOST_TRIALS)
        self.made = 0

    def relation_at(self, t: Vector) -> core.MeshRelation | None:
        """The relation once A has moved by t; None when no trial is left."""
        if self.left == 0:
            return None
        self.left -= 1
        self.made += 1
        a, b = self._pair.a, self._pair.b
        if self._moves_a:
            moved = core.Surface(a.mesh.translated(t), a.solid)
            return core.mesh_relation(moved, b.surface())
        moved = core.Surface(b.mesh.translated((-t[0], -t[1], -t[2])), b.solid)
        return core.mesh_relation(a.surface(), moved)

    def frees(self, t: Vector) -> bool:
        """Whether it is proven that A is free after moving by t; False when no trial is left."""
        for blocker_a, blocker_b in self._blockers:
            if core.check_pair(blocker_a, blocker_b, t, query="overlap").outcome == "penetrating":
                return False
        found = self.relation_at(t)
        if found is None:
            return False
        if found.proven and found.relation in FREE:
            return True
        if found.triangle_a >= 0 and found.triangle_b >= 0:
            crossing = (found.triangle_a, found.triangle_b)
            self._blockers.appendleft(crossing_hulls(self._pair, crossing))
        return False
