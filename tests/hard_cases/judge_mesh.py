"""The triangle rung on mesh pairs by exact truth: relation both ways, distance, variants."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from satcheck import core
from tests.hard_cases.mesh_case import MIRRORED, MeshData, MeshPair
from tests.hard_cases.score import Score
from tests.oracles.exact_distance import root

# A surface distance comes without an interval. It is the root of a sum of three squares of sums of
# products of coordinate differences: 16 roundoffs of the largest coordinate cover it.
ROUNDOFFS = 16


def judge_mesh(pair: MeshPair, score: Score) -> None:
    score.cases += 1
    a, b = surface(pair.a), surface(pair.b)
    judge_relation(a, b, pair.relation, pair.name, score)
    judge_relation(b, a, MIRRORED.get(pair.relation, pair.relation), f"{pair.name}, swapped", score)
    for name, (c, d) in variants(pair).items():
        judge_relation(surface(c), surface(d), pair.relation, f"{pair.name}, {name}", score)
    if pair.squared is not None:
        judge_distance(pair, pair.squared, core.mesh_distance(a, b).distance, score)


def surface(data: MeshData) -> core.Surface:
    mesh = core.Mesh(np.array(data.vertices), np.array(data.triangles, dtype=np.int64))
    if not mesh.topology().solid:
        raise ValueError("a mesh that is no solid")
    return core.Surface(mesh, True)


def judge_relation(
    a: core.Surface, b: core.Surface, expected: str, what: str, score: Score
) -> None:
    score.answers += 1
    found = core.mesh_relation(a, b)
    if not found.proven:
        score.fail("undecided", f"{what}: {found.relation}, not proven")
    elif found.relation != expected:
        score.fail("wrong", f"{what}: {found.relation}, in truth {expected}")


def judge_distance(pair: MeshPair, squared: Fraction, distance: float, score: Score) -> None:
    score.answers += 1
    low, high = root(squared)
    error = float(max(low - Fraction(distance), Fraction(distance) - high, Fraction(0)))
    points = np.array(pair.a.vertices + pair.b.vertices)
    size = float(np.ptp(points, axis=0).max())
    granted = ROUNDOFFS * 2.0**-53 * float(np.abs(points).max())
    score.error = max(score.error, error / size)
    score.share = max(score.share, error / granted)
    if error > granted:
        score.fail("outside", f"{pair.name}: distance {distance!r}, in truth {float(low)!r}")


def variants(pair: MeshPair) -> dict[str, tuple[MeshData, MeshData]]:
    """Motions that float64 does exactly, and other orders of vertices and triangles."""
    return {
        "turned": (turned(pair.a), turned(pair.b)),
        "scaled": (scaled(pair.a), scaled(pair.b)),
        "reordered": (reordered(pair.a), reordered(pair.b)),
    }


def turned(data: MeshData) -> MeshData:
    return MeshData(tuple((z, x, y) for x, y, z in data.vertices), data.triangles)


def scaled(data: MeshData) -> MeshData:
    factor = 2.0**7
    return MeshData(
        tuple((x * factor, y * factor, z * factor) for x, y, z in data.vertices), data.triangles
    )


def reordered(data: MeshData) -> MeshData:
    last = len(data.vertices) - 1
    triangles = tuple((last - q, last - r, last - p) for p, q, r in reversed(data.triangles))
    return MeshData(data.vertices[::-1], triangles)
