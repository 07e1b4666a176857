"""Scenes as documents and as files."""

from __future__ import annotations

import copy
import json
from contextlib import chdir
from pathlib import Path
from typing import Any

from satcheck.core.errors import SatcheckError
from satcheck.scene.errors import Refused
from satcheck.scene.scene_file.joined import SceneFile
from satcheck.scene.scene_file.reading import read_scene_file
from tests.scene import files

BOX = {"type": "box", "size": [1, 1, 1]}
# One of everything.
FULL: dict[str, Any] = {
    "schema": "satcheck.scene/1",
    "name": "cell",
    "description": "a test",
    "units": "mm",
    "reading": {"geometry": "collision"},
    "check_static": True,
    "ignore_within_groups": ["arm"],
    "bodies": [
        {"id": "floor", "shape": BOX, "position": [0, 0, -0.5], "static": True},
        {"id": "arm/1", "mesh": "cube.obj", "groups": ["arm", "robot"], "euler": [0, 0, 90]},
        {"id": "arm/2", "mesh": "cube.obj", "quaternion": [1, 0, 0, 0], "scale": 2, "pinned": True},
        {"id": "tool", "shape": {"type": "capsule", "radius": 1, "length": 2}, "scale": [1, 2, -1]},
        {
            "id": "bin",
            "mesh": "cube.obj",
            "matrix": [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        },
    ],
    "rules": [
        {"a": "floor", "b": "arm/*", "allowed": True, "reason": "bolted"},
        {"a": "group:robot", "b": "*", "max_depth": 0.5, "clearance": "2mm", "severity": "note"},
        {"a": "*", "b": "*", "tolerance": 0, "max_volume": 3.5},
    ],
    "motion": [
        {"bodies": "arm/1", "translation": [0, 0, 1]},
        {"bodies": ["arm/2"], "rotation": {"axis": [0, 0, 1], "point": [1, 0, 0], "degrees": -30}},
        {
            "bodies": ["tool", "bin"],
            "path": [
                {"time": 0, "position": [0, 0, 0]},
                {"time": 0.5, "position": [0, 0, 1], "euler": [90, 0, 0]},
                {"time": 1, "position": [1, 0, 1], "quaternion": [0, 1, 0, 0]},
            ],
        },
    ],
}


def full() -> dict[str, Any]:
    """A copy to change."""
    return copy.deepcopy(FULL)


def scene_of(*bodies: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"schema": "satcheck.scene/1", "bodies": list(bodies), **more}


def toml(value: Any) -> str:
    """A value, or a document, as TOML: tables at the top under headers, the others inline."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def toml_document(document: dict[str, Any]) -> str:
    lines = [f"{key} = {toml(value)}" for key, value in document.items() if not _headed(value)]
    for key, value in document.items():
        for table in value if _headed(value) else ():
            lines += ["", f"[[{key}]]", *(f"{inner} = {toml(v)}" for inner, v in table.items())]
    return "\n".join(lines) + "\n"


def _headed(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def write(folder: Path, document: Any, form: str = "json", name: str = "cell") -> Path:
    """A scene file beside a mesh file cube.obj."""
    (folder / "cube.obj").write_bytes(files.obj())
    path = folder / f"{name}.{form}"
    text = document if isinstance(document, str) else None
    if text is None:
        text = toml_document(document) if form == "toml" else json.dumps(document, indent=1)
    path.write_text(text, encoding="utf-8", newline="")
    return path


def read(folder: Path, document: Any, form: str = "json", **options: Any) -> SceneFile:
    path = write(folder, document, form)
    with chdir(folder):
        return read_scene_file(path.name, **options)


def errors(folder: Path, document: Any, form: str = "json") -> list[SatcheckError]:
    """What a scene is refused for; none where it is read."""
    try:
        read(folder, document, form)
    except Refused as error:
        return [error, *error.others]
    return []
