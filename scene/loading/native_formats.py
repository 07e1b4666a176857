"""Reads OBJ, STL, PLY and OFF with the strict C++ readers, in this process."""

from __future__ import annotations

from satcheck._native import readers
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.raw_mesh import RawMesh
from satcheck.scene.loading.source import Source

_READERS = {
    "obj": readers.read_obj,
    "stl": readers.read_stl,
    "ply": readers.read_ply,
    "off": readers.read_off,
}

NATIVE_FORMATS = frozenset(_READERS)


def read_native(source: Source) -> RawMesh:
    """The mesh of a file in one of `NATIVE_FORMATS`; raises MeshFileError with line or byte."""
    outcome = _read_in_pieces(source) if source.in_pieces else _READERS[source.format](source.data)
    if isinstance(outcome, readers.ReadError):
        raise MeshFileError(outcome.code, f"{_place(outcome)}{outcome.message}", file=source.path)
    return RawMesh(
        vertices=outcome.vertices,
        triangles=outcome.triangles,
        number_format=outcome.number_format,
        decimals=outcome.decimals,
        significant=outcome.significant,
        rounding=outcome.rounding,
        warnings=tuple((warning.code, warning.message) for warning in outcome.warnings),
    )


def _read_in_pieces(source: Source) -> readers.MeshData | readers.ReadError:
    try:
        with source.location.open("rb", buffering=0) as file:
            return readers.read_binary_stl(file.fileno(), source.size)
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise MeshFileError("unreadable-file", reason, file=source.path) from None


def _place(error: readers.ReadError) -> str:
    if error.line >= 0:
        return f"line {error.line}: "
    if error.offset >= 0:
        return f"byte {error.offset}: "
    return ""
