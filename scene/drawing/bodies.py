"""A drawing file as meshes: sheets in the plane z = 0, for checks in a plane."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from satcheck.core import Mesh
from satcheck.core.worker import WorkerError
from satcheck.scene.bodies import MeshFile
from satcheck.scene.drawing import DRAWINGS
from satcheck.scene.drawing.contour import RefusedShape
from satcheck.scene.drawing.reading import DrawingMessage, SheetMessage, read_drawing
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading import ReadLimits
from satcheck.scene.loading.child_formats import refused_by_worker
from satcheck.scene.loading.nodes import Node, Nodes
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source, read_source
from satcheck.scene.plain_ids import UniqueNames
from satcheck.scene.resolution import FLOAT64_ROUNDING


def load_drawing(
    path: str, location: Path, allowed: ReadLimits, children: ReadingChildren
) -> MeshFile:
    """An SVG or DXF file as one mesh, all its shapes together.

    The resolution is the largest distance between a curve and its polygon, plus the rounding of the
    coordinates. Raises MeshFileError.
    """
    source, drawing = _read(path, location, allowed, children, whole=True)
    (sheet,) = drawing.sheets
    return _sheet_file(source, drawing.units, sheet, None, _ignored(source, drawing))


def load_shapes(path: str, location: Path, allowed: ReadLimits, children: ReadingChildren) -> Nodes:
    """The shapes of a drawing, each a node of its own. A shape that cannot be used becomes an
    error, and the others are still read."""
    source, drawing = _read(path, location, allowed, children, whole=False)
    names = UniqueNames()
    nodes = []
    for sheet in drawing.sheets:
        name = names.unique(sheet.name)
        try:
            nodes.append(Node(name, _sheet_file(source, drawing.units, sheet, name)))
        except MeshFileError as error:
            nodes.append(Node(name, error))
    return Nodes(tuple(nodes), _ignored(source, drawing))


def _ignored(source: Source, drawing: DrawingMessage) -> tuple[Issue, ...]:
    return tuple(issue("ignored-geometry", words, file=source.path) for words in drawing.ignored)


def _read(
    path: str, location: Path, allowed: ReadLimits, children: ReadingChildren, *, whole: bool
) -> tuple[Source, DrawingMessage]:
    source = read_source(
        path, location, max_bytes=allowed.file_bytes, formats=DRAWINGS, hashed=allowed.hashed
    )
    try:
        return source, read_drawing(
            source.format, source.data, children, whole=whole, seconds=allowed.seconds
        )
    except WorkerError as error:
        raise refused_by_worker(error, source.format, path, allowed.megabytes) from error
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=path) from None


def _sheet_file(
    source: Source,
    units: str | None,
    sheet: SheetMessage | RefusedShape,
    name: str | None,
    issues: tuple[Issue, ...] = (),
) -> MeshFile:
    if isinstance(sheet, RefusedShape):
        raise MeshFileError(sheet.code, sheet.message, file=source.path)
    points = np.frombuffer(sheet.points, "<f8").reshape(-1, 2)
    vertices = np.column_stack((points, np.zeros(len(points))))
    triangles = np.frombuffer(sheet.triangles, "<u4").reshape(-1, 3)
    try:
        examined = examine(Mesh(vertices, triangles), orient=False)
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=source.path) from None
    except OverflowError as error:
        raise MeshFileError("out-of-range", str(error), file=source.path) from None
    return MeshFile(
        path=source.path,
        sha256=source.sha256,
        format=source.format,
        resolution=sheet.deviation + float(np.abs(points).max()) * FLOAT64_ROUNDING,
        units=units,
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        issues=issues,
        part=name,
        deviation=sheet.deviation,
        inscribed=sheet.inscribed,
    )
