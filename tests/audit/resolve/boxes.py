"""Scenes of axis-parallel boxes, and whether they overlap, by their coordinates alone."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from typing import Any

from satcheck.audit import Settings
from satcheck.audit.resolve import resolve as resolving
from satcheck.audit.resolve.conflicts import moved_scene
from satcheck.report.resolution import ResolutionReport
from satcheck.scene import Scene, load_scene
from tests.audit.shapes import box, write

Corner = tuple[float, float, float]


def boxes_scene(
    folder: Path,
    boxes: dict[str, tuple[Corner, Corner]],
    static: tuple[str, ...] = (),
    groups: dict[str, str] | None = None,
    **extra: object,
) -> Scene:
    """Each box as a mesh in its own place, without a placement."""
    write(folder, **{id_: box(*corners) for id_, corners in boxes.items()})
    bodies = [
        {"id": id_, "mesh": f"{id_}.obj", "static": id_ in static}
        | ({"group": groups[id_]} if groups and id_ in groups else {})
        for id_ in boxes
    ]
    path = folder / "boxes.json"
    path.write_text(json.dumps({"schema": "satcheck-scene-1", "bodies": bodies, **extra}))
    return load_scene([path])


def unit_at(x: float, y: float = 0.0, z: float = 0.0) -> tuple[Corner, Corner]:
    return (x, y, z), (x + 1, y + 1, z + 1)


def resolve(scene: Scene, settings: Settings | None = None, **how: Any) -> ResolutionReport:
    """Return what is resolved, without the check of the moved scene."""
    return resolving.resolve(scene, settings, **how)[0]


def moves(found: ResolutionReport) -> dict[str, Corner]:
    return {move.body: move.translation for move in found.moves}


def after(scene: Scene, found: ResolutionReport) -> Scene:
    return moved_scene(scene, moves(found))


def overlapping(scene: Scene) -> set[tuple[str, str]]:
    """Pairs with a common interior, if all bodies are axis-parallel boxes."""
    bounds = {body.id: body.world_mesh().bounds for body in scene.bodies}
    return {
        (a, b)
        for a, b in combinations(bounds, 2)
        if all(
            bounds[a][0][k] < bounds[b][1][k] and bounds[b][0][k] < bounds[a][1][k]
            for k in range(3)
        )
    }
