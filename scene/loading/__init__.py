"""Mesh files of any supported format -> MeshFile."""

from __future__ import annotations

from pathlib import Path

from satcheck.core import Mesh
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.issue import issue
from satcheck.scene.loading import limits
from satcheck.scene.loading.native import NATIVE_FORMATS, read_native
from satcheck.scene.loading.raw_mesh import RawMesh
from satcheck.scene.loading.source import Source, read_source
from satcheck.scene.resolution import file_resolution


def load_mesh_file(path: str, location: Path, *, seconds: float, megabytes: int) -> MeshFile:
    """Reads one mesh file.

    path: its name in messages and reports. location: where it lies. seconds, megabytes: limits for
    reading it; the file itself may take a quarter of the megabytes. Raises MeshFileError.
    """
    max_bytes = megabytes * limits.BYTES_PER_MEGABYTE // limits.FILE_SHARE_OF_MEMORY
    source = read_source(path, location, max_bytes=max_bytes)
    try:
        raw = _read(source, seconds, megabytes)
        mesh = Mesh.from_bytes(raw.vertices, raw.triangles)
        examined = examine(mesh)
    except MeshFileError as error:
        raise MeshFileError(error.code, error.message, file=path) from error.__cause__
    except MemoryError:
        raise MeshFileError("reader-out-of-memory", "out of memory", file=path) from None
    except ValueError as error:  # the mesh refuses what a reader let through
        raise MeshFileError("bad-record", str(error), file=path) from error
    except OverflowError as error:
        raise MeshFileError("out-of-range", str(error), file=path) from error
    low, high = examined.mesh.bounds
    largest = max(map(abs, (*low, *high)))
    return MeshFile(
        path=path,
        sha256=source.sha256,
        format=source.format,
        resolution=file_resolution(raw, largest),
        units=raw.units,
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        issues=tuple(
            issue(code, message, file=path) for code, message in (*raw.warnings, *examined.warnings)
        ),
    )


def _read(source: Source, seconds: float, megabytes: int) -> RawMesh:
    if source.format in NATIVE_FORMATS:
        return read_native(source)
    is_gltf = source.format in ("glb", "gltf")
    if is_gltf and len(source.data) <= limits.IN_PROCESS_BYTES:
        from satcheck.scene.loading.gltf import read_gltf

        directory = str(source.location.absolute().parent)
        return read_gltf(memoryview(source.data), directory, binary=source.format == "glb")
    from satcheck.scene.loading.foreign import read_foreign

    return read_foreign(source, seconds=seconds, megabytes=megabytes)
