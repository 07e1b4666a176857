"""Writes any scene as a new scene file satcheck.scene/1. It names the mesh files of its bodies."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from msgspec import to_builtins

from satcheck.core.shapes import HalfSpace
from satcheck.core.transform import Transform
from satcheck.scene.access import followed
from satcheck.scene.bodies import IDENTITY, Body, Scene, Unreadable
from satcheck.scene.document import FilePart
from satcheck.scene.files.readers import mesh_reader, options_of
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.motion import Motion, PosePath, Rotation, Waypoint
from satcheck.scene.opening import is_file
from satcheck.scene.rules import PLACE, Rule, Selector
from satcheck.scene.scene_file import document
from satcheck.scene.scene_file.document import SCENE_1
from satcheck.scene.scene_file.text import is_toml
from satcheck.scene.statics import BodyRule, stated_terms
from satcheck.scene.units import ratio, scaled_mesh, scaled_world, stated_unit, unit_in

Vector = tuple[float, float, float]
_ORIGIN = (0.0, 0.0, 0.0)
_LISTS = ("bodies", "rules", "motion")  # whose tables have lines, or headers, of their own


def new_scene_file(
    output: Path,
    scene: Scene,
    files: MeshFiles,
    translations: Mapping[str, Vector] = MappingProxyType({}),
) -> str:
    """The text of a scene file for the path `output`, TOML or JSON by its suffix. It states what
    the scene states: bodies, groups, rules and motions; robots as they stand.

    files: read the mesh files whose parts are bodies again, to see where they place them.
    translations: id -> translation in the world, after the placement. An unreadable body is an
    entry if its file may become readable, else it is left out (`left_out_of`).
    """
    unplaced = _without_placements(scene, files)
    entries = []
    for body in scene.in_order():
        if isinstance(body, Body):
            by = translations.get(body.id, _ORIGIN)
            entries.append(_entry(output, body, unplaced[body.id], by))
        elif _has_file(body):
            entries.append(
                document.Body(
                    id=body.id,
                    mesh=path_from(output, Path(body.file)),
                    part=body.path,
                    groups=body.groups,
                    static=body.static,
                )
            )
    counting = options_of({body.file.format for body in scene.bodies})
    reading = {name: value for name, value in scene.reading.items() if name in counting}
    stated = document.Scene(
        schema=SCENE_1,
        units=scene.units or None,
        reading=dict(sorted(reading.items())) or None,
        check_static=scene.check_static and any(body.static for body in scene.in_order()),
        ignore_within_groups=tuple(sorted(scene.ignore_within_groups)),
        accept=tuple(each.text for each in scene.accept if each.about is None),
        statics=stated_terms(scene) if scene.body_rules or scene.statics else None,
        bodies=tuple(entries),
        rules=(
            *map(_rule, scene.rules),
            *map(_rule, scene.body_rules),
            *map(_rule, _open_bodies(scene)),
        ),
        motion=tuple(map(_motion, scene.motions)),
    )
    return (_toml if is_toml(output) else _json)(to_builtins(stated, enc_hook=_plain))


def _open_bodies(scene: Scene) -> list[BodyRule]:
    opened = (body for body in scene.bodies if body.open)
    return [BodyRule(bodies=Selector.exactly(body.id), open=True) for body in opened]


def left_out_of(scene: Scene) -> list[str]:
    """The ids of the unreadable bodies that a new scene file cannot state."""
    return [body.id for body in scene.unreadable if not _has_file(body)]


def stray_mesh(output: Path, scene: Scene) -> str | None:
    """A mesh file outside of the folder of `output`, if reading the new scene would then need
    `--allow-outside`; None: there is none."""
    folder = followed(output.absolute().parent)
    meshes = (body.file.path for body in scene.bodies if body.shape is None)
    return next((mesh for mesh in meshes if not followed(Path(mesh)).is_relative_to(folder)), None)


def path_from(output: Path, target: Path) -> str:
    """The path of `target` relative to the folder of `output`; absolute paths elsewhere stay
    absolute."""
    folder = output.absolute().parent
    if target.is_absolute() and not target.is_relative_to(folder):
        return target.as_posix()
    return Path(os.path.relpath(target.absolute(), folder)).as_posix()


def _has_file(body: Unreadable) -> bool:
    place = Path(body.file)
    return mesh_reader(place.suffix) is not None and is_file(place)


def _without_placements(scene: Scene, files: MeshFiles) -> dict[str, Transform]:
    """Where the bodies would stand if the scene file did not place them: where their mesh file
    places them, in the unit of the scene."""
    unplaced: dict[str, Transform] = {}
    unit = stated_unit(scene.units)
    for body in scene.bodies:
        place = None
        if body.path is not None:
            item = files.item(FilePart(body.file.path, body.file.path, body.path))
            own = stated_unit(_stated_units(body) or body.file.units)
            place = scaled_world(item.transform, ratio(own, unit) if own and unit else 1.0)
        elif body.shape is None:
            place = scaled_mesh(None, body.unit_scale or 1.0)
        unplaced[body.id] = place or IDENTITY
    return unplaced


def _stated_units(body: Body) -> str | None:
    """Return the units of a mesh file that states none; None: nothing has to be said."""
    if body.shape is None and body.file.units is None and body.unit_scale and body.units:
        return unit_in(body.units, body.unit_scale)
    return None


def _entry(output: Path, body: Body, unplaced: Transform, by: Vector) -> document.Body:
    """unplaced: as of `_without_placements`. by: its translation."""
    is_mesh = body.shape is None
    # The block of a half space follows from the scene.
    shape = document.HalfSpace() if isinstance(body.shape, HalfSpace) else body.shape
    return document.Body(
        id=body.id,
        mesh=path_from(output, Path(body.file.path)) if is_mesh else None,
        part=body.path if is_mesh else None,
        shape=shape,
        units=_stated_units(body),
        **_placement(_after(body.transform or IDENTITY, unplaced), by),
        groups=body.groups,
        static=body.static,
        pinned=body.pinned,
        surface_tolerance=body.surface_tolerance,
    )


def _after(placement: Transform, first: Transform) -> Transform:
    """The matrix that, after `first`, gives `placement`, but for rounding; without any if `first`
    is the identity."""
    if first == placement:
        return IDENTITY
    scale = first[0]
    if first == (scaled_mesh(None, scale) or IDENTITY):
        return tuple(value / scale if k % 4 < 3 else value for k, value in enumerate(placement))
    wanted, known = (np.array(rows).reshape(4, 4) for rows in (placement, first))
    return (*np.linalg.solve(known.T, wanted.T).T[:3].ravel().tolist(), 0.0, 0.0, 0.0, 1.0)


def _placement(transform: Transform, by: Vector) -> dict[str, Any]:
    rows = [list(transform[row : row + 4]) for row in (0, 4, 8, 12)]
    for row, step in zip(rows, by, strict=False):
        row[3] += step
    position = [row[3] for row in rows[:3]]
    if any(transform[k] != IDENTITY[k] for k in range(12) if k % 4 < 3):
        return {"matrix": rows}
    return {"position": position} if any(position) else {}


def _rule(rule: Rule | BodyRule) -> dict[str, Any]:
    values = {key: value for key, value in rule.stated().items() if key not in PLACE}
    if not rule.reason and values.get("allowed"):
        values["reason"] = f"allowed by {rule.name}"
    elif not rule.reason:
        del values["reason"]
    return values


def _motion(motion: Motion) -> document.Motion:
    way: dict[str, Any] = {}
    match motion.path:
        case PosePath(waypoints):
            way["path"] = tuple(
                document.Waypoint(time=p.time, position=p.position, quaternion=_w_first(p))
                for p in waypoints
            )
        case Rotation(point, axis, degrees):
            way["rotation"] = document.Rotation(axis=axis, point=point, degrees=degrees)
        case path:
            way["translation"] = path.vector
    bodies = document.Choices(map(Selector.exactly, motion.bodies))
    return document.Motion(bodies=bodies, clear=motion.clear, **way)


def _w_first(pose: Waypoint) -> document.Row:
    x, y, z, w = pose.orientation
    return w, x, y, z


def _plain(selectors: Any) -> str | list[str]:
    return str(selectors) if isinstance(selectors, str) else list(selectors)


def _json(scene: Mapping[str, Any]) -> str:
    lines = []
    for name, value in scene.items():
        text = json.dumps(value, ensure_ascii=False)
        if name in _LISTS:
            rows = ",".join(f"\n    {json.dumps(entry, ensure_ascii=False)}" for entry in value)
            text = f"[{rows}\n  ]"
        lines.append(f"  {_value(name)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _toml(scene: Mapping[str, Any]) -> str:
    tables = [_lines({key: value for key, value in scene.items() if key not in _LISTS})]
    for name in _LISTS:
        tables += [f"[[{name}]]\n{_lines(entry)}" for entry in scene.get(name, ())]
    return "\n".join(tables)


def _lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{key} = {_value(value)}\n" for key, value in table.items())


def _value(value: object) -> str:
    """A value in TOML; texts, numbers and lists are the same in JSON, but for a raw DEL, which TOML
    forbids."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
