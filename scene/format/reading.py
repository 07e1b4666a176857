"""Any scene file -> SceneFile, by the schema that it names."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene.errors import SceneFileError
from satcheck.scene.format.entries import SCENE_1, SIMPLE, SceneFile
from satcheck.scene.format.text import is_toml, parse
from satcheck.scene.format.values import shown


def read_scene_file(path: str, location: Path, *, allow_outside: bool = False) -> SceneFile:
    """Reads and checks a scene file.

    path: for messages; location: where it lies. allow_outside: a scene of the form satcheck.scene/1
    may name meshes outside of its folder. Raises SceneFileError.
    """
    parsed = parse(path, location)
    document = parsed.document
    schema = document.get("schema") if isinstance(document, dict) else None
    if schema == SCENE_1:
        from satcheck.scene.format import scene_1

        return scene_1.read_scene(parsed, allow_outside=allow_outside)
    if schema == SIMPLE and not is_toml(location):
        from satcheck.scene.format import simple

        return simple.read_scene(parsed)
    told = "" if schema is None else f", but {shown(schema)}"
    message = f'not a scene file: "schema" is not "{SCENE_1}"{told}'
    raise SceneFileError("bad-scene", message, file=path)
