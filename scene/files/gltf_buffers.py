"""The binary half of glTF: GLB chunks, buffers and buffer views, each range checked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from satcheck._native.readers import ReadError, unpack_meshopt
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.gltf_vocabulary import MESHOPT
from satcheck.scene.files.readers import NeedsChild
from satcheck.scene.opening import Permitted, followed, is_file, note

_GLB_HEADER = 12  # bytes: magic, version, length of the file
_CHUNK_HEADER = 8  # length, type
_JSON_CHUNK = 0x4E4F534A
_BIN_CHUNK = 0x004E4942

_MODES = ("ATTRIBUTES", "TRIANGLES", "INDICES")
_FILTERS = ("NONE", "EXPONENTIAL", "QUATERNION")  # the others are for normals and colours
_BYTES_OF_NUMBER = 8


class Work:
    """What a file costs beyond its size. A few bytes can name many numbers, and name them again.

    isolated: this process is a child, with limits of its own, that may crash.
    """

    def __init__(self, *, isolated: bool) -> None:
        self.isolated = isolated
        self._left = limits.IN_PROCESS_WORK

    def spend(self, numbers: int) -> None:
        """Raises NeedsChild if that is too much for this process."""
        self.spend_bytes(numbers * _BYTES_OF_NUMBER)

    def spend_bytes(self, size: int) -> None:
        self._left -= size
        if self._left < 0 and not self.isolated:
            raise NeedsChild


def items(owner: Any, key: str) -> list[Any]:
    """The list `owner[key]`; empty where it is missing."""
    value = owner.get(key, []) if isinstance(owner, dict) else None
    if not isinstance(value, list):
        raise Refused("bad-record", f"glTF: {key} should be a list in an object")
    return value


def integer(owner: Any, key: str, default: int) -> int:
    """The non-negative integer `owner[key]`."""
    if isinstance(owner, dict) and key not in owner:
        return default
    value = owner[key] if isinstance(owner, dict) else None
    if type(value) is not int or value < 0:
        raise Refused("bad-record", f"glTF: {key} should be a non-negative integer")
    return value


def member(values: list[Any], index: int, what: str) -> dict[str, Any]:
    """The object `values[index]`."""
    if not 0 <= index < len(values):
        raise Refused(
            "index-out-of-range", f"glTF: {what} {index} does not exist, there are {len(values)}"
        )
    value = values[index]
    if not isinstance(value, dict):
        raise Refused("bad-record", f"glTF: {what} {index} is not an object")
    return value


def split_glb(data: memoryview) -> tuple[memoryview, memoryview | None]:
    """(JSON text, binary chunk or None) of a GLB file."""
    if len(data) < _GLB_HEADER or bytes(data[:4]) != b"glTF":
        raise Refused("not-this-format", "not a GLB file: it does not start with glTF")
    version, length = _two_numbers(data, 4)
    if version != 2:
        raise Refused("unsupported-feature", f"GLB version {version}: 2 is read")
    if length != len(data):
        code = "truncated" if length > len(data) else "trailing-data"
        raise Refused(code, f"the header promises {length} bytes, the file has {len(data)} bytes")
    chunks: list[tuple[int, memoryview]] = []
    offset = _GLB_HEADER
    while offset < length:
        if length - offset < _CHUNK_HEADER:
            raise Refused("truncated", f"byte {offset}: a chunk header is cut off")
        size, kind = _two_numbers(data, offset)
        offset += _CHUNK_HEADER
        if size > length - offset:
            raise Refused(
                "truncated",
                f"byte {offset - _CHUNK_HEADER}: chunk length {size} exceeds the file, "
                f"which has {length - offset} bytes left",
            )
        chunks.append((kind, data[offset : offset + size]))
        offset += size
    if not chunks or chunks[0][0] != _JSON_CHUNK:
        raise Refused("bad-record", "the first chunk of the GLB file is not JSON")
    for kind, name in ((_JSON_CHUNK, "JSON"), (_BIN_CHUNK, "binary")):
        places = [number for number, (each, _) in enumerate(chunks) if each == kind]
        # Others are harmless: extensions name them (the glTF 2.0 specification, 4.4.3).
        if places not in ([], [0 if kind == _JSON_CHUNK else 1]):
            raise Refused("bad-record", f"a {name} chunk of the GLB file is out of place")
    has_binary = len(chunks) > 1 and chunks[1][0] == _BIN_CHUNK
    return chunks[0][1], chunks[1][1] if has_binary else None


def _two_numbers(data: memoryview, offset: int) -> tuple[int, int]:
    """Little-endian, 32 bits each."""
    middle, end = offset + 4, offset + 8
    return int.from_bytes(data[offset:middle], "little"), int.from_bytes(data[middle:end], "little")


def extension(owner: dict[str, Any], name: str) -> dict[str, Any] | None:
    """The data of an extension of an object; None: it has none."""
    extensions = owner.get("extensions", {})
    content = extensions.get(name) if isinstance(extensions, dict) else None
    return content if isinstance(content, dict) else None


class BufferViews:
    """The buffer views of a glTF document; a buffer is read when it is first used."""

    def __init__(
        self,
        document: dict[str, Any],
        chunk: memoryview | None,
        directory: str,
        work: Work,
        permitted: Permitted,
    ) -> None:
        self._work = work
        self._views = items(document, "bufferViews")
        self._infos = items(document, "buffers")
        self._chunk = chunk
        self._directory = directory
        self._permitted = permitted
        self._buffers: dict[int, memoryview] = {}
        self._unpacked: dict[int, memoryview] = {}
        self._unpacked_bytes = 0

    def view(self, number: int) -> memoryview:
        view = member(self._views, number, "buffer view")
        for name in MESHOPT:  # both pack in the same way
            packed = extension(view, name)
            if packed is not None:
                if number not in self._unpacked:
                    self._unpacked[number] = memoryview(self._unpack(number, view, packed))
                return self._unpacked[number]
        return self._range(view, f"buffer view {number}")

    def scaled_words(self, number: int) -> memoryview | None:
        """A view whose floats are packed as integers of 24 bits times a power of two: these words,
        with the exponent in the highest byte; None: another view."""
        view = member(self._views, number, "buffer view")
        for name in MESHOPT:  # both pack in the same way
            packed = extension(view, name)
            if packed is not None and packed.get("filter") == "EXPONENTIAL":
                return memoryview(self._unpack(number, view, {**packed, "filter": "NONE"}))
        return None

    def stride(self, number: int, row: int) -> int:
        """Bytes from one element of the view to the next; row: those of an element."""
        stride = integer(member(self._views, number, "buffer view"), "byteStride", row)
        if stride < row:
            raise Refused("bad-record", f"buffer view {number}: elements overlap")
        return stride

    def _range(self, view: dict[str, Any], what: str) -> memoryview:
        buffer_number = integer(view, "buffer", 0)
        buffer = self._buffer(buffer_number)
        start = integer(view, "byteOffset", 0)
        end = start + integer(view, "byteLength", 0)
        if end > len(buffer):
            raise Refused(
                "index-out-of-range",
                f"{what} ends at byte {end}, beyond buffer {buffer_number} of {len(buffer)} bytes",
            )
        return buffer[start:end]

    def _unpack(self, number: int, view: dict[str, Any], packed: dict[str, Any]) -> bytes:
        """The bytes of a view that meshopt packed."""
        count, stride = integer(packed, "count", 0), integer(packed, "byteStride", 0)
        mode, filter_ = packed.get("mode"), packed.get("filter", "NONE")
        if mode not in _MODES or filter_ not in _FILTERS or count * stride == 0:
            raise Refused(
                "bad-record",
                f"buffer view {number}: meshopt data of mode {mode!r} and filter {filter_!r}",
            )
        if count * stride != integer(view, "byteLength", 0):
            raise Refused(
                "count-mismatch",
                f"buffer view {number}: {count} elements of {stride} bytes are not its length",
            )
        self._unpacked_bytes += count * stride
        if self._unpacked_bytes > limits.MAX_UNPACKED_BYTES:
            raise Refused(
                "too-large",
                f"meshopt data unpacks to {self._unpacked_bytes} bytes and more, beyond "
                f"{limits.MAX_UNPACKED_BYTES}: unpack it before, or split the file",
            )
        self._work.spend_bytes(count * stride)
        stream = bytes(self._range(packed, f"buffer view {number}"))
        elements = unpack_meshopt(stream, mode, count, stride, filter_)
        if isinstance(elements, ReadError):
            raise Refused(elements.code, f"buffer view {number}: {elements.message}")
        return elements

    def _buffer(self, number: int) -> memoryview:
        if number not in self._buffers:
            info = member(self._infos, number, "buffer")
            size = integer(info, "byteLength", 0)
            data = self._fetch(info, number, size)
            if len(data) < size:
                raise Refused(
                    "truncated", f"buffer {number} should have {size} bytes, it has {len(data)}"
                )
            self._buffers[number] = data[:size]
        return self._buffers[number]

    def _fetch(self, info: dict[str, Any], number: int, size: int) -> memoryview:
        uri = info.get("uri")
        if uri is None:
            if number != 0 or self._chunk is None:
                raise Refused("missing-resource", f"buffer {number} has no data")
            return self._chunk
        if not isinstance(uri, str):
            raise Refused("bad-record", f"buffer {number}: the URI is not a text")
        if uri.startswith("data:"):
            import base64
            import binascii

            header, _, text = uri.partition(",")
            try:
                if not header.endswith(";base64"):
                    raise ValueError("base64 expected")
                return memoryview(base64.b64decode(text, validate=True))
            except (ValueError, binascii.Error) as error:
                raise Refused("bad-record", f"buffer {number}: data URI: {error}") from None
        return memoryview(self._fetch_file(uri, size))

    def _fetch_file(self, uri: str, size: int) -> bytes:
        from urllib.parse import unquote

        name = unquote(uri)
        root = followed(Path(self._directory))
        if ":" in uri or "\\" in name or "\0" in name:
            raise Refused("outside-path", f"buffer {name!r} is not a relative path: refused")
        note(Path(self._directory) / name)
        path = followed(root / name)
        if not self._permitted.has(path, root):
            where = self._permitted.beyond("the file's directory")
            message = f"buffer {name!r} lies {where}: refused (allow it with --allow-outside)"
            raise Refused("outside-path", message)
        if not is_file(path):
            raise Refused("missing-resource", f"missing buffer file {name!r}")
        try:
            size = min(size, path.stat().st_size)
            self._work.spend_bytes(size)
            with path.open("rb") as file:
                return file.read(size)
        except OSError as error:
            raise Refused(
                "unreadable-file", f"buffer file {name!r} cannot be read: {error.strerror}"
            ) from None
