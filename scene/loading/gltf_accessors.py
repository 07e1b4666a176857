"""Typed arrays of glTF: accessors, dense and sparse, each range checked."""

from __future__ import annotations

import math
import sys
from array import array
from collections.abc import Callable, Sequence
from typing import Any

from satcheck.scene._readers import float64_of, uint32_of
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.gltf_buffers import BufferViews, integer, items, member
from satcheck.scene.loading.raw_mesh import Block

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

# (attributes, name, type) -> the elements of that vertex attribute; None if there is none.
Columns = Callable[[str, str], Sequence[tuple[float, ...]] | None]


class Accessors:
    """Typed arrays of a glTF document."""

    def __init__(self, document: dict[str, Any], views: BufferViews) -> None:
        self._accessors = items(document, "accessors")
        self._views = views

    def positions(self, index: int) -> bytes:
        """x, y, z of each element, little-endian float64, all finite."""
        values, normalized = self._read(index, "VEC3")
        if values.typecode == "I":
            raise MeshFileError("bad-record", f"accessor {index}: positions of type uint32")
        if values.typecode == "f":
            coordinates = float64_of(values.tobytes())
            if coordinates is None:
                raise MeshFileError("non-finite", f"accessor {index}: non-finite coordinates")
            return coordinates
        return _real(values, normalized).tobytes()

    def numbers(self, index: int, kind: str) -> list[tuple[float, ...]]:
        """The columns of each element of a type such as VEC4, all finite."""
        values, normalized = self._read(index, kind)
        if not all(map(math.isfinite, values)):
            raise MeshFileError("non-finite", f"accessor {index}: non-finite numbers")
        return list(zip(*[iter(_real(values, normalized))] * _COLUMNS[kind], strict=True))

    def indices(self, index: int) -> tuple[bytes, int]:
        """Vertex numbers, little-endian uint32, and the largest of them."""
        values, _ = self._read(index, "SCALAR")
        if values.typecode not in _INDEX_TYPES:
            raise MeshFileError("bad-record", f"accessor {index}: indices are not unsigned")
        return uint32_of(values.tobytes(), values.itemsize)

    def columns(self, attributes: dict[str, Any]) -> Columns:
        """attributes: numbers of accessors by name."""

        def named(name: str, kind: str) -> list[tuple[float, ...]] | None:
            return self.numbers(integer(attributes, name, -1), kind) if name in attributes else None

        return named

    def has_data(self, index: int) -> bool:
        accessor = member(self._accessors, index, "accessor")
        return "bufferView" in accessor or "sparse" in accessor

    def one(self, index: int) -> float | None:
        """The integer that stands for 1.0; None where integers stand for themselves."""
        accessor = member(self._accessors, index, "accessor")
        known = _COMPONENTS.get(integer(accessor, "componentType", 0))
        return known[1] or None if known and accessor.get("normalized") is True else None

    def bytes_of_view(self, number: int) -> bytes:
        return bytes(self._views.view(number))

    def _read(self, index: int, kind: str) -> tuple[array[Any], bool]:
        accessor = member(self._accessors, index, "accessor")
        component = _COMPONENTS.get(integer(accessor, "componentType", 0))
        if component is None or accessor.get("type") != kind:
            raise MeshFileError("bad-record", f"accessor {index}: {kind} expected")
        count = integer(accessor, "count", 0)
        values = array(component[0])
        row = values.itemsize * _COLUMNS[kind]
        if "bufferView" in accessor:
            values.frombytes(self._rows(accessor, f"accessor {index}", count, row))
        elif count > limits.MAX_ZEROS:
            raise MeshFileError("too-large", f"accessor {index}: {count} elements without data")
        else:
            values.frombytes(bytes(count * row))
        if "sparse" in accessor:
            self._replace(values, accessor["sparse"], index, row)
        if sys.byteorder == "big":
            values.byteswap()
        return values, accessor.get("normalized") is True

    def _rows(self, owner: dict[str, Any], what: str, count: int, row: int) -> Block:
        """`count` elements of `row` bytes each, where the owner says that they lie."""
        number = integer(owner, "bufferView", 0)
        view, stride = self._views.view(number), self._views.stride(number, row)
        start = integer(owner, "byteOffset", 0)
        needed = start + (count - 1) * stride + row if count else start
        if needed > len(view):
            raise MeshFileError(
                "index-out-of-range",
                f"{what} exceeds its buffer view {number}: "
                f"{count} elements need {needed} bytes, it has {len(view)}",
            )
        if stride == row:
            return view[start : start + count * row]
        return b"".join(view[start + i * stride : start + i * stride + row] for i in range(count))

    def _replace(self, values: array[Any], sparse: Any, index: int, row: int) -> None:
        """Overwrites the elements that sparse data lists."""
        where = f"accessor {index}: sparse data"
        given = sparse if isinstance(sparse, dict) else {}
        places, rows = (member([given.get(key)], 0, where) for key in ("indices", "values"))
        code, _ = _COMPONENTS.get(integer(places, "componentType", 0), ("", 0))
        if code not in _INDEX_TYPES:
            raise MeshFileError("bad-record", f"{where}: indices are not unsigned")
        changed = integer(sparse, "count", 0)
        size = array(code).itemsize
        numbers, largest = uint32_of(bytes(self._rows(places, where, changed, size)), size)
        if changed and largest * row >= len(values) * values.itemsize:
            raise MeshFileError("index-out-of-range", f"{where}: element {largest} does not exist")
        content = self._rows(rows, where, changed, row)
        columns = row // values.itemsize
        replaced = array(values.typecode)
        replaced.frombytes(content)
        for i, element in enumerate(array("I", numbers)):
            start = element * columns
            values[start : start + columns] = replaced[i * columns : (i + 1) * columns]


def _real(values: array[Any], normalized: bool) -> array[float]:
    if not normalized or values.typecode in "If":
        return array("d", values)
    one = next(largest for code, largest in _COMPONENTS.values() if code == values.typecode)
    return array("d", (max(value / one, -1.0) for value in values))
