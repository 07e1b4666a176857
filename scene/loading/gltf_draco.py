"""Primitives of glTF compressed with Draco (KHR_draco_mesh_compression), decoded by DracoPy.

Draco's decoder may crash on damaged data, so this runs only in the child process. Positions are
taken as decoded: the compression has rounded them and may have changed their order.
"""

from __future__ import annotations

import math
from array import array
from typing import Any

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.gltf_accessors import Accessors, normalized
from satcheck.scene.loading.gltf_buffers import integer


class Unpacked:
    """packed: the data of the extension. attributes: accessors of the primitive by name.

    Raises MeshFileError. triangles: vertex numbers, three each.
    """

    def __init__(
        self, accessors: Accessors, packed: dict[str, Any], attributes: dict[str, Any]
    ) -> None:
        try:
            import DracoPy
        except ImportError:
            raise MeshFileError(
                "unsupported-feature", "Draco data is read by DracoPy: pip install DracoPy"
            ) from None
        self._accessors = accessors
        self._attributes = attributes
        ids = packed.get("attributes")
        data = accessors.bytes_of_view(integer(packed, "bufferView", -1))
        try:
            self._mesh: Any = DracoPy.decode(data)
        except (DracoPy.FileTypeException, ValueError, MemoryError) as error:
            raise MeshFileError("bad-record", f"Draco data: {error}") from None
        if not isinstance(self._mesh, DracoPy.DracoMesh) or not isinstance(ids, dict):
            raise MeshFileError("bad-record", "Draco data: no mesh")
        self._ids: dict[str, Any] = ids
        faces, count = self._mesh.faces, len(self._mesh.points)
        if len(faces) and int(faces.max()) >= count:
            raise MeshFileError(
                "index-out-of-range",
                f"Draco data: index out of range: {faces.max()} of {count} vertices",
            )
        self.triangles = array("I", faces.astype("<u4").tobytes())

    def positions(self) -> array[float]:
        positions = self._columns("POSITION", 3)
        if positions is None:
            raise MeshFileError("bad-record", "Draco data: no positions")
        if not all(map(math.isfinite, positions)):
            raise MeshFileError("non-finite", "Draco data: non-finite coordinates")
        return positions

    def columns(self, name: str, kind: str) -> array[float] | None:
        """As Accessors.columns(). Attributes that Draco does not hold have an accessor of their
        own."""
        rows = self._columns(name, 4)
        return self._accessors.columns(self._attributes)(name, kind) if rows is None else rows

    def _columns(self, name: str, count: int) -> array[float] | None:
        """An attribute that Draco holds. The accessor says how to normalize its integers."""
        id_ = self._ids.get(name)
        if id_ is None:
            return None
        attribute = self._mesh.get_attribute_by_unique_id(id_) if type(id_) is int else None
        data = None if attribute is None else attribute["data"]
        if data is None or data.ndim != 2 or data.shape[1] != count:
            raise MeshFileError("bad-record", f"Draco data: no attribute {id_!r} for {name}")
        largest = self._accessors.largest_integer(integer(self._attributes, name, -1))
        return normalized(data.ravel().tolist(), None if data.dtype.kind == "f" else largest)
