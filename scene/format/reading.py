"""Any scene file -> SceneFile, by the schema that it names."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene.errors import SceneFileError
from satcheck.scene.format.entries import SCENE_1, SIMPLE, SceneFile
from satcheck.scene.format.text import Parsed, is_toml, parse
from satcheck.scene.format.values import shown


def read_scene_file(path: str, location: Path, *, allow_outside: bool = False) -> SceneFile:
    """Reads and checks a scene file. One with rules and without bodies is a file of rules.

    path: for messages; location: where it lies. allow_outside: a scene of the form satcheck.scene/1
    may name meshes outside of its folder. Raises SceneFileError.
    """
    parsed = parse(path, location)
    schema = _schema_of(parsed)
    if schema in (None, SCENE_1):
        from satcheck.scene.format import scene_1

        if scene_1.has_only_rules(parsed.document):
            return scene_1.read_rules(parsed)
    if schema == SCENE_1:
        return scene_1.read_scene(parsed, allow_outside=allow_outside)
    if schema == SIMPLE and not is_toml(location):
        from satcheck.scene.format import simple

        return simple.read_scene(parsed)
    raise _not_a_scene(path, schema)


def read_rules_file(path: str, location: Path) -> SceneFile:
    """Reads and checks a file of rules, which has the keys of satcheck.scene/1 but for those about
    bodies; `schema` may be left out. path, location: as above. Raises SceneFileError."""
    from satcheck.scene.format import scene_1

    parsed = parse(path, location)
    schema = _schema_of(parsed)
    if not isinstance(parsed.document, dict) or schema not in (None, SCENE_1):
        raise _not_a_scene(path, schema)
    return scene_1.read_rules(parsed)


def _schema_of(parsed: Parsed) -> object:
    document = parsed.document
    return document.get("schema") if isinstance(document, dict) else None


def _not_a_scene(path: str, schema: object) -> SceneFileError:
    told = "" if schema is None else f", but {shown(schema)}"
    message = f'not a scene file: "schema" is not "{SCENE_1}"{told}'
    return SceneFileError("bad-scene", message, file=path)
