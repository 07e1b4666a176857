"""A scene of N bodies: a handful of sample meshes, turned, stretched and some mirrored, at random.

    python bench/scene_of.py N OUT.json [--seed 1]

The same seed gives the same scene. The density does not depend on N: the bodies lie in a cube whose
side grows with the cube root of N, so that about one body in four overlaps another one. Meshes
of 12 to 1,080 triangles, convex ones and others, take turns; each is stretched along its axes
to lengths between a half and one.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

SAMPLES = Path(__file__).resolve().parent.parent / "sample_meshes"
# File and the box it lies in: its centre, and its size along x, y, z.
MESHES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "box.obj": ((1.0, 1.0, 1.0), (2.0, 2.0, 2.0)),
    "kettle.obj": ((0.36, 0.0, 0.95), (2.83, 2.1, 1.89)),
    "ring.glb": ((0.0, 0.0, 0.0), (5.0, 5.0, 1.0)),
    "rod.stl": ((0.0, 0.0, 0.0), (0.96, 0.96, 6.0)),
    "snowflake.obj": ((0.8, 0.25, 1.2), (2.48, 2.44, 0.98)),
    "l_bracket.obj": ((3.0, 3.0, 2.0), (6.0, 6.0, 4.0)),
    "link_a.ply": ((0.0, 0.0, 0.0), (5.6, 2.6, 0.6)),
}
# The cube root of the room that a body of size 1 has.
SPACING = 1.6
MIRRORED = 0.2

Rows = list[list[float]]


def rotation(source: random.Random) -> Rows:
    """Uniform. Ken Shoemake, "Uniform Random Rotations" (1992)."""
    u, v, w = (source.random() for _ in range(3))
    s, c = math.sqrt(1 - u), math.sqrt(u)
    x, y = s * math.sin(math.tau * v), s * math.cos(math.tau * v)
    z, w = c * math.sin(math.tau * w), c * math.cos(math.tau * w)
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def placement(source: random.Random, mesh: str, room: float) -> Rows:
    """4x4 rows: the mesh about its centre, stretched, turned, moved to a place in the room."""
    centre, size = MESHES[mesh]
    stretch = [source.uniform(0.5, 1.0) / length for length in size]
    if source.random() < MIRRORED:
        stretch[0] = -stretch[0]
    turned = [[c * s for c, s in zip(row, stretch, strict=True)] for row in rotation(source)]
    at = [source.uniform(0.0, room) for _ in range(3)]
    rows = [
        [*row, place - sum(c * m for c, m in zip(row, centre, strict=True))]
        for row, place in zip(turned, at, strict=True)
    ]
    return [*rows, [0.0, 0.0, 0.0, 1.0]]


def scene_of(count: int, folder: Path, seed: int = 1) -> dict[str, Any]:
    """A scene of the form satcheck-scene-1, its mesh paths as seen from `folder`."""
    source = random.Random(seed)
    room = SPACING * count ** (1 / 3)
    meshes: Sequence[str] = tuple(MESHES)
    bodies = []
    for k in range(count):
        mesh = meshes[k % len(meshes)]
        path = Path(os.path.relpath(SAMPLES / mesh, folder.resolve())).as_posix()
        transform = placement(source, mesh, room)
        bodies.append({"id": f"body_{k:06}", "mesh": path, "transform": transform})
    head = {"schema": "satcheck-scene-1", "name": f"{count} bodies, seed {seed}"}
    return head | {"units": "m", "bodies": bodies}


def write_scene(count: int, out: Path, seed: int = 1) -> None:
    out.write_text(json.dumps(scene_of(count, out.parent, seed)), encoding="utf-8")


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, metavar="N")
    parser.add_argument("out", type=Path, metavar="OUT.json")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    write_scene(options.count, options.out, options.seed)


if __name__ == "__main__":
    main()
