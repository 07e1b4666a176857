"""Makes a Scene from meshes in memory, as if each had been read from a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body, MeshFile, Scene
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import mesh_file
from satcheck.scene.loading.raw_mesh import NumberFormat, RawMesh
from satcheck.scene.loading.source import Source
from satcheck.scene.resolution import STEPS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[Any]

# Entries of a rotation stored as float32 are off by up to 2**-24. A product of about thirty such
# rotations is off by less than this. The pose itself is applied as given.
RIGID_TOLERANCE = 1e-5
LARGEST_INTEGER = 2**53  # float64 holds all integers up to this
NUMBER_FORMATS: dict[int, NumberFormat] = {2: "float16", 4: "float32"}  # by size in bytes


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


def scene_of_meshes(
    meshes: Mapping[str, MeshLike],
    poses: Mapping[str, ArrayLike | None] | None = None,
) -> Scene:
    """A scene of meshes in memory, for `satcheck.check`.

    meshes: id -> mesh, as in `satcheck.check_meshes`. poses: id -> rigid 4x4 matrix for column
    vectors; without one the vertices are world coordinates. Raises SatcheckError as
    `satcheck.check_meshes` does.
    """
    poses = poses or {}
    if unknown := sorted(poses.keys() - meshes.keys()):
        raise SatcheckError("bad-argument", f"poses: no mesh has the id {unknown[0]!r}")
    bodies = tuple(_body(id_, mesh, poses.get(id_)) for id_, mesh in meshes.items())
    return Scene(
        name=" ".join(meshes),
        units=None,
        bodies=bodies,
        issues=tuple(issue for body in bodies for issue in body.file.issues),
        order=tuple(meshes),
    )


def _body(id_: str, mesh: MeshLike, pose: ArrayLike | None) -> Body:
    try:
        vertices, faces = _arrays(mesh)
        file = _mesh_file(id_, vertices, faces)
        if pose is None:
            transform = None
        else:
            matrix = _numbers(pose, "pose")
            transform = _transform(matrix)
            file = replace(file, placement_step=STEPS[_number_format(matrix)])
    except MeshFileError as error:
        raise SatcheckError(error.code, error.message, body=id_) from error.__cause__
    except SatcheckError as error:
        raise SatcheckError(error.code, error.message, body=id_) from None
    return Body(id_, id_, file, transform)


def _mesh_file(id_: str, vertices: Array, faces: Array) -> MeshFile:
    raw = RawMesh(
        vertices.astype("<f8", order="C", copy=False).data.cast("B"),
        faces.astype("<u4", order="C", copy=False).data.cast("B"),
        _number_format(vertices),
    )
    return mesh_file(Source(id_, Path(id_), "memory", None, 0, b""), raw)


def _arrays(mesh: MeshLike) -> tuple[Array, Array]:
    """(vertices, faces), not checked."""
    vertices: ArrayLike | None
    faces: ArrayLike | None
    if isinstance(mesh, tuple | list) and len(mesh) == 2:
        vertices, faces = mesh
    else:
        vertices = getattr(mesh, "vertices", None)
        faces = getattr(mesh, "faces", getattr(mesh, "triangles", None))
    if vertices is None or faces is None:
        hint = " (satcheck.check takes paths)" if isinstance(mesh, str | Path) else ""
        wanted = "an object with vertices and faces, or a pair (vertices, faces)"
        raise _refused(f"{wanted}, got {type(mesh).__name__}{hint}")
    return _checked(_numbers(vertices, "vertices"), _integers(faces, "faces"))


def _checked(vertices: Array, faces: Array) -> tuple[Array, Array]:
    _require_rows(vertices, "vertices", "three numbers")
    _require_rows(faces, "faces", "three integers")
    _require_finite(vertices, "vertices")
    outside = (faces < 0) | (faces >= len(vertices))
    if outside.any():
        row = int(outside.any(axis=1).argmax())
        index = faces[row][outside[row]][0]
        there_are = f"there are {len(vertices)} vertices, numbered from 0"
        raise _refused(f"faces: row {row} has the index {index}: {there_are}")
    return vertices, faces


def _require_rows(values: Array, name: str, what: str) -> None:
    if values.size == 0:
        raise _refused(f"{name}: empty")
    if values.ndim != 2 or values.shape[1] != 3:
        raise _refused(f"{name}: {what} a row, got shape {values.shape}")


def _require_finite(values: Array, name: str) -> None:
    import numpy as np

    finite = np.isfinite(values)
    if not finite.all():
        row = int((~finite).any(axis=1).argmax())
        raise _refused(f"{name}: row {row} is not finite: {values[row].tolist()}")


def _numbers(values: ArrayLike, name: str) -> Array:
    array = _array(values, name)
    if array.dtype.kind not in "iuf" and array.size:
        raise _refused(f"{name}: integers or floats, got {array.dtype}")
    if array.dtype.kind in "iu" and array.size:
        largest = max(int(array.max()), -int(array.min()))
        if largest > LARGEST_INTEGER:
            raise _refused(f"{name}: integers up to 2**53, which float64 holds, got {largest}")
    return array


def _integers(values: ArrayLike, name: str) -> Array:
    array = _array(values, name)
    if array.dtype.kind not in "iu" and array.size:
        raise _refused(f"{name}: integers, got {array.dtype}")
    return array


def _array(values: ArrayLike, name: str) -> Array:
    import numpy as np

    try:
        return np.asarray(values)
    except (TypeError, ValueError) as error:  # rows of several lengths
        reason = str(error).split(". ")[0]
        raise _refused(f"{name}: not an array of numbers: {reason}") from None


def _number_format(values: Array) -> NumberFormat:
    if values.dtype.kind != "f":
        return "float64"
    return NUMBER_FORMATS.get(values.dtype.itemsize, "float64")


def _transform(matrix: Array) -> Transform | None:
    """The entries by rows; None: the identity."""
    if matrix.shape != (4, 4):
        raise _refused(f"pose: a 4x4 matrix, got shape {matrix.shape}")
    _require_finite(matrix, "pose")
    entries = tuple(map(float, matrix.ravel()))
    if entries[12:] != (0.0, 0.0, 0.0, 1.0):
        row = ", ".join(f"{entry:g}" for entry in entries[12:])
        hint = " (is it transposed?)" if entries[3::4] == (0.0, 0.0, 0.0, 1.0) else ""
        raise _refused(f"pose: the last row is ({row}), not (0, 0, 0, 1){hint}")
    _require_rigid(matrix[:3, :3].astype("<f8"))
    return None if entries == IDENTITY else entries


def _require_rigid(rotation: NDArray[np.float64]) -> None:
    import numpy as np

    lengths = np.linalg.norm(rotation, axis=0)
    unit = rotation / np.where(lengths > 0.0, lengths, 1.0)
    if np.abs(unit.T @ unit - np.diag(lengths > 0.0)).max() > RIGID_TOLERANCE:
        raise _refused("pose: not rigid: it shears: its axes are not at right angles")
    if np.abs(lengths - 1.0).max() > RIGID_TOLERANCE:
        factors = ", ".join(f"{length:.6g}" for length in lengths)
        raise _refused(f"pose: not rigid: it scales by ({factors}); scale the vertices instead")
    if np.linalg.det(rotation) < 0:
        raise _refused("pose: not rigid: it mirrors")


def _refused(message: str) -> SatcheckError:
    return SatcheckError("bad-argument", message)
