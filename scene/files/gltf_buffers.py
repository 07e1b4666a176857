"""The numbers of glTF: GLB chunks, buffers, buffer views and accessors, each range checked.

C++ unpacks them: importing numpy takes longer than reading most files.
"""

from __future__ import annotations

import math
import struct
from array import array
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck._native import readers
from satcheck._native.readers import read_file
from satcheck.scene.access import Context
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.gltf_document import (
    MESHOPT,
    NONE,
    Accessor,
    Attributes,
    Buffer,
    BufferView,
    GltfDocument,
    Meshopt,
    Sparse,
    SparseValues,
)
from satcheck.scene.files.readers import NeedsChild

_GLB_HEADER = struct.Struct("<4sII")  # magic, version, length of the file
_CHUNK_HEADER = struct.Struct("<II")  # length, type
_JSON_CHUNK = 0x4E4F534A
_BIN_CHUNK = 0x004E4942

_BYTES_OF_NUMBER = 8
_UINT32, _FLOAT32 = 5125, 5126
# componentType: typecode of an array.
_CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", _UINT32: "I", _FLOAT32: "f"}
_UNSIGNED = frozenset("BHI")
# componentType: the integer that means 1.0 in a normalized accessor.
_LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
_SIZES = {code: array(code).itemsize for code in _CODES.values()}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

if TYPE_CHECKING:
    Floats = memoryview[float]
    Indices = memoryview[int]

# (name, type) -> the vertex attribute row by row; None: it is missing.
Columns = Callable[[str, str], "Floats | None"]


class Work:
    """What a file costs beyond its size. A few bytes can name many numbers, and name them again.

    isolated: this process is a child, with limits of its own, that may crash.
    """

    def __init__(self, *, isolated: bool) -> None:
        self.isolated = isolated
        self._left = limits.IN_PROCESS_WORK

    def spend(self, size: int) -> None:
        """Raises NeedsChild if so many bytes are too much for this process."""
        self._left -= size
        if self._left < 0 and not self.isolated:
            raise NeedsChild


def split_glb(data: memoryview) -> tuple[memoryview, memoryview | None]:
    """(JSON text, binary chunk or None) of a GLB file."""
    if len(data) < _GLB_HEADER.size or bytes(data[:4]) != b"glTF":
        raise Refused("not-this-format", "not a GLB file: it does not start with glTF")
    _, version, length = _GLB_HEADER.unpack_from(data)
    if version != 2:
        raise Refused("unsupported-feature", f"GLB version {version}: 2 is read")
    if length != len(data):
        code = "truncated" if length > len(data) else "trailing-data"
        raise Refused(code, f"the header promises {length} bytes, the file has {len(data)} bytes")
    kinds: list[int] = []
    chunks: list[memoryview] = []
    offset = _GLB_HEADER.size
    while offset < length:
        start = offset + _CHUNK_HEADER.size
        if start > length:
            raise Refused("truncated", f"byte {offset}: a chunk header is cut off")
        size, kind = _CHUNK_HEADER.unpack_from(data, offset)
        if size > length - start:
            message = f"chunk length {size} exceeds the file, which has {length - start} bytes left"
            raise Refused("truncated", f"byte {offset}: {message}")
        offset = start + size
        kinds.append(kind)
        chunks.append(data[start:offset])
    if kinds[:1] != [_JSON_CHUNK]:
        raise Refused("bad-record", "the first chunk of the GLB file is not JSON")
    # Others are harmless: extensions name them (the glTF 2.0 specification, 4.4.3).
    for kind, name, rest in ((_JSON_CHUNK, "JSON", kinds[1:]), (_BIN_CHUNK, "binary", kinds[2:])):
        if kind in rest:
            raise Refused("bad-record", f"a {name} chunk of the GLB file is out of place")
    return chunks[0], chunks[1] if kinds[1:2] == [_BIN_CHUNK] else None


class Accessors:
    """The accessors of a document as arrays. A buffer is read when it is first used.

    chunk: the binary chunk of a GLB file. context: finds files with buffers. work: of all of the
    file. Raises Refused.
    """

    def __init__(
        self,
        document: GltfDocument,
        chunk: memoryview | None,
        context: Context,
        work: Work,
    ) -> None:
        self._accessors = document.accessors
        self._views = document.buffer_views
        self._infos = document.buffers
        self._chunk = chunk
        self._context = context
        self.work = work
        self._buffers: dict[int, memoryview] = {}
        self._unpacked: dict[int, memoryview] = {}
        self._made_bytes = 0
        self._indexed_bytes = 0

    def positions(self, index: int) -> Floats:
        """x, y, z of each vertex, all finite."""
        if self._accessors[index].component_type == _UINT32:
            raise Refused("bad-record", f"accessor {index}: positions of type uint32")
        return self.numbers(index, "VEC3", "coordinates")

    def numbers(self, index: int, kind: str, what: str = "numbers") -> Floats:
        """The numbers of a type such as VEC4 row by row, all finite."""
        data, code, stride = self._read(index, kind)
        largest = self.largest_integer(index) or 0
        numbers = readers.unpack_numbers(data, code, _COLUMNS[kind], stride, largest)
        if numbers is None:
            raise Refused("non-finite", f"accessor {index}: non-finite {what}")
        return memoryview(numbers).cast("d")

    def indices(self, index: int) -> tuple[Indices, int]:
        """Vertex numbers, and the largest of them; -1: none."""
        data, code, stride = self._read(index, "SCALAR")
        self._indexed_bytes += len(data)
        held = sum(map(len, (*self._buffers.values(), *self._unpacked.values())))
        if self._indexed_bytes > limits.MAX_REPEATED * held + limits.ANY_REPEATED:
            most = f"more than {limits.MAX_REPEATED} times over"
            raise Refused("too-large", f"accessor {index}: indices name the data {most}")
        if code not in _UNSIGNED:
            raise Refused("bad-record", f"accessor {index}: indices are not unsigned")
        indices, largest = readers.unpack_indices(data, code, stride)
        return memoryview(indices).cast("I"), largest

    def columns(self, attributes: Attributes) -> Columns:
        def rows(name: str, kind: str) -> Floats | None:
            return self.numbers(attributes[name], kind) if name in attributes else None

        return rows

    def has_data(self, index: int) -> bool:
        accessor = self._accessors[index]
        return accessor.buffer_view != NONE or bool(accessor.sparse)

    def largest_integer(self, index: int) -> int | None:
        """The integer that means 1.0 in a normalized accessor; None: not normalized."""
        accessor = self._accessors[index]
        return _LARGEST.get(accessor.component_type) if accessor.normalized else None

    def rounding(self, index: int) -> float:
        """How far the integers or the filter of packed data may put a number off: half a step;
        0.0: floats."""
        accessor = self._accessors[index]
        if accessor.component_type != _FLOAT32:
            return 0.5 / (self.largest_integer(index) or 1)
        off = self._rounding_of_filter(accessor, accessor.count, accessor)
        if accessor.sparse:
            sparse = accessor.sparse
            off = max(off, self._rounding_of_filter(sparse.values, sparse.count, accessor))
        return off

    def _rounding_of_filter(
        self, owner: Accessor | SparseValues, count: int, accessor: Accessor
    ) -> float:
        """The largest of the numbers that the owner's view holds for the accessor. A filter packs
        floats as integers of 24 bits times a power of two, with the exponent in the highest byte.
        """
        packed = None if owner.buffer_view == NONE else self._packed(owner.buffer_view)
        if packed is None or packed.filter != "EXPONENTIAL":
            return 0.0
        words = memoryview(self._unpack(owner.buffer_view, replace(packed, filter="NONE")))
        rows = self._rows(owner, "packed data", count, _COLUMNS[accessor.type], "i", words)
        return max((math.ldexp(0.5, word >> 24) for word in rows), default=0.0)

    def _read(self, index: int, kind: str) -> tuple[bytes, str, int]:
        """The numbers row by row, their type in the file, and the bytes from row to row."""
        accessor, what = self._accessors[index], f"accessor {index}"
        if accessor.type != kind:
            raise Refused("bad-record", f"{what}: {kind} expected")
        code, count, columns = _CODES[accessor.component_type], accessor.count, _COLUMNS[kind]
        self.work.spend(count * columns * _BYTES_OF_NUMBER)
        row = columns * _SIZES[code]
        if accessor.buffer_view != NONE and not accessor.sparse:
            data, stride = self._range(accessor, what, count, row)
            return bytes(data), code, stride
        if accessor.buffer_view != NONE:
            values = self._rows(accessor, what, count, columns, code)
        else:
            if count > limits.MAX_WITHOUT_DATA:
                most = f"{limits.MAX_WITHOUT_DATA} elements without data"
                raise Refused("too-large", f"{what} has {count}, and may have {most}")
            self._make(count * row, f"{what}, which has no data")
            values = array(code, [0]) * (count * columns)
        if accessor.sparse:
            self._replace(values, columns, accessor.sparse, f"{what}: sparse data")
        return values.tobytes(), code, row

    def _replace(self, values: array[Any], columns: int, sparse: Sparse, where: str) -> None:
        """Overwrites the elements that sparse data list."""
        code, count = _CODES[sparse.indices.component_type], sparse.count
        elements = self._rows(sparse.indices, where, count, 1, code)
        if count and max(elements) * columns >= len(values):
            raise Refused("index-out-of-range", f"{where}: element {max(elements)} does not exist")
        replaced = self._rows(sparse.values, where, count, columns, values.typecode)
        for k, element in enumerate(elements):
            start = element * columns
            values[start : start + columns] = replaced[k * columns : (k + 1) * columns]

    def _rows(
        self,
        owner: Accessor | SparseValues,
        what: str,
        count: int,
        columns: int,
        code: str,
        view: memoryview | None = None,
    ) -> array[Any]:
        """The elements in the range that the owner states. view: the bytes instead of those of its
        buffer view."""
        values = array(code)
        row = columns * values.itemsize
        data, stride = self._range(owner, what, count, row, view)
        if stride == row:
            values.frombytes(data)
        else:
            values.frombytes(b"".join(data[at : at + row] for at in range(0, len(data), stride)))
        return values

    def _range(
        self,
        owner: Accessor | SparseValues,
        what: str,
        count: int,
        row: int,
        view: memoryview | None = None,
    ) -> tuple[memoryview, int]:
        """The bytes from the first to the last element, and those from one to the next. row: bytes
        of an element. view: as of `_rows`."""
        number, start = owner.buffer_view, owner.byte_offset
        view = self.view(number) if view is None else view
        stride = self._views[number].byte_stride or row
        if stride < row:
            raise Refused("bad-record", f"buffer view {number}: elements overlap")
        needed = start + (count - 1) * stride + row if count else start
        if needed > len(view):
            raise Refused(
                "index-out-of-range",
                f"{what} exceeds its buffer view {number}: "
                f"{count} elements need {needed} bytes, it has {len(view)}",
            )
        return view[start:needed], stride

    def view(self, number: int) -> memoryview:
        """The bytes of a buffer view."""
        packed = self._packed(number)
        if packed is None:
            return self._bytes(self._views[number], f"buffer view {number}")
        if number not in self._unpacked:
            self._unpacked[number] = memoryview(self._unpack(number, packed))
        return self._unpacked[number]

    def _packed(self, number: int) -> Meshopt | None:
        """The packed data of a view; None: it is not packed."""
        view = self._views[number]
        if not view.extensions:
            return None
        found = (view.extension(name, Meshopt, f"buffer view {number}") for name in MESHOPT)
        return next(filter(None, found), None)

    def _unpack(self, number: int, packed: Meshopt) -> bytes:
        """The bytes of a view that meshopt packed."""
        where, size = f"buffer view {number}", packed.count * packed.byte_stride
        if size != self._views[number].byte_length:
            message = f"{packed.count} elements of {packed.byte_stride} bytes are not its length"
            raise Refused("count-mismatch", f"{where}: {message}")
        self._make(size, f"{where}, unpacked")
        self.work.spend(size)
        stream = bytes(self._bytes(packed, where))
        unpacked = readers.unpack_meshopt(
            stream, packed.mode, packed.count, packed.byte_stride, packed.filter
        )
        if isinstance(unpacked, readers.ReadError):
            raise Refused(unpacked.code, f"{where}: {unpacked.message}")
        return unpacked

    def _make(self, size: int, what: str) -> None:
        """Count bytes that the file does not hold. All of them may be as many as those of a file.
        Raises Refused."""
        self._made_bytes += size
        self._context.permitted.most.refuse_beyond(self._made_bytes, what)

    def _bytes(self, owner: BufferView | Meshopt, what: str) -> memoryview:
        """The bytes of its buffer that a view or its packed data names."""
        buffer, end = self._buffer(owner.buffer), owner.byte_offset + owner.byte_length
        if end > len(buffer):
            message = f"beyond buffer {owner.buffer} of {len(buffer)} bytes"
            raise Refused("index-out-of-range", f"{what} ends at byte {end}, {message}")
        return buffer[owner.byte_offset : end]

    def _buffer(self, number: int) -> memoryview:
        if number not in self._buffers:
            info = self._infos[number]
            data, size = self._fetch(info, number), info.byte_length
            if len(data) < size:
                message = f"buffer {number} should have {size} bytes, it has {len(data)}"
                raise Refused("truncated", message)
            self._buffers[number] = data[:size]
        return self._buffers[number]

    def _fetch(self, info: Buffer, number: int) -> memoryview:
        if info.uri is None:
            if number != 0 or self._chunk is None:
                raise Refused("missing-resource", f"buffer {number} has no data")
            return self._chunk
        if info.uri.startswith("data:"):
            import base64

            header, _, text = info.uri.partition(",")
            try:
                if not header.endswith(";base64"):
                    raise ValueError("base64 expected")
                return memoryview(base64.b64decode(text, validate=True))
            except ValueError as error:
                raise Refused("bad-record", f"buffer {number}: data URI: {error}") from None
        return memoryview(self._fetch_file(info.uri, info.byte_length))

    def _fetch_file(self, uri: str, size: int) -> bytes:
        from urllib.parse import unquote

        name = unquote(uri)
        if ":" in uri or "\\" in name:
            raise Refused("outside-path", f"buffer {name!r} is not a relative path: refused")
        with self._context.open("buffer file", name) as (file, there):
            size = min(size, there)
            self.work.spend(size)
            return read_file(file.fileno(), size)
