"""Reports with certificates about small meshes, one for each kind of certificate."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from satcheck.verify import Rejected, VerificationReport, verify
from tests.audit.shapes import Mesh, bracket, moved, unit_box, write

Json = dict[str, Any]

ROD = 7.0


def sheet(x: float = 0.0, edge: float = 2.0) -> Mesh:
    """A square without thickness, perpendicular to z, in the plane z = 0."""
    points = [(x, 0.0, 0.0), (x + edge, 0.0, 0.0), (x + edge, edge, 0.0), (x, edge, 0.0)]
    return points, [(0, 1, 2, 3)]


def upright(y: float = 1.0) -> Mesh:
    """A square without thickness that stands across `sheet`."""
    points = [(0.5, y, -1.0), (1.5, y, -1.0), (1.5, y, 1.0), (0.5, y, 1.0)]
    return points, [(0, 1, 2, 3)]


def channel() -> Mesh:
    """A floor in the plane z = 0 between two walls, all without thickness."""
    points = [
        (x, y, z) for x, z in ((0.0, 4.0), (0.0, 0.0), (2.0, 0.0), (2.0, 4.0)) for y in (0, 2)
    ]
    return points, [(k, k + 1, k + 3, k + 2) for k in (0, 2, 4)]


def other_diagonals() -> Mesh:
    """The unit box, its faces split along the other diagonals."""
    points, faces = unit_box()
    return points, [(*face[1:], face[0]) for face in faces]


def pieces(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    points: list[Any] = []
    faces: list[Any] = []
    for mesh_points, mesh_faces in meshes:
        faces += [tuple(k + len(points) for k in face) for face in mesh_faces]
        points += mesh_points
    return points, faces


def turned(mesh: Mesh) -> Mesh:
    """The same faces, seen from the other side."""
    points, faces = mesh
    return points, [face[::-1] for face in faces]


def wall(x: float, y: float, z: float) -> Mesh:
    """A closed surface around nothing: a box and the same box turned."""
    return pieces(unit_box(x, y, z), turned(unit_box(x, y, z)))


# name: (relation, kind, A, B)
PAIRS: dict[str, tuple[str, str, Mesh, Mesh]] = {
    "boxes-apart": ("separated", "axis", unit_box(), unit_box(3.0)),
    "box-in-notch": ("separated", "surfaces", bracket(), unit_box(2.5, 2.5, 1.0)),
    "boxes-overlap": ("penetrating", "polytope", unit_box(), unit_box(0.5, 0.25, 0.125)),
    "box-in-arm": ("penetrating", "surfaces", bracket(), unit_box(5.5, 0.5, 1.0)),
    "flush-inside": ("penetrating", "surfaces", bracket(), unit_box(1.0, 0.0, 0.0)),
    "boxes-flush": ("touching", "axis", unit_box(), unit_box(1.0)),
    "box-on-notch": ("touching", "surfaces", bracket(), unit_box(2.0, 2.0, 1.0)),
    "box-in-box": ("contains", "surfaces", unit_box(edge=4.0), unit_box(1.0, 1.0, 1.0)),
    "box-around": ("inside", "surfaces", unit_box(1.0, 1.0, 1.0), unit_box(edge=4.0)),
    "box-in-bracket": ("contains", "surfaces", bracket(), unit_box(0.5, 0.5, 1.0)),
    "one-of-two": (
        "penetrating",
        "surfaces",
        unit_box(edge=4.0),
        pieces(unit_box(1.0, 1.0, 1.0), unit_box(8.0)),
    ),
    # Walls of no thickness are sheets; faces within the material are no boundary of a body.
    "wall-at-box": ("touching", "surfaces", pieces(wall(0, 0, 0), unit_box(5.0)), unit_box()),
    "box-in-wall": (
        "separated",
        "surfaces",
        pieces(wall(0, 0, 0), unit_box(5.0)),
        unit_box(0.25, 0.25, 0.25, edge=0.5),
    ),
    "wall-in-box": (
        "contains",
        "surfaces",
        unit_box(edge=4.0),
        pieces(wall(1, 1, 1), unit_box(2, 2, 1)),
    ),
    "wall-and-touch": (
        "touching",
        "surfaces",
        pieces(wall(0, 0, 0), unit_box(5.0)),
        pieces(unit_box(), unit_box(6.0)),
    ),
    "wall-sticks-out": (
        "penetrating",
        "surfaces",
        unit_box(edge=4.0),
        pieces(unit_box(1.0, 1.0, 1.0), wall(3.5, 1.0, 1.0)),
    ),
    "face-within": (
        "contains",
        "surfaces",
        pieces(unit_box(edge=4.0), unit_box(2.0, 2.0, 2.0, edge=4.0)),
        unit_box(1.5, 1.5, 1.5),
    ),
    "within-face": (
        "inside",
        "surfaces",
        unit_box(1.5, 1.5, 1.5),
        pieces(unit_box(edge=4.0), turned(unit_box(2.0, 2.0, 2.0, edge=4.0))),
    ),
    "face-within-flush": (
        "penetrating",
        "surfaces",
        pieces(unit_box(edge=4.0), unit_box(2.0, 2.0, 2.0, edge=4.0)),
        unit_box(1.5, 1.5, 0.0),
    ),
    "sheet-at-face-within": (
        "contains",
        "surfaces",
        pieces(unit_box(edge=4.0), unit_box(2.0, 2.0, 2.0, edge=4.0)),
        moved(sheet(edge=1.0), 2.5, 2.5, 2.0),
    ),
    "same-with-face-within": (
        "coincident",
        "surfaces",
        unit_box(edge=4.0),
        pieces(unit_box(edge=4.0), unit_box(1.0, 1.0, 1.0)),
    ),
    "same-box": ("coincident", "surfaces", unit_box(), unit_box()),
    "sheets-cross": ("penetrating", "surfaces", sheet(), upright()),
    "sheet-in-wall": ("penetrating", "surfaces", unit_box(), moved(sheet(), 0.5, 0.25, 0.5)),
    "sheet-on-wall": ("touching", "surfaces", bracket(), moved(sheet(), 2.0, 2.0, 4.0)),
    "sheet-in-box": ("contains", "surfaces", unit_box(edge=4.0), moved(sheet(), 1.0, 1.0, 1.0)),
    "wall-across": (
        "penetrating",
        "surfaces",
        pieces(wall(0, 0, 0), unit_box(5.0)),
        unit_box(0.5, 0.25, 0.25, edge=0.625),
    ),
}


@cache
def _folder() -> Path:
    return Path(mkdtemp(prefix="satcheck-verify-"))


@cache
def _text(name: str, depth: bool) -> str:
    _, _, a, b = PAIRS[name]
    folder = _folder() / name
    folder.mkdir(exist_ok=True)
    scene = load_scene(write(folder, a=a, b=b))
    return json.dumps(check(scene, Settings(certificate=True, depth=depth, cache=False)).to_dict())


def report_of(name: str, *, depth: bool = False) -> Json:
    """A fresh copy, to forge."""
    document: Json = json.loads(_text(name, depth))
    return document


def verified(document: Any) -> VerificationReport:
    return verify(document, Path("/"))


def is_accepted(document: Any) -> bool:
    """Neither refused as no report nor found to be false."""
    try:
        return verified(document).accepted
    except Rejected:
        return False


def forged(name: str, forge: Callable[[Json], None], *, depth: bool = False) -> VerificationReport:
    """The first finding of a report, changed by `forge`."""
    document = report_of(name, depth=depth)
    forge(document["findings"][0])
    return verified(document)
