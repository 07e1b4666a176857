"""Moves the points of skinned meshes as their skeleton and its animation do.

A mesh that is bound to a skeleton is drawn where the joints stand, not where its points are stored.
UsdSkel computes both blend shapes and joints; its points are in the space of the skeleton.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from msgspec.structs import replace
from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

from satcheck.scene.document import RawMesh
from satcheck.scene.errors import Refused


class Skinning:
    """time: a Usd.TimeCode."""

    def __init__(self, time: Any) -> None:
        self._time = time
        self._skeletons = UsdSkel.Cache()
        self._populated: set[Any] = set()
        self._places = UsdGeom.XformCache(time)

    def is_bound(self, prim: Any) -> bool:
        """Whether joints or blend shapes move the points of the mesh."""
        query = self._query(prim)
        return bool(query) and (query.HasJointInfluences() or query.HasBlendShapes())

    def moved(self, prim: Any, mesh: RawMesh) -> RawMesh:
        """The mesh with the points that the skeleton gives it. Raises Refused."""
        query, skeleton = self._query(prim), UsdSkel.BindingAPI(prim).GetInheritedSkeleton()
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
