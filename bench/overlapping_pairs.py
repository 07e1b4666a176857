"""Random overlapping pairs of the closed meshes in a folder, for bench/depth_interval.py.

    python bench/overlapping_pairs.py MESHES PAIRS.json [--count 100] [--seed 1] [--largest 60000]

Each body gets a random rotation (one in five keeps its axes) and about the size 1, one body in
three pairs a size three times larger or smaller. Poses: a vertex of one on a vertex of the other,
the middles of both nearly in one place, or a corner a little inside the other. Not all overlap.
"""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

from satcheck.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene

SUFFIXES = frozenset((".obj", ".stl", ".ply", ".off", ".glb", ".3mf"))
SIZES = (1.0, 1.0, 1.0, 1.0, 1.0 / 3, 3.0)
Array = npt.NDArray[np.float64]


def closed_meshes(folder: Path, largest: int) -> list[tuple[Path, Mesh]]:
    """Files of one closed body each, of at most so many triangles, in the order of their names."""
    found = []
    for path in sorted(p for p in folder.rglob("*") if p.suffix.lower() in SUFFIXES):
        try:
            bodies = load_scene([path]).bodies
        except SatcheckError:
            continue
        if len(bodies) != 1 or not bodies[0].file.health.solid:
            continue
        if len(bodies[0].file.mesh.triangles) <= largest:
            found.append((path, bodies[0].file.mesh))
    return found


def rotation(rng: np.random.Generator) -> Array:
    matrix = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    matrix[:, 0] *= np.linalg.det(matrix)
    return np.asarray(matrix)


def placed(mesh: Mesh, size: float, rng: np.random.Generator) -> tuple[Array, Array]:
    """A linear map, and the vertices after it."""
    points = np.asarray(mesh.vertices)
    extent = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    turn = np.eye(3) if rng.random() < 0.2 else rotation(rng)
    linear = turn * (size * rng.uniform(0.7, 1.4) / extent)
    return linear, points @ linear.T


def shift(a: Array, b: Array, rng: np.random.Generator) -> Array:
    """A translation of a."""
    way = rng.integers(3)
    if way == 0:
        return np.asarray(b[rng.integers(len(b))] - a[rng.integers(len(a))])
    if way == 1:
        middles = 0.5 * (b.max(axis=0) + b.min(axis=0) - a.max(axis=0) - a.min(axis=0))
        return np.asarray(middles + rng.normal(size=3) * 0.05 * np.ptp(b, axis=0))
    up = rng.normal(size=3)
    up /= math.hypot(*up)
    return np.asarray(b[(b @ up).argmin()] - a[(a @ up).argmax()] + up * rng.uniform(0.005, 0.1))


def matrix(linear: Array, translation: Array) -> list[list[float]]:
    rows = np.eye(4)
    rows[:3, :3], rows[:3, 3] = linear, translation
    return [[float(c) for c in row] for row in rows]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("meshes", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--largest", type=int, default=60000)
    given = parser.parse_args()
    rng = np.random.default_rng(given.seed)
    pool = closed_meshes(given.meshes.resolve(), given.largest)
    pairs = []
    for number in range(given.count):
        (path_a, mesh_a), (path_b, mesh_b) = (pool[k] for k in rng.integers(0, len(pool), 2))
        linear_a, a = placed(mesh_a, 1.0, rng)
        linear_b, b = placed(mesh_b, SIZES[rng.integers(len(SIZES))], rng)
        pairs.append(
            {
                "id": f"s{given.seed}_{number:03d}_{path_a.stem}__{path_b.stem}",
                "a": {"mesh": str(path_a), "transform": matrix(linear_a, shift(a, b, rng))},
                "b": {"mesh": str(path_b), "transform": matrix(linear_b, np.zeros(3))},
            }
        )
    given.out.write_text(json.dumps({"pairs": pairs}), encoding="utf-8")


if __name__ == "__main__":
    main()
