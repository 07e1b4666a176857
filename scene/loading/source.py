"""One mesh file's bytes: read once, hashed, and recognised by suffix and by content."""

from __future__ import annotations

import hashlib
import stat
from dataclasses import dataclass, field
from pathlib import Path

from satcheck.scene.errors import MeshFileError

FORMATS = {
    ".obj": "obj",
    ".stl": "stl",
    ".ply": "ply",
    ".off": "off",
    ".glb": "glb",
    ".gltf": "gltf",
    ".3mf": "3mf",
    ".dae": "dae",
}

_STL_HEADER_BYTES = 84
_STL_FACET_BYTES = 50
_STL_COUNT = slice(80, 84)

# The first bytes of what people misname as meshes: (signature, name, our format or None).
_SIGNATURES = (
    (b"\x89PNG\r\n", "a PNG image", None),
    (b"\xff\xd8\xff", "a JPEG image", None),
    (b"GIF8", "a GIF image", None),
    (b"%PDF", "a PDF document", None),
    (b"\x1f\x8b", "gzip data", None),
    (b"\x7fELF", "an ELF program", None),
    (b"glTF", "a GLB file", "glb"),
    (b"PK\x03\x04", "a zip archive", "3mf"),
    (b"ply\n", "a PLY file", "ply"),
    (b"ply\r\n", "a PLY file", "ply"),
)


@dataclass(frozen=True, slots=True)
class Source:
    """A mesh file as it lies on disk.

    path: as given, for messages. location: where it was read from. sha256: of `data`, hex.
    """

    path: str
    location: Path
    format: str
    sha256: str
    data: bytes = field(repr=False)


def read_source(path: str, location: Path, *, max_bytes: int) -> Source:
    """Reads a mesh file, or raises MeshFileError.

    A path whose suffix belongs to no mesh format is refused without being opened.
    """
    file_format = FORMATS.get(location.suffix.lower())
    if file_format is None:
        known = ", ".join(sorted(FORMATS))
        raise MeshFileError(
            "unsupported-format",
            f"unsupported format {location.suffix!r}: known are {known}",
            file=path,
        )
    data = _read(path, location, max_bytes)
    _refuse_other_content(path, file_format, data)
    return Source(path, location, file_format, hashlib.sha256(data).hexdigest(), data)


def _read(path: str, location: Path, max_bytes: int) -> bytes:
    try:
        status = location.stat()
        if not stat.S_ISREG(status.st_mode):
            raise MeshFileError("not-a-file", "not a regular file", file=path)
        if status.st_size > max_bytes:
            raise MeshFileError(
                "too-large",
                f"{status.st_size} bytes exceed the limit of {max_bytes} bytes for one file",
                file=path,
            )
        return location.read_bytes()
    except FileNotFoundError:
        raise MeshFileError("file-not-found", "no such file", file=path) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a NUL character
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise MeshFileError("unreadable-file", f"cannot be read: {reason}", file=path) from None


def _refuse_other_content(path: str, file_format: str, data: bytes) -> None:
    content, content_format = _sniff(data)
    if content is not None and content_format != file_format:
        raise MeshFileError(
            "format-mismatch",
            f"not of format {file_format.upper()}: its content is {content}",
            file=path,
        )


def _sniff(data: bytes) -> tuple[str | None, str | None]:
    """(what the content unmistakably is, the format of that name), or (None, None)."""
    for signature, name, signature_format in _SIGNATURES:
        if data.startswith(signature):
            return name, signature_format
    count = int.from_bytes(data[_STL_COUNT], "little")
    if count > 0 and len(data) == _STL_HEADER_BYTES + _STL_FACET_BYTES * count:
        return "a binary STL file", "stl"
    return None, None
