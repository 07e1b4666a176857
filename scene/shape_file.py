"""Makes a MeshFile of a shape, or of a new mesh for a file."""

from __future__ import annotations

import hashlib
import json

from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.conventions import LARGEST_LENGTH, SMALLEST_SIZE
from satcheck.core.shape_mesh import DEFAULT_SEGMENTS, mesh_of
from satcheck.core.shapes import Primitive, sizes_of, values_of
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.planar.outline import Outline, Shape
from satcheck.scene.resolution import FLOAT64_STEP
from satcheck.scene.words import told_apart

SHAPE_FORMAT = "shape"


def shape_file(shape: Shape, path: str, segments: int = DEFAULT_SEGMENTS) -> MeshFile:
    """The mesh of the shape. path: the scene file that states it.

    sha256: of the values of the shape and the number of segments. The sizes are exact float64
    numbers, so the resolution is float64 rounding. Raises MeshFileError (`out-of-range`).
    The mesh of a curved shape lies within the shape.
    """
    try:
        if isinstance(shape, Outline):
            examined = examine(shape.mesh(), orient=False)
        else:
            _require_in_range(shape, path)
            examined = examine(mesh_of(shape, segments))
    except OverflowError as error:
        raise MeshFileError("out-of-range", str(error), file=path) from None
    low, high = examined.mesh.bounds
    canonical = json.dumps([values_of(shape), segments], sort_keys=True)
    return MeshFile(
        path=path,
        sha256=hashlib.sha256(canonical.encode()).hexdigest(),
        format=SHAPE_FORMAT,
        resolution=max(map(abs, (*low, *high))) * FLOAT64_STEP,
        units=None,
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        issues=(),
    )


def _require_in_range(shape: Primitive, path: str) -> None:
    for size in sizes_of(shape):
        if not SMALLEST_SIZE <= size <= LARGEST_LENGTH:
            limit = SMALLEST_SIZE if size < SMALLEST_SIZE else LARGEST_LENGTH
            message = (
                f"the {type(shape).__name__.lower()} has a size of {told_apart(size, limit)[0]}, "
                f"out of range: sizes may be from {SMALLEST_SIZE:g} to {LARGEST_LENGTH:g}; use "
                "another unit of length"
            )
            raise MeshFileError("out-of-range", message, file=path)


def remeshed(file: MeshFile, mesh: Mesh) -> MeshFile:
    """The file with this mesh instead, inspected and repaired as after reading.

    sha256: of the mesh, so that cached results for the mesh of the file are not used for this one.
    Raises MeshFileError when no triangle has an area.
    """
    examined = examine(mesh, resolution=lambda _: file.resolution)
    return replace(
        file,
        sha256=hashlib.sha256(b"".join(mesh.to_bytes())).hexdigest(),
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
    )
