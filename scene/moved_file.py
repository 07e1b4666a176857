"""Scene files of bodies that were moved: what was read, with other placements."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.format import scene_1, simple
from satcheck.scene.format.reading import read_scene_file
from satcheck.scene.format.text import parsed, read_text
from satcheck.scene.format.writing import moved

Translation = tuple[float, float, float]


def moved_scene_file(source: str, output: Path, translations: Mapping[str, Translation]) -> str:
    """The text of the scene file `source`, of either form, with these bodies, by id, moved in the
    world, for the place `output`: mesh paths lead from there on. All else stays as it is written.

    Raises SceneFileError for a source that is wrong.
    """
    entries = read_scene_file(source, Path(source), allow_outside=True).bodies
    placements = {
        entry.id: _translated(entry.transform or IDENTITY, translations[entry.id])
        for entry in entries
        if entry.id in translations
    }
    text = moved(source, read_text(source, Path(source)), placements)
    return _with_paths_from(output, source, text)


def scene_file_of(output: Path, scene: Scene, translations: Mapping[str, Translation]) -> str:
    """The text of a new scene file, for the place `output`, of a scene of mesh files or of parts of
    them, as the files place them, and then moved."""
    bodies = scene.bodies
    in_parts = any(body.path is not None for body in bodies)
    entries = []
    for body in bodies:
        entry: dict[str, Any] = {"id": body.id, "mesh": _path_from(output, Path(body.file.path))}
        if body.path is not None:
            entry["part"] = body.path
        if body.id in translations:
            x, y, z = translations[body.id]
            rows = [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]
            entry |= {"position": [x, y, z]} if in_parts else {"transform": rows}
        entries.append(f"\n    {json.dumps(entry, ensure_ascii=False)}")
    schema = scene_1.SCHEMA if in_parts else simple.SCHEMA
    units = f'\n  "units": {json.dumps(scene.units)},' if scene.units else ""
    return f'{{\n  "schema": "{schema}",{units}\n  "bodies": [{",".join(entries)}\n  ]\n}}\n'


def _translated(placement: tuple[float, ...], by: Translation) -> tuple[float, ...]:
    values = list(placement)
    for row in range(3):
        values[4 * row + 3] += by[row]
    return tuple(values)


def _with_paths_from(output: Path, source: str, text: str) -> str:
    folder = Path(source).parent
    if folder.absolute() == output.parent.absolute():
        return text
    scene = parsed(source, Path(source), text)
    pieces, done = [], 0
    for index, entry in enumerate(scene.document["bodies"]):
        if "mesh" in entry:
            place = scene.positions.place(("bodies", index, "mesh"))
            path = json.dumps(_path_from(output, folder / entry["mesh"]), ensure_ascii=False)
            pieces += [text[done : place.start], path]
            done = place.end
    return "".join([*pieces, text[done:]])


def _path_from(output: Path, target: Path) -> str:
    """The path of `target` from the folder of `output` on; an absolute one stays so."""
    if target.is_absolute():
        return target.as_posix()
    return Path(os.path.relpath(target.absolute(), output.absolute().parent)).as_posix()
