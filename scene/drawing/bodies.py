"""A drawing file as meshes: sheets in the plane z = 0, for checks in a plane."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from satcheck.core import Mesh
from satcheck.core.worker import WorkerError
from satcheck.scene.bodies import MeshFile
from satcheck.scene.drawing import DRAWINGS
from satcheck.scene.drawing.reading import read_drawing
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.issue import issue
from satcheck.scene.loading import ReadLimits
from satcheck.scene.loading.foreign import refused_by_worker
from satcheck.scene.loading.nodes import Node, Nodes
from satcheck.scene.loading.source import Source, read_source
from satcheck.scene.plain_ids import UniqueNames
from satcheck.scene.resolution import FLOAT64_ROUNDING


def load_drawing(path: str, location: Path, allowed: ReadLimits) -> MeshFile:
    """An SVG or DXF file as one mesh, all its shapes together.

    The resolution is how far flattened curves may be off their polygons, and the rounding of the
    coordinates. Raises MeshFileError.
    """
    source, found = _read(path, location, allowed)
    for sheet in found["sheets"]:
        _refuse(sheet, source)
    return _sheet_file(source, found, _together(found["sheets"]))


def load_shapes(path: str, location: Path, allowed: ReadLimits) -> Nodes:
    """Its shapes, each a node by its name; one that cannot be used does not stop the others."""
    source, found = _read(path, location, allowed)
    names = UniqueNames()
    nodes = []
    for sheet in found["sheets"]:
        sheet["name"] = names.unique(sheet["name"])
        try:
            nodes.append(Node(sheet["name"], _sheet_file(source, found, sheet)))
        except MeshFileError as error:
            nodes.append(Node(sheet["name"], error))
    return Nodes(tuple(nodes))


def _read(path: str, location: Path, allowed: ReadLimits) -> tuple[Source, dict[str, Any]]:
    source = read_source(path, location, max_bytes=allowed.file_bytes, formats=DRAWINGS)
    seconds, megabytes = allowed.seconds, allowed.megabytes
    try:
        found = read_drawing(source.format, source.data, seconds=seconds, megabytes=megabytes)
    except WorkerError as error:
        raise refused_by_worker(error, source, megabytes) from error
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=path) from None
    return source, found


def _refuse(sheet: dict[str, Any], source: Source) -> None:
    if "refusal" in sheet:
        code, message = sheet["refusal"]
        raise MeshFileError(code, message, file=source.path)


def _together(sheets: list[dict[str, Any]]) -> dict[str, Any]:
    points: list[list[float]] = []
    triangles: list[list[int]] = []
    for sheet in sheets:
        triangles += [[corner + len(points) for corner in t] for t in sheet["triangles"]]
        points += sheet["points"]
    deviation = max(sheet["deviation"] for sheet in sheets)
    return {"name": None, "points": points, "triangles": triangles, "deviation": deviation}


def _sheet_file(source: Source, found: dict[str, Any], sheet: dict[str, Any]) -> MeshFile:
    _refuse(sheet, source)
    points = np.array(sheet["points"], dtype=np.float64)
    vertices = np.column_stack((points, np.zeros(len(points))))
    triangles = np.array(sheet["triangles"], dtype=np.uint32).reshape(-1, 3)
    try:
        examined = examine(Mesh(vertices, triangles), orient=False)
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=source.path) from None
    except OverflowError as error:
        raise MeshFileError("out-of-range", str(error), file=source.path) from None
    warnings = [("ignored-geometry", words) for words in found["ignored"]]
    return MeshFile(
        path=source.path,
        sha256=source.sha256,
        format=source.format,
        resolution=sheet["deviation"] + float(np.abs(points).max()) * FLOAT64_ROUNDING,
        units=found["units"],
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        issues=tuple(issue(code, words, file=source.path) for code, words in warnings),
        part=sheet["name"],
        deviation=sheet["deviation"],
    )
