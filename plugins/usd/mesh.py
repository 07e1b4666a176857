"""Meshes of USD as triangles: polygons of any number of corners, holes, both orientations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import UsdGeom

from satcheck.scene.document import NO_SURFACE, NumberFormat, RawMesh
from satcheck.scene.errors import Refused
from satcheck.scene.files.polygons import triangles_of

Ints = NDArray[np.int64]
Points = NDArray[np.floating[Any]]
_FORMATS: dict[str, NumberFormat] = {
    "float16": "float16",
    "float32": "float32",
    "float64": "float64",
}


def read_mesh(prim: Any, time: Any, unit: str) -> RawMesh:
    """The faces of a Mesh. Raises Refused; its code is `NO_SURFACE` if there are no faces."""
    mesh = UsdGeom.Mesh(prim)
    points = _points(mesh, time)
    corners = _ints(mesh.GetFaceVertexIndicesAttr(), time)
    lengths = _ints(mesh.GetFaceVertexCountsAttr(), time)
    if not len(lengths):
        raise Refused(NO_SURFACE, "the mesh has no faces")
    if lengths.min() < 0 or lengths.sum() != len(corners):
        raise Refused(
            "count-mismatch",
            f"{len(lengths)} faces promise {lengths.sum()} corners, there are {len(corners)}",
        )
    _refuse_indices(corners, len(points))
    corners, lengths, warnings = _solid_faces(
        corners, lengths, _ints(mesh.GetHoleIndicesAttr(), time)
    )
    triangles = _triangles(points, corners, lengths)
    return _raw(points, _outward(mesh, triangles, time), unit, warnings)


def read_tetrahedra(prim: Any, time: Any, unit: str) -> RawMesh:
    """The outer faces of a TetMesh. Raises Refused."""
    mesh = UsdGeom.TetMesh(prim)
    points = _points(mesh, time)
    faces = mesh.GetSurfaceFaceVertexIndicesAttr().Get(time)
    if not faces:
        tetrahedra = np.asarray(mesh.GetTetVertexIndicesAttr().Get(time) or (), np.int64)
        _refuse_indices(tetrahedra.ravel(), len(points))
        faces = UsdGeom.TetMesh.ComputeSurfaceFaces(mesh, time)
    if not faces:
        raise Refused(NO_SURFACE, "the mesh has no tetrahedra")
    triangles = np.asarray(faces, np.int64).reshape(-1, 3)
    _refuse_indices(triangles.ravel(), len(points))
    return _raw(points, _outward(mesh, triangles, time), unit, ())


def _points(mesh: Any, time: Any) -> Points:
    """In the precision of the file."""
    value = mesh.GetPointsAttr().Get(time)
    if not value:
        return np.zeros((0, 3))
    points = np.asarray(value)
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.name not in _FORMATS:
        raise Refused("bad-record", "the points are no list of x, y, z")
    if not np.isfinite(points).all():
        raise Refused("non-finite", "non-finite coordinates")
    return points


def _ints(attribute: Any, time: Any) -> Ints:
    values = np.asarray(attribute.Get(time) or ())
    if len(values) and (values.ndim != 1 or values.dtype.kind != "i"):
        raise Refused("bad-record", f"{attribute.GetName()} is no list of integers")
    return values.astype(np.int64)


def _refuse_indices(corners: Ints, count: int) -> None:
    if len(corners) and not 0 <= corners.min() <= corners.max() < count:
        worst = corners.min() if corners.min() < 0 else corners.max()
        raise Refused("index-out-of-range", f"index out of range: {worst} of {count} points")


def _solid_faces(
    corners: Ints, lengths: Ints, holes: Ints
) -> tuple[Ints, Ints, tuple[tuple[str, str], ...]]:
    """The faces that are no holes and have three corners or more, and a warning for the others."""
    _refuse_indices(holes, len(lengths))
    short = lengths < 3
    left_out = short.copy()
    left_out[holes] = True
    if not left_out.any():
        return corners, lengths, ()
    warnings = []
    if short.any():
        message = f"{short.sum()} faces with fewer than 3 corners are ignored"
        warnings.append(("short-face", message))
    corners, lengths = corners[np.repeat(~left_out, lengths)], lengths[~left_out]
    if not len(lengths):
        raise Refused(NO_SURFACE, "the mesh has no faces")
    return corners, lengths, tuple(warnings)


def _triangles(points: Points, corners: Ints, lengths: Ints) -> Ints:
    if (lengths == 3).all():
        return corners.reshape(-1, 3)
    return triangles_of(points, corners, lengths)


def _outward(mesh: Any, triangles: Ints, time: Any) -> Ints:
    left = mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded
    return triangles[:, ::-1] if left else triangles


def _raw(
    points: Points,
    triangles: Ints,
    unit: str,
    warnings: tuple[tuple[str, str], ...],
) -> RawMesh:
    return RawMesh(
        vertices=points.astype("<f8").tobytes(),
        triangles=triangles.astype("<u4").tobytes(),
        number_format=_FORMATS[points.dtype.name],
        units=unit,
        warnings=warnings,
    )
