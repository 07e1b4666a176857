"""Writes scene files of moved bodies."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.format.entries import SIMPLE
from satcheck.scene.format.reading import read_scene_file
from satcheck.scene.format.text import parsed, read_text
from satcheck.scene.format.writing import moved
from satcheck.scene.new_scene_file import path_from
from satcheck.scene.path_kind import followed

Translation = tuple[float, float, float]


def moved_scene_file(source: str, output: Path, translations: Mapping[str, Translation]) -> str:
    """The text of the scene file `source`, of either form, with these bodies moved.

    translations: id -> translation in the world. output: the file that the text is for; mesh paths
    are relative to its folder. The rest is unchanged. Raises SceneFileError if the source is
    invalid.
    """
    entries = read_scene_file(source, Path(source), allow_outside=True).bodies
    placements = {
        entry.id: _translated(entry.transform or IDENTITY, translations[entry.id])
        for entry in entries
        if entry.id in translations
    }
    text = moved(source, read_text(source, Path(source)), placements)
    return _with_paths_from(output, source, text)


def stray_mesh(source: str | None, output: Path, scene: Scene) -> str | None:
    """A mesh file outside of the folder of `output`, if reading the new scene would then need
    `--allow-outside`; None: there is none. source: the scene file that was read, if any."""
    if source is not None and _is_simple(source):
        return None
    folder = followed(output.absolute().parent)
    meshes = (body.file.path for body in scene.bodies if body.shape is None)
    return next((mesh for mesh in meshes if not followed(Path(mesh)).is_relative_to(folder)), None)


def _is_simple(source: str) -> bool:
    """Whether the scene has the simple form, which may name meshes in any folder."""
    document = parsed(source, Path(source), read_text(source, Path(source))).document
    return bool(document["schema"] == SIMPLE)


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
            path = json.dumps(path_from(output, folder / entry["mesh"]), ensure_ascii=False)
            pieces += [text[done : place.start], path]
            done = place.end
    return "".join([*pieces, text[done:]])
