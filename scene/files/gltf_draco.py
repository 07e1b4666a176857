"""Primitives of glTF compressed with Draco (KHR_draco_mesh_compression), decoded by DracoPy.

Draco's decoder may crash on damaged data, so this runs only in the child process. Positions are
taken as decoded: the compression has rounded them and may have changed their order.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_buffers import Accessors
from satcheck.scene.files.gltf_document import NONE, Attributes, Draco
from satcheck.scene.inspect import FLOAT32_STEP

if TYPE_CHECKING:
    from satcheck.scene.files.gltf_buffers import Floats

FLOAT32_ROUNDING = FLOAT32_STEP / 2  # largest relative error of rounding to float32
_RECORD = 17  # bytes: the lowest corner, the size, the bits
_MOST_BITS = 30
_BLOCK = 1 << 20  # bytes that are searched at once


class Unpacked:
    """attributes: of the primitive. Raises Refused. triangles: vertex numbers, three each."""

    def __init__(self, accessors: Accessors, packed: Draco, attributes: Attributes) -> None:
        try:
            import DracoPy
        except ImportError:
            raise Refused(
                "unsupported-feature", "Draco data is read by DracoPy: pip install DracoPy"
            ) from None
        self._accessors = accessors
        self._attributes = attributes
        self._ids = packed.attributes
        self._data = bytes(accessors.view(packed.buffer_view))
        try:
            self._mesh: Any = DracoPy.decode(self._data)
        except (DracoPy.FileTypeException, ValueError, MemoryError) as error:
            raise Refused("bad-record", f"Draco data: {error}") from None
        if not isinstance(self._mesh, DracoPy.DracoMesh):
            raise Refused("bad-record", "Draco data: no mesh")
        faces, count = self._mesh.faces, len(self._mesh.points)
        if len(faces) and int(faces.max()) >= count:
            message = f"Draco data: index out of range: {faces.max()} of {count} vertices"
            raise Refused("index-out-of-range", message)
        self.triangles = memoryview(faces.astype("<u4").tobytes()).cast("I")

    def positions(self) -> Floats:
        positions = self._columns("POSITION", 3)
        if positions is None:
            raise Refused("bad-record", "Draco data: no positions")
        if not all(map(math.isfinite, positions)):
            raise Refused("non-finite", "Draco data: non-finite coordinates")
        return positions

    def rounding(self, positions: Floats) -> float:
        """How far the compression may have put a coordinate off: half the step of its integers,
        plus the rounding of the decoder to float32. positions: as decoded; 0.0: not as integers.
        """
        attribute = self._mesh.get_attribute_by_unique_id(self._ids["POSITION"])
        if attribute["data"].dtype.kind != "f":
            return 0.5 / (self._largest("POSITION") or 1)
        step = lattice_step(self._data, attribute["data"])
        if step == 0:
            return 0.0
        return 0.5 * step + max(map(abs, positions)) * FLOAT32_ROUNDING

    def columns(self, name: str, kind: str) -> Floats | None:
        """As Accessors.columns(). Attributes that Draco does not hold have an accessor of their
        own."""
        rows = self._columns(name, 4)
        return self._accessors.columns(self._attributes)(name, kind) if rows is None else rows

    def _columns(self, name: str, count: int) -> Floats | None:
        """An attribute that Draco holds. The accessor says how to normalize its integers."""
        id_ = self._ids.get(name)
        if id_ is None:
            return None
        attribute = self._mesh.get_attribute_by_unique_id(id_) if type(id_) is int else None
        data = None if attribute is None else attribute["data"]
        if data is None or data.ndim != 2 or data.shape[1] != count:
            raise Refused("bad-record", f"Draco data: no attribute {id_!r} for {name}")
        largest = None if data.dtype.kind == "f" else self._largest(name)
        numbers = data.astype(np.float64)
        if largest is not None:
            numbers = np.maximum(numbers / largest, -1.0)
        return memoryview(numbers.tobytes()).cast("d")

    def _largest(self, name: str) -> int | None:
        return self._accessors.largest_integer(self._attributes.get(name, NONE))


def lattice_step(data: bytes, points: NDArray[np.float32]) -> float:
    """The distance of neighbouring points of the lattice to which Draco rounded the points; 0.0 if
    it stores floats.

    The decoder does not tell it. The stream holds a record of the lattice: its lowest corner and
    its size (four float32), and the bits of a coordinate (a byte), at a place that only a decoder
    knows. So this tries all places for a lattice that has all points. Other bytes may pass for a
    lattice only if it is about as fine as float32, so the coarsest counts.
    """
    ends = np.stack([points.min(axis=0), points.max(axis=0)])
    steps = [0.0]
    for start in range(0, len(data) - _RECORD + 1, _BLOCK):
        bytes_ = np.frombuffer(data, np.uint8)[start : start + _BLOCK + _RECORD - 1]
        records = np.lib.stride_tricks.sliding_window_view(bytes_, _RECORD)
        bits = records[:, -1]
        records = records[(bits >= 1) & (bits <= _MOST_BITS)]
        numbers = np.ascontiguousarray(records[:, :-1]).view("<f4")
        with np.errstate(all="ignore"):  # most places hold no numbers
            fits = (numbers[:, :3] <= ends[0]).all(axis=1) & (numbers[:, 3] > 0)
            numbers, bits = numbers[fits], records[fits, -1].astype(np.float64)
            corners, sizes = numbers[:, :3], numbers[:, 3]
            spacings = sizes / (np.exp2(bits) - 1).astype(np.float32)
            fits = np.isfinite(numbers).all(axis=1)
            for end in ends:
                fits &= _are_on(end, corners, spacings[:, None]).all(axis=1)
            steps += [
                float(spacings[k])
                for k in np.flatnonzero(fits).tolist()
                if _are_on(points, corners[k], spacings[k]).all()
            ]
    return max(steps)


def _are_on(
    numbers: NDArray[np.float32], corners: NDArray[np.float32], spacings: Any
) -> NDArray[np.bool_]:
    """Whether the decoder makes each number of a multiple of the spacing and the corner. It rounds
    the product and the sum, or the sum alone where a processor multiplies and adds at once."""
    spacing = np.asarray(spacings, np.float64)
    multiples = np.round((numbers.astype(np.float64) - corners) / spacing)
    product = multiples * spacing
    at_once = numbers == (product + corners).astype(np.float32)
    in_turn = numbers == product.astype(np.float32) + corners
    on: NDArray[np.bool_] = (multiples >= 0) & (at_once | in_turn)
    return on
