"""Scene files of bodies that were moved: what was read, with other placements."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from satcheck.scene.bodies import Body, Transform
from satcheck.scene.scene_file import SCHEMA


def moved_scene_file(source: Path, output: Path, placements: Mapping[str, Transform]) -> str:
    """The text of the satcheck-scene-1 file `source`, which has been read before, for the place
    `output`: these bodies, by id, get these placements, and mesh paths lead from there on. All else
    stays as it is, the order of keys included."""
    document = json.loads(source.read_text("utf-8-sig"))
    for entry in document["bodies"]:
        entry["mesh"] = _path_from(output, source.parent / entry["mesh"], entry["mesh"])
        if entry["id"] in placements:
            entry["transform"] = _rows(placements[entry["id"]])
    return _text(document)


def scene_file_of(
    output: Path, bodies: Mapping[str, Body], placements: Mapping[str, Transform]
) -> str:
    """The text of a satcheck-scene-1 file, for the place `output`, of such mesh files."""
    return _text(
        {
            "schema": SCHEMA,
            "name": output.stem,
            "bodies": [
                {
                    "id": id_,
                    "mesh": _path_from(output, Path(body.file.path), body.file.path),
                    **({"transform": _rows(placements[id_])} if id_ in placements else {}),
                }
                for id_, body in bodies.items()
            ],
        }
    )


def _path_from(output: Path, target: Path, written: str) -> str:
    """The path of `target` from the folder of `output` on; as written where that is right."""
    if Path(written).is_absolute():
        return written
    folder = output.absolute().parent
    if (folder / written).absolute() == target.absolute():
        return written
    return Path(os.path.relpath(target.absolute(), folder)).as_posix()


def _rows(transform: Transform) -> list[list[float]]:
    return [list(transform[4 * row : 4 * row + 4]) for row in range(4)]


def _text(document: Mapping[str, Any]) -> str:
    """A line for each key, and one for each entry of a list: a body is read as a whole."""
    lines = [f"{json.dumps(key)}: {_value(value)}" for key, value in document.items()]
    return "{\n  " + ",\n  ".join(lines) + "\n}\n"


def _value(value: Any) -> str:
    if not isinstance(value, list) or not any(isinstance(entry, dict | list) for entry in value):
        return json.dumps(value, ensure_ascii=False)
    entries = [json.dumps(entry, ensure_ascii=False) for entry in value]
    return "[\n    " + ",\n    ".join(entries) + "\n  ]"
