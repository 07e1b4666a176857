"""Each family does to the pair what it says: exact maps are exact, displacements are bounded."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from satcheck.studies.stability.retessellation import retessellate
from satcheck.studies.stability.variant import IDENTITY, Question, stretch
from satcheck.studies.stability.variants import (
    in_motion,
    noisy,
    reaxed,
    reordered,
    retessellated,
    scaled,
    translated,
)
from tests.audit.shapes import bracket, scene_of, unit_box

U = 2.0**-53


def question(folder: Path, *meshes) -> Question:
    scene = scene_of(folder, **dict(zip("ab", meshes, strict=True)))
    return Question(*(body.file for body in scene.bodies))


@pytest.fixture
def pair(tmp_path: Path) -> Question:
    return question(tmp_path, bracket(), unit_box(0.1, 0.7, -0.3))


def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def test_scales_are_exact_and_stay_in_range(tmp_path: Path, pair: Question) -> None:
    for variant in scaled(pair, 8, rng()):
        assert np.log2(variant.scale).is_integer()
        there = variant.b.world_mesh().vertices
        assert np.array_equal(there / variant.scale, pair.b.mesh.vertices)
    huge = question(tmp_path, unit_box(edge=1e44), unit_box(edge=1e44))
    assert all(variant.scale < 1 for variant in scaled(huge, 8, rng()))


def test_axes_are_permuted_and_mirrored_exactly(pair: Question) -> None:
    turns = set()
    for variant in reaxed(pair, 47, rng()):
        turn = np.array(variant.turn)
        assert np.array_equal(variant.a.world_mesh().vertices, pair.a.mesh.vertices @ turn.T)
        assert np.array_equal(turn @ turn.T, np.eye(3))
        turns.add(variant.turn)
    assert len(turns) == 47
    assert IDENTITY not in turns


def test_translations_round_nothing(pair: Question) -> None:
    for variant in translated(pair, 4, rng()):
        by = [variant.a.transform[4 * axis + 3] for axis in range(3)]
        assert any(by)
        for body, file in ((variant.a, pair.a), (variant.b, pair.b)):
            pairs = zip(
                body.world_mesh().vertices.tolist(), file.mesh.vertices.tolist(), strict=True
            )
            for there, here in pairs:
                for x, y, offset in zip(there, here, by, strict=True):
                    assert Fraction(x) == Fraction(y) + Fraction(offset)


def test_a_motion_keeps_distances_within_its_displacement(pair: Question) -> None:
    for variant in in_motion(pair, 4, rng()):
        assert (
            0
            < variant.displacement
            < 200 * U * max(np.abs(variant.a.world_mesh().vertices).max(), 10)
        )
        here = np.concatenate([pair.a.mesh.vertices, pair.b.mesh.vertices])
        there = np.concatenate([b.world_mesh().vertices for b in (variant.a, variant.b)])
        one, other = (
            np.linalg.norm(points[:, None] - points[None], axis=2) for points in (here, there)
        )
        rounding = 8 * U * one.max()  # of this test's own norms
        assert np.abs(one - other).max() <= variant.displacement + rounding


def test_stretch_bounds_the_singular_values() -> None:
    turn = ((1.0, 1e-9, 0.0), (0.0, 1.0 + 1e-7, 0.0), (0.0, 0.0, 1.0 - 1e-8))
    values = np.linalg.svd(np.array(turn), compute_uv=False)
    assert np.abs(values - 1).max() <= stretch(turn) <= 4e-7
    assert stretch(IDENTITY) == 0.0


def test_another_order_is_the_same_mesh_once_read(pair: Question) -> None:
    for variant in reordered(pair, 3, rng()):
        assert variant.identical
        assert variant.a.file.mesh.to_bytes() == pair.a.mesh.to_bytes()


def test_noise_is_one_ulp_at_most_and_leaves_zero(pair: Question) -> None:
    for variant in noisy(pair, 3, rng()):
        # Both meshes are sorted by coordinates, and a box's are far more than an ulp apart but for
        # equal ones, so that sorted columns correspond.
        before = np.sort(pair.b.mesh.vertices, axis=0)
        after = np.sort(variant.b.file.mesh.vertices, axis=0)
        assert (np.abs(after - before) <= np.spacing(np.abs(before))).all()
        assert (after != before).any()
        assert (variant.a.file.mesh.vertices == 0).sum() == (pair.a.mesh.vertices == 0).sum()


def volume(vertices: np.ndarray, triangles: np.ndarray) -> Fraction:
    """Six times it, exactly."""
    total = Fraction(0)
    for t in triangles.tolist():
        (a, b, c), (d, e, f), (g, h, i) = ([Fraction(x) for x in vertices[v].tolist()] for v in t)
        total += a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return total


@pytest.mark.parametrize("seed", range(6))
def test_retessellation_keeps_the_solid(seed: int, pair: Question) -> None:
    mesh = pair.a.mesh
    found = retessellate(mesh, 12, np.random.default_rng(seed))
    assert not found.rounded  # whole numbers have exact middles
    assert found.split + found.turned == 12
    topology = found.mesh.topology()
    assert topology.solid
    assert topology.manifold
    assert volume(found.mesh.vertices, found.mesh.triangles) == volume(
        mesh.vertices, mesh.triangles
    )
    assert found.mesh.triangle_count == mesh.triangle_count + 2 * found.split


def test_a_rounded_middle_is_declared(tmp_path: Path) -> None:
    """Of coordinates without a common last place no middle is a float64."""
    third = 1 / 3
    points = [
        (third, 1e-9 * third, 0.7),
        (1e5 * third, 0.1, 1e7 * third),
        (0.3, 1e9 * third, 1e-5 * third),
    ]
    sheet = (points, [(0, 1, 2)])
    odd = question(tmp_path, sheet, sheet)
    variants = list(retessellated(odd, 2, rng()))
    assert variants
    assert all(variant.displacement > 0 for variant in variants)
    assert all(variant.displacement < 1e-6 for variant in variants)
