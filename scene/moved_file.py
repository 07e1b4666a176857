"""Writes scene files of moved bodies."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.format.entries import SCENE_1, SIMPLE
from satcheck.scene.format.reading import read_scene_file
from satcheck.scene.format.text import is_toml, parsed, read_text
from satcheck.scene.format.writing import moved
from satcheck.scene.path_kind import followed
from satcheck.scene.units import unit_in

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


def scene_file_of(output: Path, scene: Scene, translations: Mapping[str, Translation]) -> str:
    """The text of a new scene file satcheck.scene/1 for the file `output`, TOML or JSON by its
    suffix. The scene consists of mesh files or parts of them, placed by the files and then moved by
    `translations`."""
    entries = []
    for body in scene.bodies:
        entry: dict[str, Any] = {"id": body.id, "mesh": _path_from(output, Path(body.file.path))}
        if body.path is not None:
            entry["part"] = body.path
        if body.file.units is None and body.unit_scale is not None and body.units is not None:
            entry["units"] = unit_in(body.units, body.unit_scale)
        if body.id in translations:
            entry["position"] = list(translations[body.id])
        entries.append(entry)
    head = {"schema": SCENE_1} | ({"units": scene.units} if scene.units else {})
    return (_toml if is_toml(output) else _json)(head, entries)


def _json(head: Mapping[str, str], bodies: Sequence[Mapping[str, Any]]) -> str:
    lines = [f"  {_quoted(key)}: {_quoted(value)},\n" for key, value in head.items()]
    rows = ",".join(f"\n    {_quoted(body)}" for body in bodies)
    return f'{{\n{"".join(lines)}  "bodies": [{rows}\n  ]\n}}\n'


def _toml(head: Mapping[str, str], bodies: Sequence[Mapping[str, Any]]) -> str:
    tables = [_toml_lines(head), *("[[bodies]]\n" + _toml_lines(body) for body in bodies)]
    return "\n".join(tables)


def _toml_lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{key} = {_quoted(value)}\n" for key, value in table.items())


def _quoted(value: object) -> str:
    """A string that is valid in JSON and TOML. TOML allows no raw DEL in a string."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


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
            path = json.dumps(_path_from(output, folder / entry["mesh"]), ensure_ascii=False)
            pieces += [text[done : place.start], path]
            done = place.end
    return "".join([*pieces, text[done:]])


def _path_from(output: Path, target: Path) -> str:
    """The path of `target` relative to the folder of `output`; absolute paths stay absolute."""
    if target.is_absolute():
        return target.as_posix()
    return Path(os.path.relpath(target.absolute(), output.absolute().parent)).as_posix()
