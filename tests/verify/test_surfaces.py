"""Triangles that meet: on a small grid, where nearly everything is degenerate, beside the core."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck import core
from satcheck.verify import surfaces
from satcheck.verify.surfaces import meeting
from satcheck.verify.world import Exact, World

ONE = np.array([[0, 1, 2]])


def exact(points: np.ndarray, triangles: np.ndarray) -> Exact:
    return Exact(World(points, triangles, False), 0)


def test_single_triangles_meet_where_the_core_says_so() -> None:
    random = np.random.default_rng(11)
    seen = {True: 0, False: 0}
    for _ in range(400):
        p, q = random.integers(0, 4, size=(2, 3, 3)).astype(float)
        a, b = (core.Surface(core.Mesh(c, ONE.astype(np.uint32)), False) for c in (p, q))
        meet = core.mesh_relation(a, b).relation != "separated"
        assert bool(meeting(exact(p, ONE), exact(q, ONE))) == meet
        seen[meet] += 1
    assert min(seen.values()) > 50


def test_no_pair_is_lost_between_many(monkeypatch: pytest.MonkeyPatch) -> None:
    """In small blocks, so that the halving is what is tested."""
    monkeypatch.setattr(surfaces, "BLOCK", 8)
    random = np.random.default_rng(5)
    count, k = 25, 6
    soups = []
    for _ in range(2):
        centres = random.random((count, 1, 3)) * 3
        corners = centres + random.random((count, 3, 3)) - 0.5
        soups.append(np.round(corners * 2**k) / 2**k)
    triangles = np.arange(3 * count).reshape(-1, 3)
    a, b = (Exact(World(soup.reshape(-1, 3), triangles, False), k) for soup in soups)
    singles = [[Exact(World(c, ONE, False), k) for c in soup] for soup in soups]
    alone = {
        (s, t) for s in range(count) for t in range(count) if meeting(singles[0][s], singles[1][t])
    }
    assert set(meeting(a, b)) == alone
    assert 0 < len(alone) < count * count
