"""SAT against portals (overlap), GJK and EPA by vertex count: where the dispatch should change.

    python bench/crossover.py [--pairs 2000] [--rounds 5] [--seed 1]

Random hulls of 4 to 64 vertices on ellipsoids, a third of the pairs apart by 0.01 to 0.5, a third
overlapping by 0.0001 to 0.03, a third deep (lengths relative to a size of 2). CPU nanoseconds per
query on one thread, the fastest of the rounds; the two methods alternate. Below the figure where
"depth" changes sides SAT is faster. What came of it stands in core/native/convex/narrow_phase.hpp.
"""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from satcheck import core

COUNTS = (4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 32, 48, 64)
SHAPES = 40
Query = Literal["overlap", "depth", "distance"]
Method = Literal["sat", "gjk"]
QUERIES: tuple[Query, ...] = ("overlap", "depth", "distance")
METHODS: tuple[Method, ...] = ("sat", "gjk")


def hulls(rng: np.random.Generator, count: int) -> list[Any]:
    """SHAPES hulls whose `count` points all are extreme."""
    points = rng.normal(size=(SHAPES, count, 3))
    points /= np.linalg.norm(points, axis=2, keepdims=True)
    points *= rng.uniform(0.4, 1.0, (SHAPES, 1, 3))
    return [core.Hull(np.ascontiguousarray(p)) for p in points]


def random_poses(rng: np.random.Generator, pairs: int) -> NDArray[np.float64]:
    quaternion = rng.normal(size=(pairs, 4))
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    return np.concatenate([rng.normal(size=(pairs, 3)), quaternion], axis=1)


def placed(rng: np.random.Generator, shapes: list[Any], pairs: int) -> tuple[Any, ...]:
    """Inputs of check_pairs: each B is moved along its normal to the wanted signed distance."""
    a, b = rng.integers(len(shapes), size=(2, pairs)).astype(np.uint32)
    pose_a, pose_b = random_poses(rng, pairs), random_poses(rng, pairs)
    now = core.check_pairs(shapes, a, b, pose_a, pose_b, query="depth")
    gap = np.exp(rng.uniform(np.log(1e-2), np.log(0.5), pairs))
    shallow = -np.exp(rng.uniform(np.log(1e-4), np.log(3e-2), pairs))
    deep = -rng.uniform(0.1, 0.5, pairs)
    wanted = np.choose(np.arange(pairs) % 3, [gap, shallow, deep])
    pose_b[:, :3] += (wanted - now.distance)[:, None] * now.normal
    return shapes, a, b, pose_a, pose_b


def nanoseconds(inputs: tuple[Any, ...], query: Query, method: Method) -> float:
    start = time.process_time_ns()
    core.check_pairs(*inputs, query=query, method=method, threads=1)
    return (time.process_time_ns() - start) / len(inputs[1])


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    sys.stdout.write(
        "vertices  " + "  ".join(f"{q:>8s} sat  gjk+epa" for q in QUERIES) + "   (ns)\n"
    )
    for count in COUNTS:
        inputs = placed(rng, hulls(rng, count), options.pairs)
        cells = []
        for query in QUERIES:
            best = dict.fromkeys(METHODS, float("inf"))
            for _ in range(options.rounds):
                for method in METHODS:
                    best[method] = min(best[method], nanoseconds(inputs, query, method))
            cells.append(f"{best['sat']:12.0f} {best['gjk']:8.0f}")
        sys.stdout.write(f"{count:8d}  " + "  ".join(cells) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
