"""Grown parts contain the surface of their mesh: judged in rational numbers by the oracle."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
import pytest

from satcheck.core import Mesh, Polytope
from satcheck.decompose import errors
from satcheck.decompose.enclosing import enclosing_parts
from satcheck.decompose.errors import NEVER, DecompositionError
from satcheck.decompose.fitting import hull_of, merged_parts, volume
from satcheck.scene import load_scene
from tests.cli.process import SAMPLES
from tests.oracles.covered import exact, is_in_a_part, planes_of, uncovered_triangles

BRACKET = load_scene([SAMPLES / "l_bracket.obj"], split="none").bodies[0].world_mesh()


def halves(mesh: Mesh, lacking: float = 0.0) -> list[Polytope]:
    """Two boxes that hold the bracket, but for a layer of this thickness around each."""
    points = np.asarray(mesh.vertices)
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / 2.0
    boxes = []
    for start, end in ((low, np.array([middle[0], *high[1:]])), ([middle[0], *low[1:]], high)):
        a, b = np.array(start) + lacking, np.array(end) - lacking
        boxes.append(
            hull_of(
                np.array(
                    [[x, y, z] for x in (a[0], b[0]) for y in (a[1], b[1]) for z in (a[2], b[2])]
                )
            )
        )
    return boxes


def triangles_of(mesh: Mesh) -> list[list[list[float]]]:
    found: list[list[list[float]]] = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)].tolist()
    return found


def turned(mesh: Mesh, scale: float = 1.0, shift: float = 0.0) -> Mesh:
    """By angles whose cosines are no short numbers."""
    c, s = np.cos(0.7), np.sin(0.7)
    rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array(
        [[1, 0, 0], [0, c, -s], [0, s, c]]
    )
    return Mesh(np.asarray(mesh.vertices) @ rotation.T * scale + shift, mesh.triangles)


@pytest.mark.parametrize("lacking", [0.0, 1e-9, 0.01])
@pytest.mark.parametrize("vertices", [None, 8, 6])
@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1.0, 1e6)])
def test_grown_parts_contain_the_mesh(
    lacking: float, vertices: int | None, scale: float, shift: float
) -> None:
    mesh = turned(BRACKET, scale, shift)
    parts = halves(mesh, lacking * scale)
    grown = enclosing_parts(mesh, parts, vertices, NEVER)
    assert uncovered_triangles(triangles_of(mesh), [part.vertices for part in grown]) == []
    assert all(part.vertex_count <= (vertices or 8) for part in grown)
    for part in grown:
        points = np.asarray(part.vertices)
        assert (points == points.astype(np.float32)).all()
    if lacking == 0.01:  # the oracle sees what is missing
        assert uncovered_triangles(triangles_of(mesh), [part.vertices for part in parts])


def test_random_points_of_the_triangles_lie_in_a_part() -> None:
    mesh, random = turned(BRACKET), Random(3)
    grown = enclosing_parts(mesh, halves(mesh, 0.01), None, NEVER)
    planes = [planes_of(part.vertices) for part in grown]
    for triangle in triangles_of(mesh):
        a, b, c = map(exact, triangle)
        for _ in range(20):
            s, t = sorted(Fraction(random.randrange(1 << 20), 1 << 20) for _ in range(2))
            x, y, z = (p * s + q * (t - s) + r * (1 - t) for p, q, r in zip(a, b, c, strict=True))
            assert is_in_a_part((x, y, z), planes)


def test_what_contains_the_mesh_already_stays() -> None:
    box = hull_of(np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)]))
    (part,) = enclosing_parts(box.to_mesh(), [box], 8, NEVER)
    assert np.array_equal(np.sort(part.vertices, axis=0), np.sort(box.vertices, axis=0))


def test_numbers_that_are_too_coarse_fail() -> None:
    mesh = turned(BRACKET, 1e-6, 1e3)  # a step of 32-bit numbers is 6e-5 there
    with pytest.raises(DecompositionError, match="32-bit numbers") as caught:
        enclosing_parts(mesh, halves(mesh), None, NEVER)
    assert caught.value.code in (errors.NOT_ENCLOSED, errors.FLAT)


def test_a_thin_disc_grows_little() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 257)[:-1]
    rim = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([np.insert(rim, 2, z, axis=1) for z in (0.0, 1e-4)])
    disc = hull_of(points)
    (part,) = enclosing_parts(disc.to_mesh(), [disc], None, NEVER)
    assert part.vertex_count <= disc.vertex_count
    assert volume(disc) < volume(part) < 1.03 * volume(disc)  # 2^-22 / 1e-4 above and below: 0.5 %
    (box,) = enclosing_parts(disc.to_mesh(), [disc], 8, NEVER)
    assert volume(box) <= 4.1e-4  # the square around it has 4e-4


def test_parts_merge_where_the_hull_adds_least() -> None:
    cubes = [
        hull_of(
            np.array([[x + d, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
        )
        for d in (0.0, 1.0, 5.0)
    ]
    merged = merged_parts(cubes, 2, NEVER)
    assert [volume(part) for part in merged] == [2.0, 1.0]
    assert merged_parts(cubes, 3, NEVER) == tuple(cubes)
    (one,) = merged_parts(cubes, 1, NEVER)
    assert volume(one) == 6.0
