"""What one stage has proved of a depth, no later one takes back."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck import core
from satcheck.audit import Settings, check
from tests.audit.shapes import Mesh, scene_of

SHIFT = np.array((0.6, 0.5, 0.3))


def crumpled_ring(rng: np.random.Generator, turns: int, sides: int) -> np.ndarray:
    """The vertices of a torus of radius 1, each moved a little."""
    u = np.repeat(np.arange(turns), sides) * (2 * math.pi / turns)
    v = np.tile(np.arange(sides), turns) * (2 * math.pi / sides)
    tube = 0.35 * rng.uniform(0.8, 1.2, turns * sides)
    r = 1 + tube * np.cos(v)
    turned = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turned[:, 0] *= np.linalg.det(turned)
    return np.stack([r * np.cos(u), r * np.sin(u), tube * np.sin(v)], axis=1) @ turned.T


def faces_of_ring(turns: int, sides: int) -> list[tuple[int, int, int]]:
    faces = []
    for i in range(turns):
        for j in range(sides):
            k, m = (i + 1) % turns, (j + 1) % sides
            here, along, beyond = i * sides + j, k * sides + j, k * sides + m
            faces += [(here, along, beyond), (here, beyond, i * sides + m)]
    return faces


def mesh(points: np.ndarray, faces: list[tuple[int, int, int]]) -> Mesh:
    return [tuple(map(float, p)) for p in points], faces


def hull_depth(points: np.ndarray, others: np.ndarray) -> tuple[float, float]:
    hulls = [core.Hull(np.ascontiguousarray(p)) for p in (points, others)]
    found = core.check_pair(*hulls, query="depth")
    return (0.0, 0.0) if found.lower is None else (-found.upper, -found.lower)


@pytest.mark.parametrize("budget", [1e-6, 0.02, 2.0])
@pytest.mark.parametrize("offset", [0.0, 1e6, 1e9])
@pytest.mark.parametrize("size", [3e-6, 1e-2, 10.0])
def test_the_bounds_are_the_best_of_all_stages(tmp_path, budget, offset, size):
    for seed in range(4):
        rng = np.random.default_rng(seed)
        a = crumpled_ring(rng, 12, 5) * size + offset
        b = (crumpled_ring(rng, 5, 4) + SHIFT) * size + offset
        scene = scene_of(tmp_path, a=mesh(a, faces_of_ring(12, 5)), b=mesh(b, faces_of_ring(5, 4)))
        (finding,) = check(scene, Settings(depth=True, budget=budget)).findings
        if finding.depth_bounds is None:
            continue
        low, high = finding.depth_bounds
        assert high <= hull_depth(a, b)[1]
        assert finding.mtv_verified
        for stage in finding.plan:
            if stage.stage == "search" and "from" in stage.detail:
                lower, upper = (float(x) for x in stage.detail.split(" by ")[0].split()[1::2])
                assert low >= lower * (1 - 1e-5)
                assert high <= upper * (1 + 1e-5)
