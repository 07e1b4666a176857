"""Mesh files of any supported format -> MeshFile."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.risky_steps import not_for_lack_of_memory
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import Examined, examine, examine_bytes
from satcheck.scene.issue import issue
from satcheck.scene.loading import limits
from satcheck.scene.loading.raw_mesh import RawMesh, RawScene, Refusal, alone
from satcheck.scene.loading.readers import File, NeedsChild, Reader, reader_named
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source, read_source
from satcheck.scene.permitted import NOTHING_ELSE, Permitted
from satcheck.scene.read_options import ReadOptions
from satcheck.scene.resolution import far_vertex, file_resolution, placement_step


class ReadLimits(Struct, frozen=True):
    """Limits and options for reading one file.

    The file itself may have a quarter of the megabytes. permitted: where the files may lie that it
    refers to. hashed: whether its SHA-256 is needed.
    """

    seconds: float
    megabytes: int
    permitted: Permitted = NOTHING_ELSE
    hashed: bool = True
    options: ReadOptions = ReadOptions()

    @property
    def file_bytes(self) -> int:
        return self.megabytes * limits.BYTES_PER_MEGABYTE // limits.FILE_SHARE_OF_MEMORY


def load_mesh_file(
    path: str, location: Path, allowed: ReadLimits, children: ReadingChildren
) -> MeshFile:
    """Reads one mesh file as one mesh: all meshes of the file at their placements.

    path: its name in messages and reports. location: on disk. children: the child processes for
    formats that this process does not read. Raises MeshFileError.
    """
    source = open_source(path, location, allowed)
    scene = read_scene(source, allowed, children, flat=True)
    raw = _only_mesh(scene)
    return mesh_file(source, raw)


def open_source(path: str, location: Path, allowed: ReadLimits) -> Source:
    return read_source(path, location, max_bytes=allowed.file_bytes, hashed=allowed.hashed)


def read_scene(
    source: Source, allowed: ReadLimits, children: ReadingChildren, *, flat: bool
) -> RawScene:
    """The meshes of a file and their placements; flat: as one mesh. Raises MeshFileError."""
    try:
        return _read(source, allowed, children, flat)
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=source.path) from error.__cause__
    except (MemoryError, OverflowError, ValueError) as error:
        raise _refusal(source, error) from error


def _read(source: Source, allowed: ReadLimits, children: ReadingChildren, flat: bool) -> RawScene:
    reader = reader_named(source.format)
    assert reader is not None  # it has opened the source
    place = source.location
    file = File(
        source.format,
        str(place.parent),
        place.name,
        source.data,
        source.size,
        allowed.options,
        flat,
        allowed.permitted,
    )
    if source.size <= reader.here:
        with suppress(NeedsChild):
            return read_with(reader, file)
    from satcheck.scene.loading.child_formats import read_in_child

    if reader.by_name:
        file = replace(file, data=b"")
    return read_in_child(source.path, file, children, allowed)


def read_with(reader: Reader, file: File) -> RawScene:
    """Return the meshes of a file; one if it is to be flat. Raises MeshFileError and NeedsChild."""
    scene = reader.function()(file)
    if not reader.complete:
        message = (
            "the library that reads it may leave out what it does not know: overlaps count as it "
            "places the bodies, and no pair is proven apart"
        )
        scene = replace(scene, warnings=(*scene.warnings, ("incomplete", message)))
    is_one = len(scene.nodes) == 1 and scene.nodes[0].path is None and not scene.warnings
    if not file.flat or is_one:
        return scene
    from satcheck.scene.loading.flatten import flattened

    return alone(flattened(scene))


def _only_mesh(scene: RawScene) -> RawMesh:
    (part,) = scene.parts
    if isinstance(part.mesh, Refusal):
        raise MeshFileError(part.mesh.code, part.mesh.message)
    assert isinstance(part.mesh, RawMesh)  # flattened files have no exact shapes
    return part.mesh


def mesh_of(source: Source, raw: RawMesh) -> Mesh:
    """Return the mesh as read. Raises MeshFileError for errors that a reader does not check."""
    try:
        return Mesh.from_bytes(raw.vertices, raw.triangles)
    except (MemoryError, OverflowError, ValueError) as error:
        raise _refusal(source, error) from error


def mesh_file(
    source: Source,
    raw: RawMesh,
    mesh: Mesh | None = None,
    part: str | None = None,
    *,
    placed: bool = False,
) -> MeshFile:
    """Inspects a mesh of a file.

    raw: the mesh as read. mesh: a piece of it; None: all. part: its name in the file. placed: the
    file itself places it. Raises MeshFileError.
    """
    path = source.path
    try:
        examined = _examined(raw, mesh)
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=path) from error.__cause__
    except (MemoryError, OverflowError, ValueError) as error:
        raise _refusal(source, error) from error
    far = far_vertex(raw, examined.mesh)
    said = [*raw.warnings, *examined.warnings, *([("far-vertex", far)] if far else [])]
    return MeshFile(
        path=path,
        sha256=source.sha256,
        format=source.format,
        resolution=resolution_of(raw, examined.mesh),
        units=raw.units,
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        issues=tuple(issue(code, message, file=path) for code, message in said),
        part=part,
        placement_step=placement_step(raw, by_file=placed),
        surface_tolerance=raw.surface_tolerance,
    )


def _examined(raw: RawMesh, mesh: Mesh | None) -> Examined:
    resolution = partial(resolution_of, raw)
    if mesh:
        return examine(mesh, resolution=resolution)
    return examine_bytes(raw.vertices, raw.triangles, resolution)


def resolution_of(raw: RawMesh, mesh: Mesh) -> float:
    """Return the precision of the coordinates of the mesh."""
    low, high = mesh.bounds
    return file_resolution(raw, max(map(abs, (*low, *high))))


def _refusal(source: Source, error: Exception) -> MeshFileError:
    not_for_lack_of_memory(error)
    if isinstance(error, MemoryError):
        return MeshFileError("reader-out-of-memory", "out of memory", file=source.path)
    code = "out-of-range" if isinstance(error, OverflowError) else "bad-record"
    return MeshFileError(code, str(error), file=source.path)
