"""Small USD files, and what a check makes of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from satcheck.core.conventions import Bounds
from satcheck.core.curved.placed import curved_shape
from satcheck.core.shapes import is_curved
from satcheck.scene import Body, Scene, load_scene

_CUBE = """
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0,1,3,2, 4,6,7,5, 0,4,5,1, 2,3,7,6, 0,2,6,4, 1,5,7,3]
    point3f[] points = [(0,0,0),(0,0,1),(0,1,0),(0,1,1),(1,0,0),(1,0,1),(1,1,0),(1,1,1)]
    uniform token subdivisionScheme = "none"
"""


def cube(name: str, more: str = "", api: str = "", head: str = "") -> str:
    """A Mesh, the unit cube from (0, 0, 0) to (1, 1, 1). more: further properties. api: names in
    quotes. head: further metadata."""
    schemas = f"prepend apiSchemas = [{api}]" if api else ""
    return f'def Mesh "{name}" (\n {schemas}\n {head}\n)\n{{{_CUBE}\n{more}\n}}\n'


def at(x: float, y: float = 0, z: float = 0) -> str:
    return (
        f"double3 xformOp:translate = ({x}, {y}, {z})\n"
        'uniform token[] xformOpOrder = ["xformOp:translate"]\n'
    )


def stage(*prims: str, head: str = 'metersPerUnit = 1\nupAxis = "Z"') -> str:
    return f"#usda 1.0\n(\n{head}\n)\n" + "\n".join(prims) + "\n"


def load(folder: Path, text: str, name: str = "stage.usda", **options: Any) -> Scene:
    """options: of its reader; None: not given."""
    path = folder / name
    path.write_text(text)
    given = {name: value for name, value in options.items() if value is not None}
    return load_scene([path], reading=given)


def bounds_of(scene: Scene) -> dict[str, Bounds]:
    return {body.id: _bounds(body) for body in scene.bodies}


def _bounds(body: Body) -> Bounds:
    if is_curved(body.shape):
        return curved_shape(body.shape, body.transform).bounds()
    return body.world_mesh().bounds


def said(scene: Scene) -> dict[str, str]:
    return {issue.code: issue.message for issue in scene.issues}


def unread(scene: Scene) -> list[str]:
    """What blocks a pass."""
    return [issue.message for issue in scene.issues if issue.code == "unread"]
