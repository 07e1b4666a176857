"""The binary half of glTF: GLB chunks, buffers, views and accessors, each range checked."""

from __future__ import annotations

import sys
from array import array
from pathlib import Path
from typing import Any

from satcheck.scene._readers import float64_of, uint32_of
from satcheck.scene.errors import MeshFileError

_GLB_HEADER = 12  # bytes: magic, version, length of the file
_CHUNK_HEADER = 8  # length, type
_JSON_CHUNK = 0x4E4F534A
_BIN_CHUNK = 0x004E4942

# componentType: array type code, and the largest value a normalized integer stands for 1.0 with.
_COMPONENTS = {
    5120: ("b", 127.0),
    5121: ("B", 255.0),
    5122: ("h", 32767.0),
    5123: ("H", 65535.0),
    5125: ("I", 0.0),
    5126: ("f", 0.0),
}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_INDEX_TYPES = frozenset("BHI")


def items(owner: Any, key: str) -> list[Any]:
    """The list `owner[key]`; empty where it is missing."""
    value = owner.get(key, []) if isinstance(owner, dict) else None
    if not isinstance(value, list):
        raise MeshFileError("bad-record", f"glTF: {key} should be a list of an object")
    return value


def integer(owner: Any, key: str, default: int) -> int:
    """The non-negative integer `owner[key]`."""
    value = owner.get(key, default) if isinstance(owner, dict) else None
    if type(value) is not int or (value < 0 and value != default):
        raise MeshFileError("bad-record", f"glTF: {key} should be a non-negative integer")
    return value


def member(values: list[Any], index: int, what: str) -> dict[str, Any]:
    """The object `values[index]`."""
    if not 0 <= index < len(values):
        raise MeshFileError(
            "index-out-of-range", f"glTF: {what} {index} does not exist, there are {len(values)}"
        )
    value = values[index]
    if not isinstance(value, dict):
        raise MeshFileError("bad-record", f"glTF: {what} {index} is not an object")
    return value


def split_glb(data: memoryview) -> tuple[memoryview, memoryview | None]:
    """(JSON text, binary chunk or None) of a GLB file."""
    if len(data) < _GLB_HEADER or bytes(data[:4]) != b"glTF":
        raise MeshFileError("not-this-format", "not a GLB file: it does not start with glTF")
    version, length = _two_numbers(data, 4)
    if version != 2:
        raise MeshFileError("unsupported-feature", f"GLB version {version}: 2 is read")
    if length != len(data):
        code = "truncated" if length > len(data) else "trailing-data"
        raise MeshFileError(
            code, f"the header promises {length} bytes, the file has {len(data)} bytes"
        )
    chunks: list[tuple[int, memoryview]] = []
    offset = _GLB_HEADER
    while offset < length:
        if length - offset < _CHUNK_HEADER:
            raise MeshFileError("truncated", f"byte {offset}: a chunk header is cut off")
        size, kind = _two_numbers(data, offset)
        offset += _CHUNK_HEADER
        if size > length - offset:
            raise MeshFileError(
                "truncated",
                f"byte {offset - _CHUNK_HEADER}: chunk length {size} exceeds the file, "
                f"which has {length - offset} bytes left",
            )
        chunks.append((kind, data[offset : offset + size]))
        offset += size
    if not chunks or chunks[0][0] != _JSON_CHUNK:
        raise MeshFileError("bad-record", "the first chunk of the GLB file is not JSON")
    has_binary = len(chunks) > 1 and chunks[1][0] == _BIN_CHUNK
    return chunks[0][1], chunks[1][1] if has_binary else None


def _two_numbers(data: memoryview, offset: int) -> tuple[int, int]:
    """Little-endian, 32 bits each."""
    middle, end = offset + 4, offset + 8
    return int.from_bytes(data[offset:middle], "little"), int.from_bytes(data[middle:end], "little")


class Accessors:
    """Typed arrays of a glTF document; buffers are read when first asked for."""

    def __init__(
        self,
        document: dict[str, Any],
        chunk: memoryview | None,
        directory: str,
        *,
        allow_outside: bool,
    ) -> None:
        self._accessors = items(document, "accessors")
        self._views = items(document, "bufferViews")
        self._infos = items(document, "buffers")
        self._chunk = chunk
        self._directory = directory
        self._allow_outside = allow_outside
        self._buffers: dict[int, memoryview] = {}

    def positions(self, index: int) -> bytes:
        """x, y, z of each element, little-endian float64, all finite."""
        values, normalized = self._read(index, "VEC3")
        code = values.typecode
        if code == "I":
            raise MeshFileError("bad-record", f"accessor {index}: positions of type uint32")
        if code == "f":
            coordinates = float64_of(values.tobytes())
            if coordinates is None:
                raise MeshFileError("non-finite", f"accessor {index}: non-finite coordinates")
            return coordinates
        if not normalized:
            return array("d", values).tobytes()
        one = next(largest for known, largest in _COMPONENTS.values() if known == code)
        return array("d", (max(value / one, -1.0) for value in values)).tobytes()

    def indices(self, index: int) -> tuple[bytes, int]:
        """Vertex numbers, little-endian uint32, and the largest of them."""
        values, _ = self._read(index, "SCALAR")
        if values.typecode not in _INDEX_TYPES:
            raise MeshFileError("bad-record", f"accessor {index}: indices are not unsigned")
        return uint32_of(values.tobytes(), values.itemsize)

    def _read(self, index: int, kind: str) -> tuple[array[Any], bool]:
        accessor = member(self._accessors, index, "accessor")
        component = _COMPONENTS.get(integer(accessor, "componentType", 0))
        if component is None or accessor.get("type") != kind:
            raise MeshFileError("bad-record", f"accessor {index}: {kind} expected")
        if "sparse" in accessor or "bufferView" not in accessor:
            raise MeshFileError("unsupported-feature", f"accessor {index}: sparse data")
        values = array(component[0])
        row = values.itemsize * _COLUMNS[kind]
        count = integer(accessor, "count", 0)
        view_number = integer(accessor, "bufferView", 0)
        view, stride = self._view(view_number, row)
        start = integer(accessor, "byteOffset", 0)
        needed = start + (count - 1) * stride + row if count else start
        if needed > len(view):
            raise MeshFileError(
                "index-out-of-range",
                f"accessor {index} exceeds its buffer view {view_number}: "
                f"{count} elements need {needed} bytes, it has {len(view)}",
            )
        if stride == row:
            values.frombytes(view[start : start + count * row])
        else:
            rows = (start + i * stride for i in range(count))
            values.frombytes(b"".join(view[at : at + row] for at in rows))
        if sys.byteorder == "big":
            values.byteswap()
        return values, accessor.get("normalized") is True

    def _view(self, number: int, row: int) -> tuple[memoryview, int]:
        """(its bytes, bytes from one element to the next)."""
        view = member(self._views, number, "buffer view")
        buffer_number = integer(view, "buffer", 0)
        buffer = self._buffer(buffer_number)
        start = integer(view, "byteOffset", 0)
        end = start + integer(view, "byteLength", 0)
        if end > len(buffer):
            raise MeshFileError(
                "index-out-of-range",
                f"buffer view {number} ends at byte {end}, "
                f"beyond buffer {buffer_number} of {len(buffer)} bytes",
            )
        stride = integer(view, "byteStride", row)
        if stride < row:
            raise MeshFileError("bad-record", f"buffer view {number}: elements overlap")
        return buffer[start:end], stride

    def _buffer(self, number: int) -> memoryview:
        if number not in self._buffers:
            info = member(self._infos, number, "buffer")
            size = integer(info, "byteLength", 0)
            data = self._fetch(info, number, size)
            if len(data) < size:
                raise MeshFileError(
                    "truncated", f"buffer {number} should have {size} bytes, it has {len(data)}"
                )
            self._buffers[number] = data[:size]
        return self._buffers[number]

    def _fetch(self, info: dict[str, Any], number: int, size: int) -> memoryview:
        uri = info.get("uri")
        if uri is None:
            if number != 0 or self._chunk is None:
                raise MeshFileError("missing-resource", f"buffer {number} has no data")
            return self._chunk
        if not isinstance(uri, str):
            raise MeshFileError("bad-record", f"buffer {number}: the URI is not a text")
        if uri.startswith("data:"):
            import base64
            import binascii

            header, _, text = uri.partition(",")
            try:
                if not header.endswith(";base64"):
                    raise ValueError("base64 expected")
                return memoryview(base64.b64decode(text, validate=True))
            except (ValueError, binascii.Error) as error:
                raise MeshFileError("bad-record", f"buffer {number}: data URI: {error}") from None
        return memoryview(self._fetch_file(uri, size))

    def _fetch_file(self, uri: str, size: int) -> bytes:
        from urllib.parse import unquote

        name = unquote(uri)
        root = Path(self._directory).resolve()
        if ":" in uri or "\\" in name or "\0" in name:
            raise MeshFileError("outside-path", f"buffer {name!r} is not a relative path: refused")
        path = (root / name).resolve()
        if not self._allow_outside and not path.is_relative_to(root):
            raise MeshFileError(
                "outside-path", f"buffer {name!r} lies outside the file's directory: refused"
            )
        if not path.is_file():
            raise MeshFileError("missing-resource", f"missing buffer file {name!r}")
        try:
            with path.open("rb") as file:
                return file.read(min(size, path.stat().st_size))
        except OSError as error:
            raise MeshFileError(
                "unreadable-file", f"buffer file {name!r} cannot be read: {error.strerror}"
            ) from None
