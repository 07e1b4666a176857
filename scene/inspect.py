"""Makes a MeshFile: of a mesh as read, of a shape, or of a new mesh for a file. Each mesh is
inspected here, once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.conventions import LARGEST_LENGTH, SMALLEST_SIZE
from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import not_for_lack_of_memory
from satcheck.core.shape_mesh import DEFAULT_SEGMENTS, mesh_of
from satcheck.core.shapes import Primitive, sizes_of, values_of
from satcheck.scene.bodies import MeshFile
from satcheck.scene.document import RawMesh
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File
from satcheck.scene.health import examine, examine_bytes
from satcheck.scene.issue import issue
from satcheck.scene.planar.outline import Outline, Shape
from satcheck.scene.resolution import (
    FLOAT64_STEP,
    far_vertex,
    file_resolution,
    placement_step,
)
from satcheck.scene.words import told_apart

SHAPE_FORMAT = "shape"


@contextmanager
def errors_of(path: str) -> Iterator[None]:
    """Raises what goes wrong with a file meanwhile as Refused with its name, also what no
    reader checks."""
    try:
        yield
    except SatcheckError as error:
        raise Refused(error.code, error.message, file=path) from error.__cause__
    except MemoryError as error:
        not_for_lack_of_memory(error)
        raise Refused("reader-out-of-memory", "out of memory", file=path) from error
    except (OverflowError, ValueError) as error:
        code = "out-of-range" if isinstance(error, OverflowError) else "bad-record"
        raise Refused(code, str(error), file=path) from error


def mesh_file(
    file: File,
    raw: RawMesh,
    mesh: Mesh | None = None,
    part: str | None = None,
    *,
    placed: bool = False,
) -> MeshFile:
    """Inspect a mesh of a file.

    raw: the mesh as read. mesh: a piece of it; None: all. part: its name in the file. placed: the
    file itself places it. Raises Refused.
    """
    with errors_of(file.path):
        resolution = partial(resolution_of, raw)
        if mesh is None:
            examined = examine_bytes(raw.vertices, raw.triangles, resolution)
        else:
            examined = examine(mesh, resolution=resolution)
        far = far_vertex(raw, examined.mesh)
        said = [*raw.warnings, *examined.warnings, *([("far-vertex", far)] if far else [])]
        return MeshFile(
            path=file.path,
            sha256=file.sha256,
            format=file.format,
            resolution=resolution_of(raw, examined.mesh),
            units=raw.units,
            mesh=examined.mesh,
            topology=examined.topology,
            health=examined.health,
            issues=tuple(issue(code, message, file=file.path) for code, message in said),
            part=part,
            placement_step=placement_step(raw, by_file=placed),
            surface_tolerance=raw.surface_tolerance,
        )


def resolution_of(raw: RawMesh, mesh: Mesh) -> float:
    """Return the precision of the coordinates of the mesh."""
    low, high = mesh.bounds
    return file_resolution(raw, max(map(abs, (*low, *high))))


def shape_file(shape: Shape, path: str, segments: int = DEFAULT_SEGMENTS) -> MeshFile:
    """The mesh of the shape. path: the scene file that states it.

    sha256: of the values of the shape and the number of segments. The sizes are exact float64
    numbers, so the resolution is float64 rounding. Raises Refused (`out-of-range`).
    The mesh of a curved shape lies within the shape.
    """
    try:
        if isinstance(shape, Outline):
            examined = examine(shape.mesh(), orient=False)
        else:
            _require_in_range(shape, path)
            examined = examine(mesh_of(shape, segments))
    except OverflowError as error:
        raise Refused("out-of-range", str(error), file=path) from None
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
            raise Refused("out-of-range", message, file=path)


def remeshed(file: MeshFile, mesh: Mesh) -> MeshFile:
    """The file with this mesh instead, inspected and repaired as after reading.

    sha256: of the mesh, so that cached results for the mesh of the file are not used for this one.
    Raises Refused when no triangle has an area.
    """
    examined = examine(mesh, resolution=lambda _: file.resolution)
    return replace(
        file,
        sha256=hashlib.sha256(b"".join(mesh.to_bytes())).hexdigest(),
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
    )
