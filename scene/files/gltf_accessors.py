"""The numbers of glTF: accessors, dense and sparse, each range checked.

C++ unpacks them: importing numpy takes longer than reading most files.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from satcheck._native import readers
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.gltf_buffers import (
    BufferViews,
    Work,
    integer,
    items,
    member,
)

# componentType: typecode of an array.
_COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
_UNSIGNED = frozenset("BHI")
# typecode: the integer that means 1.0 in a normalized accessor.
_LARGEST = {"b": 127, "B": 255, "h": 32767, "H": 65535}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

if TYPE_CHECKING:
    Floats = memoryview[float]
    Indices = memoryview[int]

# (name, type) -> the vertex attribute row by row; None: it is missing.
Columns = Callable[[str, str], "Floats | None"]


class Accessors:
    """Typed arrays of a glTF document."""

    def __init__(self, document: dict[str, Any], views: BufferViews, work: Work) -> None:
        self._work = work
        self._accessors = items(document, "accessors")
        self._views = views

    def positions(self, index: int) -> Floats:
        """x, y, z of each vertex, all finite."""
        if self._type(member(self._accessors, index, "accessor")) == "I":
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
        if code not in _UNSIGNED:
            raise Refused("bad-record", f"accessor {index}: indices are not unsigned")
        indices, largest = readers.unpack_indices(data, code, stride)
        return memoryview(indices).cast("I"), largest

    def columns(self, attributes: dict[str, Any]) -> Columns:
        """attributes: numbers of accessors by name."""

        def rows(name: str, kind: str) -> Floats | None:
            return self.numbers(integer(attributes, name, -1), kind) if name in attributes else None

        return rows

    def has_data(self, index: int) -> bool:
        accessor = member(self._accessors, index, "accessor")
        return "bufferView" in accessor or "sparse" in accessor

    def largest_integer(self, index: int) -> int | None:
        """The integer that means 1.0 in a normalized accessor; None: not normalized."""
        accessor = member(self._accessors, index, "accessor")
        stands = accessor.get("normalized") is True
        return _LARGEST.get(self._type(accessor)) if stands else None

    def rounding(self, index: int) -> float:
        """How far the integers or the filter of packed data may put a number off: half a step;
        0.0: floats."""
        accessor = member(self._accessors, index, "accessor")
        if self._type(accessor) != "f":
            return 0.5 / (self.largest_integer(index) or 1)
        owners = [accessor]
        if "sparse" in accessor:
            owners.append(member([accessor["sparse"].get("values")], 0, "sparse data"))
        return max(self._rounding_of_filter(owner, accessor) for owner in owners)

    def _rounding_of_filter(self, owner: dict[str, Any], accessor: dict[str, Any]) -> float:
        """The largest of the numbers that the owner's view holds for the accessor."""
        words = None
        if "bufferView" in owner:
            words = self._views.scaled_words(integer(owner, "bufferView", 0))
        if words is None:
            return 0.0
        columns = _COLUMNS[accessor["type"]]
        count = integer(owner if owner is accessor else accessor["sparse"], "count", 0)
        rows = self._rows(owner, "packed data", count, columns, "i", words)
        # The exponent is in the highest byte.
        return max((math.ldexp(0.5, word >> 24) for word in rows), default=0.0)

    def bytes_of_view(self, number: int) -> bytes:
        return bytes(self._views.view(number))

    @staticmethod
    def _type(owner: dict[str, Any]) -> str:
        """The typecode of an array; "" for none."""
        return _COMPONENTS.get(integer(owner, "componentType", 0), "")

    def _read(self, index: int, kind: str) -> tuple[bytes, str, int]:
        """The numbers row by row, their type in the file, and the bytes from row to row."""
        accessor = member(self._accessors, index, "accessor")
        code = self._type(accessor)
        if not code or accessor.get("type") != kind:
            raise Refused("bad-record", f"accessor {index}: {kind} expected")
        count, columns = integer(accessor, "count", 0), _COLUMNS[kind]
        self._work.spend(count * columns)
        row = columns * array(code).itemsize
        if "bufferView" in accessor and "sparse" not in accessor:
            data, stride = self._range(accessor, f"accessor {index}", count, row)
            return bytes(data), code, stride
        if "bufferView" in accessor:
            values = self._rows(accessor, f"accessor {index}", count, columns, code)
        elif count > limits.MAX_ZEROS:
            raise Refused(
                "too-large",
                f"accessor {index}: {count} elements without data, more "
                f"than {limits.MAX_ZEROS}: write them out",
            )
        else:
            values = array(code, [0]) * (count * columns)
        if "sparse" in accessor:
            where = f"accessor {index}: sparse data"
            self._replace(values, columns, accessor["sparse"], where)
        return values.tobytes(), code, row

    def _rows(
        self,
        owner: dict[str, Any],
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
            starts = range(0, len(data), stride)
            values.frombytes(b"".join(data[first : first + row] for first in starts))
        return values

    def _range(
        self, owner: dict[str, Any], what: str, count: int, row: int, view: memoryview | None = None
    ) -> tuple[memoryview, int]:
        """The bytes from the first to the last element, and those from one to the next. row: bytes
        of an element. view: as of `_rows`."""
        number = integer(owner, "bufferView", 0)
        view = self._views.view(number) if view is None else view
        stride = self._views.stride(number, row)
        start = integer(owner, "byteOffset", 0)
        needed = start + (count - 1) * stride + row if count else start
        if needed > len(view):
            raise Refused(
                "index-out-of-range",
                f"{what} exceeds its buffer view {number}: "
                f"{count} elements need {needed} bytes, it has {len(view)}",
            )
        return view[start:needed], stride

    def _replace(self, values: array[Any], columns: int, sparse: Any, where: str) -> None:
        """Overwrites the elements that sparse data list."""
        given = sparse if isinstance(sparse, dict) else {}
        places, rows = (member([given.get(key)], 0, where) for key in ("indices", "values"))
        code = self._type(places)
        if code not in _UNSIGNED:
            raise Refused("bad-record", f"{where}: indices are not unsigned")
        count = integer(sparse, "count", 0)
        elements = self._rows(places, where, count, 1, code)
        if count and max(elements) * columns >= len(values):
            raise Refused("index-out-of-range", f"{where}: element {max(elements)} does not exist")
        replaced = self._rows(rows, where, count, columns, values.typecode)
        for k, element in enumerate(elements):
            start = element * columns
            values[start : start + columns] = replaced[k * columns : (k + 1) * columns]
