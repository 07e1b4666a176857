"""Makes a Scene from meshes in memory, as if each had been read from a file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck import core
from satcheck.core.errors import SatcheckError
from satcheck.core.mesh_arrays import (
    MeshLike,
    arrays_of,
    numbers,
    refused,
    require_finite,
    require_usable,
)
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body, MeshFile, Scene
from satcheck.scene.document import NumberFormat, RawMesh
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import File
from satcheck.scene.inspect import STEPS, errors_of, mesh_file

if TYPE_CHECKING:
    import numpy as np
    import trimesh
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[Any]

# Entries of a rotation stored as float32 are off by up to 2**-24. A product of about thirty such
# rotations is off by less than this. The pose itself is applied as given.
RIGID_TOLERANCE = 1e-5
INDICES = ("<i4", "<i8", "<u4")  # what the core takes
NUMBER_FORMATS: dict[int, NumberFormat] = {2: "float16", 4: "float32"}  # by size in bytes


class Mesh:
    """A mesh that is prepared once and checked often, anywhere. Checks keep what they derive from
    it, such as its hull and its trees, for all later checks. It never changes.

    `Mesh(vertices, faces)` takes arrays as `satcheck.check_meshes` does, `Mesh.of` an object with
    vertices and faces, such as a trimesh.Trimesh, and `Mesh.read` a file. All functions that take
    meshes take it. vertices and faces: as a check sees them, equal vertices merged, wound outward.

    Raises SatcheckError as `satcheck.check_meshes` does.
    """

    __slots__ = ("_file",)

    def __init__(self, vertices: ArrayLike, faces: ArrayLike | None = None) -> None:
        if faces is None:
            hint = "Mesh.of takes an object with both, such as a trimesh.Trimesh; Mesh.read a file"
            raise SatcheckError("bad-argument", f"Mesh: vertices and faces, not one value: {hint}")
        try:
            self._file = replace(_mesh_file("mesh", *arrays_of((vertices, faces))), prepared={})
        except Refused as error:
            raise SatcheckError(error.code, error.message) from error.__cause__

    @classmethod
    def of(cls, mesh: MeshLike) -> Mesh:
        """Return the mesh of an object with vertices and faces, such as a trimesh.Trimesh. A Mesh
        is returned as it is. Raises SatcheckError."""
        return mesh if isinstance(mesh, Mesh) else cls(*arrays_of(mesh))

    @classmethod
    def read(cls, path: str | Path) -> Mesh:
        """Return all meshes of a file as one, in the units of the file. Raises what reading a file
        raises."""
        from satcheck.scene.loader import load_scene

        scene = load_scene([path], split="none", hashed=False)
        for lost in scene.unreadable:
            raise SatcheckError(lost.issue.code, lost.issue.message)
        if len(scene.bodies) != 1 or scene.composed:
            raise refused(f"path: a mesh file, got {path}: satcheck.load_scene reads scenes")
        made = cls.__new__(cls)
        made._file = replace(scene.bodies[0].file, prepared={})
        return made

    @property
    def vertices(self) -> NDArray[np.float64]:
        return self._file.mesh.vertices

    @property
    def faces(self) -> NDArray[np.uint32]:
        return self._file.mesh.triangles

    def named(self, id_: str) -> MeshFile:
        """Return the mesh as the file of the body of this id."""
        issues = tuple(replace(each, file=id_) for each in self._file.issues)
        return replace(self._file, path=id_, issues=issues)


def scene_of_meshes(
    meshes: Mapping[str, MeshLike] | trimesh.Scene,
    poses: Mapping[str, ArrayLike | None] | None = None,
) -> Scene:
    """A scene of meshes in memory, for `satcheck.check`.

    meshes: id -> mesh, as in `satcheck.check_meshes`; or a trimesh.Scene, whose nodes are the
    bodies where it places them. poses: id -> rigid 4x4 matrix for column vectors; without one the
    vertices are world coordinates. Raises SatcheckError as `satcheck.check_meshes` does.
    """
    if not isinstance(meshes, Mapping):
        meshes, placed = _nodes_of(meshes)
        poses = placed | dict(poses or {})
    poses = poses or {}
    for id_ in meshes:
        if not isinstance(id_, str):
            raise refused(f"meshes: an id is a text, got {id_!r}")
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


def _nodes_of(scene: trimesh.Scene) -> tuple[dict[str, MeshLike], dict[str, ArrayLike | None]]:
    """Return the meshes of the nodes of a scene, and their poses."""
    if not (hasattr(scene, "graph") and hasattr(scene, "geometry")):
        kind = type(scene).__name__
        hint = "{'a': mesh, 'b': mesh}; satcheck.check_meshes takes two meshes alone"
        raise refused(f"meshes: a mapping or a trimesh.Scene, got {kind}: give {hint}")
    placed = {str(node): scene.graph[node] for node in scene.graph.nodes_geometry}
    meshes: dict[str, MeshLike] = {id_: scene.geometry[name] for id_, (_, name) in placed.items()}
    return meshes, {id_: matrix for id_, (matrix, _) in placed.items()}


def _body(id_: str, mesh: MeshLike, pose: ArrayLike | None) -> Body:
    try:
        file = mesh.named(id_) if isinstance(mesh, Mesh) else _mesh_file(id_, *arrays_of(mesh))
        if pose is None:
            transform = None
        else:
            matrix = numbers(pose, "pose")
            transform = _transform(matrix)
            file = replace(file, placement_step=STEPS[_number_format(matrix)])
    except Refused as error:
        raise SatcheckError(error.code, error.message, body=id_) from error.__cause__
    except SatcheckError as error:
        raise SatcheckError(error.code, error.message, body=id_) from None
    return Body(id_, id_, file, transform)


def _mesh_file(id_: str, vertices: Array, faces: Array) -> MeshFile:
    indices = faces.astype(faces.dtype if faces.dtype.str in INDICES else "<i8", "C", copy=False)
    raw = RawMesh(b"", b"", _number_format(vertices))
    try:
        with errors_of(id_):
            mesh = core.Mesh(vertices.astype("<f8", "C", copy=False), indices)
            return mesh_file(File("memory", "", "", b"", path=id_), raw, mesh)
    except Refused as error:
        lost = error
    require_usable(vertices, faces)  # which row is wrong
    raise lost


def _number_format(values: Array) -> NumberFormat:
    if values.dtype.kind != "f":
        return "float64"
    return NUMBER_FORMATS.get(values.dtype.itemsize, "float64")


def _transform(matrix: Array) -> Transform | None:
    """The entries by rows; None: the identity."""
    if matrix.shape != (4, 4):
        raise refused(f"pose: a 4x4 matrix, got shape {matrix.shape}")
    require_finite(matrix, "pose")
    entries = tuple(map(float, matrix.ravel().tolist()))
    if entries[12:] != (0.0, 0.0, 0.0, 1.0):
        row = ", ".join(f"{entry:g}" for entry in entries[12:])
        hint = " (is it transposed?)" if entries[3::4] == (0.0, 0.0, 0.0, 1.0) else ""
        raise refused(f"pose: the last row is ({row}), not (0, 0, 0, 1){hint}")
    _require_rigid([entries[axis:12:4] for axis in range(3)])
    return None if entries == IDENTITY else entries


def _require_rigid(axes: Sequence[tuple[float, ...]]) -> None:
    """axes: the columns of the rotation."""
    lengths = [math.hypot(*axis) for axis in axes]
    unit = [[x / (length or 1.0) for x in axis] for axis, length in zip(axes, lengths, strict=True)]
    if any(abs(sum(map(mul, u, v))) > RIGID_TOLERANCE for u, v in combinations(unit, 2)):
        raise refused("pose: not rigid: it shears: its axes are not at right angles")
    if any(abs(length - 1.0) > RIGID_TOLERANCE for length in lengths):
        factors = ", ".join(f"{length:.6g}" for length in lengths)
        raise refused(f"pose: not rigid: it scales by ({factors}); scale the vertices instead")
    (a, b, c), (d, e, f), (g, h, i) = axes
    if a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g) < 0:
        raise refused("pose: not rigid: it mirrors")
