"""Mesh files of any supported format -> MeshFile."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from pathlib import Path

from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.risky_steps import not_for_lack_of_memory
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import Examined, examine, examine_bytes
from satcheck.scene.issue import issue
from satcheck.scene.loading import limits
from satcheck.scene.loading.native_formats import NATIVE_FORMATS, read_native
from satcheck.scene.loading.raw_mesh import RawMesh, RawScene, Refusal, alone
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
    if source.format in NATIVE_FORMATS:
        return alone(read_native(source))
    is_gltf = source.format in ("glb", "gltf")
    if is_gltf and len(source.data) <= limits.IN_PROCESS_BYTES:
        from satcheck.scene.loading.gltf import read_gltf
        from satcheck.scene.loading.gltf_buffers import NeedsChild

        with suppress(NeedsChild):
            scene = read_gltf(
                memoryview(source.data),
                str(source.location.parent),
                binary=source.format == "glb",
                permitted=allowed.permitted,
                geometry=allowed.options.geometry,
            )
            if not flat:
                return scene
            from satcheck.scene.loading.flatten import flattened

            return alone(flattened(scene))
    from satcheck.scene.loading.child_formats import read_in_child

    return read_in_child(
        source,
        children,
        flat=flat,
        permitted=allowed.permitted,
        options=allowed.options,
        seconds=allowed.seconds,
        megabytes=allowed.megabytes,
    )


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
