"""Small meshes with known answers, as text files and as loaded scenes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from satcheck.scene import Scene, load_scene

Point = tuple[float, float, float]
Mesh = tuple[list[Point], list[tuple[int, ...]]]

BOX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def box(low: Point, high: Point) -> Mesh:
    points = [
        (x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])
    ]
    return points, list(BOX_FACES)


def unit_box(x: float = 0.0, y: float = 0.0, z: float = 0.0, edge: float = 1.0) -> Mesh:
    return box((x, y, z), (x + edge, y + edge, z + edge))


def bracket() -> Mesh:
    """A concave L, 4 high: arms 2 thick and 6 long along x and y; the notch is x > 2, y > 2."""
    outline = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)]
    points = [(float(x), float(y), z) for z in (0.0, 4.0) for x, y in outline]
    count = len(outline)
    walls = [(k, (k + 1) % count, (k + 1) % count + count, k + count) for k in range(count)]
    # The ends as two quads each: a fan over the concave outline would stick out of it.
    ends = [(3, 2, 1, 0), (5, 4, 3, 0), (6, 7, 8, 9), (6, 9, 10, 11)]
    return points, [*walls, *ends]


def open_box(edge: float = 4.0) -> Mesh:
    """A box without its lid."""
    points, faces = unit_box(edge=edge)
    return points, [face for face in faces if face != BOX_FACES[1]]


def moved(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    points, faces = mesh
    return [(p[0] + x, p[1] + y, p[2] + z) for p in points], faces


def write(folder: Path, **meshes: Mesh) -> list[Path]:
    paths = []
    for name, (points, faces) in meshes.items():
        lines = ["v " + " ".join(repr(float(c)) for c in point) for point in points]
        lines += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
        paths.append(folder / f"{name}.obj")
        paths[-1].write_text("\n".join(lines) + "\n", encoding="utf-8")
    return paths


def scene_of(folder: Path, **meshes: Mesh) -> Scene:
    return load_scene(write(folder, **meshes))


def placed_scene(folder: Path, bodies: Iterable[Sequence[Any]], **extra: object) -> Scene:
    """bodies: (id, mesh file name, 4x4 rows[, group])."""
    content = {
        "schema": "satcheck-scene-1",
        "name": "test",
        "bodies": [
            {"id": body[0], "mesh": body[1], "transform": body[2]}
            | ({"group": body[3]} if len(body) > 3 else {})
            for body in bodies
        ],
        **extra,
    }
    path = folder / "test.scene.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    return load_scene([path])


def pose(x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0) -> list[list[float]]:
    """Turned about z by `turn` degrees, then moved."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    return [[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
