"""Reads OBJ, STL, PLY and OFF with the strict C++ readers, in this process."""

from __future__ import annotations

from satcheck._native import readers
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.raw_mesh import RawMesh, RawScene, alone
from satcheck.scene.loading.readers import File

_READERS = {
    "obj": readers.read_obj,
    "stl": readers.read_stl,
    "ply": readers.read_ply,
    "off": readers.read_off,
}


def read_native(file: File) -> RawScene:
    """Return the mesh of a file. Raises MeshFileError with line or byte."""
    in_pieces = len(file.data) < file.size
    outcome = _read_in_pieces(file) if in_pieces else _READERS[file.format](bytes(file.data))
    if isinstance(outcome, readers.ReadError):
        raise MeshFileError(outcome.code, f"{_place(outcome)}{outcome.message}")
    mesh = RawMesh(
        vertices=outcome.vertices,
        triangles=outcome.triangles,
        number_format=outcome.number_format,
        decimals=outcome.decimals,
        significant=outcome.significant,
        rounding=outcome.rounding,
        warnings=tuple((warning.code, warning.message) for warning in outcome.warnings),
    )
    return alone(mesh)


def _read_in_pieces(file: File) -> readers.MeshData | readers.ReadError:
    try:
        with file.location.open("rb", buffering=0) as opened:
            return readers.read_binary_stl(opened.fileno(), file.size)
    except OSError as error:
        raise MeshFileError("unreadable-file", f"cannot be read: {error.strerror}") from None


def _place(error: readers.ReadError) -> str:
    if error.line >= 0:
        return f"line {error.line}: "
    if error.offset >= 0:
        return f"byte {error.offset}: "
    return ""
