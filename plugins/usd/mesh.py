"""Meshes of USD as triangles: polygons of any number of corners, holes, both orientations, and
meshes that a skeleton moves."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

from satcheck.scene.document import NO_SURFACE, NumberFormat, RawMesh
from satcheck.scene.errors import Refused
from satcheck.scene.files.polygons import triangles_of

Ints = NDArray[np.int64]
Points = NDArray[np.floating[Any]]
_FORMATS = get_args(NumberFormat)


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
    triangles = triangles_of(points, corners, lengths)
    return _raw(mesh, time, points, triangles, unit, warnings)


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
    return _raw(mesh, time, points, triangles, unit)


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


def _raw(
    mesh: Any,
    time: Any,
    points: Points,
    triangles: Ints,
    unit: str,
    warnings: tuple[tuple[str, str], ...] = (),
) -> RawMesh:
    left = mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded
    return RawMesh(
        vertices=points.astype("<f8").tobytes(),
        triangles=(triangles[:, ::-1] if left else triangles).astype("<u4").tobytes(),
        number_format=points.dtype.name,  # type: ignore[arg-type]  # one of _FORMATS
        units=unit,
        warnings=warnings,
    )


class Skinning:
    """Moves the points of skinned meshes as their skeleton and its animation do.

    A mesh that is bound to a skeleton is drawn where the joints stand, not where its points are
    stored. UsdSkel computes both blend shapes and joints; its points are in the space of the
    skeleton. time: a Usd.TimeCode.
    """

    def __init__(self, time: Any) -> None:
        self._time = time
        self._skeletons = UsdSkel.Cache()
        self._populated: set[Any] = set()
        self._places = UsdGeom.XformCache(time)

    def moved(self, prim: Any, mesh: RawMesh) -> RawMesh | None:
        """The mesh with the points that the skeleton gives it; None: neither joints nor blend
        shapes move it. Raises Refused."""
        query = self._query(prim)
        if not query or not (query.HasJointInfluences() or query.HasBlendShapes()):
            return None
        skeleton = UsdSkel.BindingAPI(prim).GetInheritedSkeleton()
        joints = self._skeletons.GetSkelQuery(skeleton) if skeleton else None
        if not joints:
            return mesh
        points = Vt.Vec3fArray.FromNumpy(
            np.frombuffer(mesh.vertices, "<f8").reshape(-1, 3).astype("<f4")
        )
        self._blend(prim, query, joints, points)
        if query.HasJointInfluences():
            self._bend(prim, query, joints, points)
        moved = np.array(points, "<f8").reshape(-1, 3)
        if not np.isfinite(moved).all():
            raise Refused("non-finite", "its skeleton gives it coordinates that are none")
        return replace(mesh, vertices=moved.astype("<f8").tobytes(), number_format="float32")

    def _query(self, prim: Any) -> Any:
        root = UsdSkel.Root.Find(prim)
        if not root:
            return None
        if root.GetPrim() not in self._populated:
            self._skeletons.Populate(root, Usd.TraverseInstanceProxies())
            self._populated.add(root.GetPrim())
        return self._skeletons.GetSkinningQuery(prim)

    def _blend(self, prim: Any, query: Any, joints: Any, points: Any) -> None:
        animation = joints.GetAnimQuery()
        if not query.HasBlendShapes() or not animation:
            return
        weights = animation.ComputeBlendShapeWeights(self._time)
        mapper = query.GetBlendShapeMapper()
        if weights and mapper:
            weights = mapper.Remap(weights)
        if not weights:
            return
        shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(prim))
        shape_weights, shape_numbers, sub_numbers = shapes.ComputeSubShapeWeights(weights)
        moved = shapes.ComputeDeformedPoints(
            shape_weights,
            shape_numbers,
            sub_numbers,
            shapes.ComputeBlendShapePointIndices(),
            shapes.ComputeSubShapePointOffsets(),
            points,
        )
        if not moved:
            raise Refused("bad-record", "its blend shapes do not fit its points")

    def _bend(self, prim: Any, query: Any, joints: Any, points: Any) -> None:
        turns = joints.ComputeSkinningTransforms(self._time)
        mapper = query.GetJointMapper()
        if turns and mapper:
            turns = mapper.RemapTransforms(turns, Vt.Matrix4dArray())
        if not turns or not query.ComputeSkinnedPoints(turns, points, self._time):
            raise Refused("bad-record", "its skeleton does not fit its points")
        here = self._places.GetLocalToWorldTransform(prim)
        there = self._places.GetLocalToWorldTransform(joints.GetPrim())
        back = there * here.GetInverse()
        if back != Gf.Matrix4d(1.0):
            for number, point in enumerate(points):
                points[number] = Gf.Vec3f(back.Transform(Gf.Vec3d(point)))
