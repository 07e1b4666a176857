"""Honest reports of many kinds, to forge: between them they say something in every field."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from tests.audit.shapes import Mesh, bracket, moved, open_box, unit_box, write
from tests.audit.stages.test_thickness import wedge
from tests.cli.process import SAMPLES
from tests.verify.reports import Json, pieces, sheet

BOX = {"type": "box", "size": [1.0, 1.0, 1.0]}


def meshes(a: Mesh, b: Mesh, **settings: Any) -> Callable[[Path], Json]:
    def make(folder: Path) -> Json:
        return document(write(folder, a=a, b=b), **settings)

    return make


def placed(*bodies: Json, settings: Json | None = None, **keys: Any) -> Callable[[Path], Json]:
    """A scene file."""

    def make(folder: Path) -> Json:
        path = folder / "cell.json"
        content = {"schema": "satcheck.scene/1", "units": "mm", "bodies": list(bodies), **keys}
        path.write_text(json.dumps(content), "utf-8")
        write(folder, part=bracket())
        return document([path], **(settings or {}))

    return make


def document(paths: list[Path], **settings: Any) -> Json:
    asked = Settings(certificate=True, cache=False, **settings)
    made: Json = json.loads(json.dumps(check(load_scene(paths), asked).to_dict()))
    return made


def body(id_: str, shape: Json, x: float, y: float = 0.0, z: float = 0.0, **keys: Any) -> Json:
    return {"id": id_, "shape": shape, "position": [x, y, z], **keys}


RULES = [
    {"a": "deep", "b": "base", "max_depth": 0.5, "reason": "glued"},
    {"a": "close", "b": "base", "clearance": 1.0, "tolerance": 0.01},
    {"a": "close", "b": "deep", "severity": "warning", "tolerance": 0.0},
    {"a": "seated", "b": "base", "max_volume": 0.125},
    {"a": "free", "b": "base", "allowed": True, "reason": "glued"},
]
SCENE = placed(
    body("base", BOX, 0.0, static=True),
    body("deep", BOX, 0.75),
    body("close", BOX, -1.25, groups=["left"]),
    body("seated", BOX, 0.0, 0.75),
    body("free", BOX, 0.0, 0.0, 0.5),
    body("twin", BOX, -9.0, groups=["left"]),
    rules=RULES,
    ignore_within_groups=["left"],
    settings={"depth": True, "volume": True},
)
CURVED = placed(
    body("ball", {"type": "sphere", "radius": 1.0}, 0.0),
    body("can", {"type": "cylinder", "radius": 1.0, "height": 2.0}, 2.5),
    body("pill", {"type": "capsule", "radius": 1.0, "length": 2.0}, 0.0, 1.5),
    body("egg", {"type": "ellipsoid", "radii": [1.0, 2.0, 3.0]}, 6.0),
    body("tip", {"type": "cone", "radius": 1.0, "height": 2.0}, 0.0, 0.0, -2.5),
    settings={"depth": True, "clearance": 1.0},
)
MOVING = placed(
    body("base", BOX, 0.0),
    body("slide", BOX, 3.0),
    body("swing", BOX, 0.0, 3.0),
    body("walk", BOX, 0.0, 0.0, 5.0),
    motion=[
        {"bodies": "slide", "translation": [-2.5, 0.0, 0.0]},
        {"bodies": "swing", "rotation": {"point": [0, 1.5, 0], "axis": [0, 0, 1], "degrees": 90}},
        {
            "bodies": "walk",
            "path": [
                {"time": 0.0, "position": [0, 0, 0]},
                {"time": 1.0, "position": [0, 0, -3]},
            ],
        },
    ],
    settings={"depth": True, "clearance": 0.5},
)
# A bracket that its entry calls one of centimetres, in a scene of millimetres.
CONVERTED = placed(
    {"id": "bracket", "mesh": "part.obj", "units": "cm"}, body("base", BOX, 0.0), settings={}
)

# Of the bricks one stands, one tips over it, one hangs and one floats.
SUPPORTED = placed(
    body("floor", {"type": "box", "size": [9.0, 9.0, 1.0]}, 0.0, 0.0, -1.0, static=True),
    body("base", BOX, 0.0),
    body("tips", BOX, 0.75, 0.0, 1.0),
    body("stands", BOX, -2.0),
    body("ball", {"type": "sphere", "radius": 0.5}, -2.0, 0.0, 1.0),
    body("hangs", BOX, 0.0, 3.0, 2.0),
    body("floats", BOX, 0.0, -3.0, 2.0),
    statics={"gravity": [0, 0, -1], "friction": 0.5, "tolerance": 0.001},
    rules=[
        {"bodies": "*", "supported": True, "stable": True, "reason": "all"},
        {"bodies": "hangs", "mounted": True},
        {"bodies": "s*", "density": 2.0, "friction": 0.25, "severity": "warning"},
        {"bodies": "floats", "mass": 3.0, "severity": "error"},
    ],
)
# In a room like the bracket one lies, one sticks out within the tolerance and one beyond it; one is
# in a box, another one is not.
IN_REGIONS = placed(
    {"id": "room", "mesh": "part.obj"},
    body("crate", {"type": "box", "size": [4.0, 4.0, 4.0]}, 20.0),
    body("lies", BOX, 1.0, 1.0, 1.0),
    body("leans", BOX, 0.4995, 1.0, 3.0),
    body("leaves", BOX, 6.0, 1.0, 1.0),
    body("packed", BOX, 19.0),
    body("lost", BOX, 22.0),
    statics={"tolerance": 0.001},
    rules=[
        {"bodies": "l*", "inside": "room"},
        {"bodies": "room", "region": True},
        {"bodies": "crate", "region": True},
        {"bodies": "packed", "inside": "crate"},
        {"bodies": "lost", "inside": "crate", "severity": "warning"},
    ],
)

HONEST: dict[str, Callable[[Path], Json]] = {
    "convex": meshes(unit_box(), unit_box(0.5, 0.25, 0.125), depth=True, volume=True),
    "concave": meshes(
        bracket(), unit_box(5.5, 0.5, 1.0), depth=True, contacts=True, components=True, volume=True
    ),
    "with convex parts": meshes(bracket(), unit_box(5.5, 0.5, 1.0), parts=True),
    "thinner than deep": meshes(bracket(), unit_box(1.5, 1.5, 1.0, edge=2.0), depth=True),
    "apart": meshes(unit_box(), unit_box(3.0, 0.5, 0.25), clearance=1.0),
    "apart in a notch": meshes(bracket(), unit_box(2.5, 2.5, 1.0), clearance=0.25),
    "near": meshes(bracket(), unit_box(2.5, 2.5, 1.0), clearance=0.75),
    "touching": meshes(unit_box(), unit_box(1.0), contacts=True, volume=True),
    "touching at a corner": meshes(unit_box(), unit_box(1.0, 1.0, 1.0), contacts=True),
    "a gap in the touch band": meshes(unit_box(), unit_box(1.0 + 1e-12), clearance=1e-3),
    "an overlap in the touch band": meshes(unit_box(), unit_box(0.9), tolerance=0.2),
    "a way out in the touch band": meshes(unit_box(), unit_box(0.9), tolerance=0.2, depth=True),
    "surfaces that are off": meshes(unit_box(), wedge(), surface_tolerance=0.125),
    "inside": meshes(unit_box(1.0, 1.0, 1.0), unit_box(edge=4.0), depth=True),
    "open": meshes(open_box(), unit_box(1.25, 1.375, 1.3125), allow_open=True),
    "a sheet across": meshes(unit_box(), moved(sheet(), 0.5, 0.25, 0.5), depth=True),
    "in parts": meshes(pieces(unit_box(), unit_box(5.0)), unit_box(2.0), clearance=1.5),
    "in a plane": meshes(bracket(), unit_box(5.5, 1.5, 1.0), depth=True, planar="xy"),
    "thinner than deep in a plane": meshes(
        bracket(), unit_box(1.5, 1.5, 1.0, edge=2.0), depth=True, planar="xy"
    ),
    "apart in a plane": meshes(bracket(), unit_box(2.5, 2.5, 9.0), clearance=1.0, planar="xy"),
    "rules": SCENE,
    "curved": CURVED,
    "moving": MOVING,
    "converted": CONVERTED,
    "robot": lambda _: document([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"]),
    "supported": SUPPORTED,
    "in regions": IN_REGIONS,
}


@cache
def _text(name: str) -> str:
    return json.dumps(HONEST[name](Path(mkdtemp(prefix="satcheck-honest-"))))


def honest(name: str) -> Json:
    """A fresh copy."""
    made: Json = json.loads(_text(name))
    return made
