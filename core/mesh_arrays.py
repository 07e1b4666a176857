"""Meshes of other libraries as arrays: what counts as one, and what is refused."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from satcheck._native.core import Mesh
from satcheck.core.errors import SatcheckError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[Any]

LARGEST_INTEGER = 2**53  # float64 holds all integers up to this


class FacesMesh(Protocol):
    """For example trimesh.Trimesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class TrianglesMesh(Protocol):
    """For example open3d.geometry.TriangleMesh and satcheck.core.Mesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def triangles(self) -> Any: ...


MeshLike: TypeAlias = "FacesMesh | TrianglesMesh | tuple[ArrayLike, ArrayLike]"


def arrays_of(mesh: MeshLike) -> tuple[Array, Array]:
    """Return (vertices, faces) as arrays of rows of three. Raises SatcheckError `bad-argument` for
    arrays of another form."""
    vertices: ArrayLike | None
    faces: ArrayLike | None
    if isinstance(mesh, tuple | list) and len(mesh) == 2 and not hasattr(mesh[0], "vertices"):
        vertices, faces = mesh
    else:
        vertices = getattr(mesh, "vertices", None)
        faces = getattr(mesh, "faces", getattr(mesh, "triangles", None))
    if vertices is None or faces is None:
        hint = ""
        if isinstance(mesh, str | Path):
            hint = " (satcheck.check takes paths, satcheck.Mesh.read one)"
        if isinstance(mesh, tuple | list):
            hint = " (satcheck.scene_of_meshes takes several meshes, by name)"
        if hasattr(mesh, "geometry"):  # a trimesh.Scene
            hint = " (satcheck.scene_of_meshes takes a scene; its to_mesh() is one mesh)"
        wanted = "an object with vertices and faces, or a pair (vertices, faces)"
        raise refused(f"{wanted}, got {type(mesh).__name__}{hint}")
    points, rows = numbers(vertices, "vertices"), _integers(faces, "faces")
    _require_rows(points, "vertices", "three numbers")
    _require_rows(rows, "faces", "three integers")
    return points, rows


def require_usable(vertices: Array, faces: Array) -> None:
    """Raise SatcheckError `bad-argument` for indices out of range, and for coordinates that are not
    finite."""
    require_finite(vertices, "vertices")
    if faces.min() < 0 or faces.max() >= len(vertices):
        outside = (faces < 0) | (faces >= len(vertices))
        row = int(outside.any(axis=1).argmax())
        index = faces[row][outside[row]][0]
        there_are = f"there are {len(vertices)} vertices, numbered from 0"
        raise refused(f"faces: row {row} has the index {index}: {there_are}")


def _require_rows(values: Array, name: str, what: str) -> None:
    if values.size == 0:
        raise refused(f"{name}: empty")
    if values.ndim != 2 or values.shape[1] != 3:
        raise refused(f"{name}: {what} a row, got shape {values.shape}")


def require_finite(values: Array, name: str) -> None:
    """Raise SatcheckError if a row of the array is not finite."""
    import numpy as np

    finite = np.isfinite(values)
    if not finite.all():
        row = int((~finite).any(axis=1).argmax())
        raise refused(f"{name}: row {row} is not finite: {values[row].tolist()}")


def numbers(values: ArrayLike, name: str) -> Array:
    """Return an array of numbers that float64 holds exactly. Raises SatcheckError."""
    array = _array(values, name)
    if array.dtype.kind not in "iuf" and array.size:
        raise refused(f"{name}: integers or floats, got {array.dtype}")
    if array.dtype.kind in "iu" and array.size:
        largest = max(int(array.max()), -int(array.min()))
        if largest > LARGEST_INTEGER:
            raise refused(f"{name}: integers up to 2**53, which float64 holds, got {largest}")
    return array


def _integers(values: ArrayLike, name: str) -> Array:
    array = _array(values, name)
    if array.dtype.kind not in "iu" and array.size:
        raise refused(f"{name}: integers, got {array.dtype}")
    return array


def _array(values: ArrayLike, name: str) -> Array:
    import numpy as np

    rows = values if isinstance(values, list | tuple) else ()
    if np.ma.is_masked(values) or any(map(np.ma.is_masked, rows)):
        raise refused(f"{name}: masked values are no numbers: fill them, or leave their rows out")
    try:
        return np.asarray(values)
    except (TypeError, ValueError) as error:  # rows of several lengths
        reason = str(error).split(". ")[0]
        raise refused(f"{name}: not an array of numbers: {reason}") from None


def refused(message: str) -> SatcheckError:
    """Return the error to be raised."""
    return SatcheckError("bad-argument", message)


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """All as one."""
    import numpy as np

    listed = list(meshes)
    firsts = np.cumsum([0, *(mesh.vertex_count for mesh in listed)])
    corners = [np.asarray(m.triangles) + first for m, first in zip(listed, firsts, strict=False)]
    points = [np.asarray(mesh.vertices) for mesh in listed]
    return Mesh(np.concatenate(points), np.concatenate(corners).astype(np.uint32))
