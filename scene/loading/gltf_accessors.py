"""Typed arrays of glTF: accessors, dense and sparse, each range checked."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.gltf_buffers import BufferViews, integer, items, member

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

_COMPONENTS = {
    number: np.dtype(name)
    for number, name in (
        *((5120, "<i1"), (5121, "<u1"), (5122, "<i2"), (5123, "<u2")),
        *((5125, "<u4"), (5126, "<f4")),
    )
}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

# (name, type) -> the rows of that vertex attribute; None if there is none.
Columns = Callable[[str, str], Floats | None]


class Accessors:
    """Typed arrays of a glTF document."""

    def __init__(self, document: dict[str, Any], views: BufferViews) -> None:
        self._accessors = items(document, "accessors")
        self._views = views

    def positions(self, index: int) -> Floats:
        """x, y, z of each vertex (n, 3), all finite."""
        if self._type(member(self._accessors, index, "accessor")) == np.uint32:
            raise MeshFileError("bad-record", f"accessor {index}: positions of type uint32")
        return self.numbers(index, "VEC3", "coordinates")

    def numbers(self, index: int, kind: str, what: str = "numbers") -> Floats:
        """The rows of a type such as VEC4, all finite."""
        values = self._read(index, kind)
        if not np.isfinite(values).all():
            raise MeshFileError("non-finite", f"accessor {index}: non-finite {what}")
        return normalized(values, self.largest_integer(index))

    def indices(self, index: int) -> Indices:
        """Vertex numbers (n,)."""
        values = self._read(index, "SCALAR")
        if values.dtype.kind != "u":
            raise MeshFileError("bad-record", f"accessor {index}: indices are not unsigned")
        return values.ravel().astype(np.uint32)

    def columns(self, attributes: dict[str, Any]) -> Columns:
        """attributes: numbers of accessors by name."""

        def rows(name: str, kind: str) -> Floats | None:
            return self.numbers(integer(attributes, name, -1), kind) if name in attributes else None

        return rows

    def has_data(self, index: int) -> bool:
        accessor = member(self._accessors, index, "accessor")
        return "bufferView" in accessor or "sparse" in accessor

    def largest_integer(self, index: int) -> int | None:
        """The integer that stands for 1.0; None where integers stand for themselves."""
        accessor = member(self._accessors, index, "accessor")
        dtype = self._type(accessor)
        if accessor.get("normalized") is not True or dtype is None or dtype.itemsize == 4:
            return None
        return int(np.iinfo(dtype).max)

    def bytes_of_view(self, number: int) -> bytes:
        return bytes(self._views.view(number))

    @staticmethod
    def _type(owner: dict[str, Any]) -> np.dtype[Any] | None:
        return _COMPONENTS.get(integer(owner, "componentType", 0))

    def _read(self, index: int, kind: str) -> NDArray[Any]:
        """(count, columns), of the type that the file has."""
        accessor = member(self._accessors, index, "accessor")
        dtype = self._type(accessor)
        if dtype is None or accessor.get("type") != kind:
            raise MeshFileError("bad-record", f"accessor {index}: {kind} expected")
        shape = integer(accessor, "count", 0), _COLUMNS[kind]
        if "bufferView" in accessor:
            values = self._rows(accessor, f"accessor {index}", shape, dtype)
        elif shape[0] > limits.MAX_ZEROS:
            raise MeshFileError("too-large", f"accessor {index}: {shape[0]} elements without data")
        else:
            values = np.zeros(shape, dtype)
        if "sparse" not in accessor:
            return values
        return self._replaced(values, accessor["sparse"], f"accessor {index}: sparse data")

    def _rows(
        self, owner: dict[str, Any], what: str, shape: tuple[int, int], dtype: np.dtype[Any]
    ) -> NDArray[Any]:
        """The elements where the owner says that they lie; not to be written to."""
        number = integer(owner, "bufferView", 0)
        count, row = shape[0], shape[1] * dtype.itemsize
        view, stride = self._views.view(number), self._views.stride(number, row)
        start = integer(owner, "byteOffset", 0)
        needed = start + (count - 1) * stride + row if count else start
        if needed > len(view):
            raise MeshFileError(
                "index-out-of-range",
                f"{what} exceeds its buffer view {number}: "
                f"{count} elements need {needed} bytes, it has {len(view)}",
            )
        if not count:
            return np.empty(shape, dtype)
        return np.ndarray(shape, dtype, view, start, (stride, dtype.itemsize))

    def _replaced(self, values: NDArray[Any], sparse: Any, where: str) -> NDArray[Any]:
        """The values with the elements that sparse data list."""
        given = sparse if isinstance(sparse, dict) else {}
        places, rows = (member([given.get(key)], 0, where) for key in ("indices", "values"))
        dtype = self._type(places)
        if dtype is None or dtype.kind != "u":
            raise MeshFileError("bad-record", f"{where}: indices are not unsigned")
        count = integer(sparse, "count", 0)
        elements = self._rows(places, where, (count, 1), dtype).ravel()
        if count and elements.max() >= len(values):
            raise MeshFileError(
                "index-out-of-range", f"{where}: element {elements.max()} does not exist"
            )
        changed = values.copy()
        changed[elements] = self._rows(rows, where, (count, values.shape[1]), values.dtype)
        return changed


def normalized(values: NDArray[Any], largest: int | None) -> Floats:
    """largest: the integer that stands for 1.0."""
    real = values.astype(np.float64)
    return real if largest is None else np.maximum(real / largest, -1.0)
