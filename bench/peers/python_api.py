"""Convex shapes and placed pairs in the Python interfaces of other libraries.

Each class takes shapes and PAIR rows (bench.convex_pairs) and makes what a caller would keep: the
shapes, and where the interface has such things the placements. overlap(i) and distance(i) ask about
pair i; a distance is signed, < 0 minus the depth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bench.convex_pairs import RawShape

Floats = NDArray[np.float64]


class Peer(Protocol):
    def __init__(self, shapes: Sequence[RawShape], pairs: NDArray[Any]) -> None: ...
    def overlap(self, i: int) -> bool: ...
    def distance(self, i: int) -> float: ...


def rotation(pose: Floats) -> Floats:
    """The matrix of a pose tx ty tz qx qy qz qw."""
    x, y, z, w = pose[3:]
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def triangles(shape: RawShape) -> list[tuple[int, int, int]]:
    return [
        (int(face[0]), int(face[k]), int(face[k + 1]))
        for face in shape.faces
        for k in range(1, len(face) - 1)
    ]


class Coal:
    def __init__(self, shapes: Sequence[RawShape], pairs: NDArray[Any]) -> None:
        import coal

        self._coal = coal
        made = [self._shape(shape) for shape in shapes]

        def placed(pose: Floats) -> Any:
            return coal.Transform3s(rotation(pose), pose[:3].copy())

        self._pairs = [
            (made[p["a"]], placed(p["pose_a"]), made[p["b"]], placed(p["pose_b"])) for p in pairs
        ]
        self._collide, self._collision = coal.CollisionRequest(), coal.CollisionResult()
        self._measure, self._distance = coal.DistanceRequest(), coal.DistanceResult()
        self._measure.enable_signed_distance = True

    def _shape(self, shape: RawShape) -> Any:
        if shape.half:
            return self._coal.Box(*(2 * half for half in shape.half))
        points, faces = self._coal.StdVec_Vec3s(), self._coal.StdVec_Triangle()
        for p in shape.vertices:
            points.append(p)
        for triangle in triangles(shape):
            faces.append(self._coal.Triangle(*triangle))
        return self._coal.Convex(points, faces)

    def overlap(self, i: int) -> bool:
        self._collision.clear()
        self._coal.collide(*self._pairs[i], self._collide, self._collision)
        return bool(self._collision.isCollision())

    def distance(self, i: int) -> float:
        self._distance.clear()
        return float(self._coal.distance(*self._pairs[i], self._measure, self._distance))


class Fcl:
    def __init__(self, shapes: Sequence[RawShape], pairs: NDArray[Any]) -> None:
        import fcl

        self._fcl = fcl
        made = [self._shape(shape) for shape in shapes]

        def placed(number: int, pose: Floats) -> Any:
            return fcl.CollisionObject(made[number], fcl.Transform(rotation(pose), pose[:3]))

        self._pairs = [(placed(p["a"], p["pose_a"]), placed(p["b"], p["pose_b"])) for p in pairs]
        self._measure = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)

    def _shape(self, shape: RawShape) -> Any:
        if shape.half:
            return self._fcl.Box(*(2 * half for half in shape.half))
        faces = np.concatenate([[len(face), *face] for face in shape.faces]).astype(np.int64)
        return self._fcl.Convex(shape.vertices.copy(), len(shape.faces), faces)

    def overlap(self, i: int) -> bool:
        fcl = self._fcl
        return bool(fcl.collide(*self._pairs[i], fcl.CollisionRequest(), fcl.CollisionResult()))

    def distance(self, i: int) -> float:
        return float(self._fcl.distance(*self._pairs[i], self._measure, self._fcl.DistanceResult()))


class Mujoco:
    """Two geoms a shape in one model; a question writes two poses. Hulls are stored in float32."""

    def __init__(self, shapes: Sequence[RawShape], pairs: NDArray[Any]) -> None:
        import mujoco

        self._mujoco = mujoco
        spec = mujoco.MjSpec()
        spec.option.ccd_tolerance = 1e-15
        spec.option.ccd_iterations = 1000
        for k, shape in enumerate(shapes):
            if not shape.half:
                mesh = spec.add_mesh(name=f"m{k}")
                mesh.uservert = shape.vertices.ravel()
                mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        for _ in "ab":
            for k, shape in enumerate(shapes):
                if shape.half:
                    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=shape.half)
                else:
                    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"m{k}")
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        mujoco.mj_kinematics(self._model, self._data)
        self._ends = np.zeros(6)
        # The compiler puts a mesh about its centre and main axes; the geom says where that is.
        centres = self._data.geom_xpos.copy()
        axes = self._data.geom_xmat.copy().reshape(-1, 3, 3)

        def placed(number: int, pose: Floats) -> tuple[int, Floats, Floats]:
            turn = rotation(pose)
            return number, pose[:3] + turn @ centres[number], (turn @ axes[number]).ravel()

        count = len(shapes)
        self._pairs = [
            (*placed(int(p["a"]), p["pose_a"]), *placed(count + int(p["b"]), p["pose_b"]))
            for p in pairs
        ]

    def overlap(self, i: int) -> bool:
        return self.distance(i) <= 0

    def distance(self, i: int) -> float:
        a, place_a, turn_a, b, place_b, turn_b = self._pairs[i]
        data = self._data
        data.geom_xpos[a], data.geom_xmat[a] = place_a, turn_a
        data.geom_xpos[b], data.geom_xmat[b] = place_b, turn_b
        ask = self._mujoco.mj_geomDistance
        return float(ask(self._model, data, a, b, 1e30, self._ends))


class Bullet:
    """A body a shape and side; a question places two. Hulls as pybullet makes them of vertices."""

    def __init__(self, shapes: Sequence[RawShape], pairs: NDArray[Any]) -> None:
        import pybullet

        self._bullet = pybullet
        self._client = pybullet.connect(pybullet.DIRECT)
        self._a, self._b = ([self._body(shape) for shape in shapes] for _ in "ab")
        self._pairs = [
            (self._a[p["a"]], p["pose_a"].tolist(), self._b[p["b"]], p["pose_b"].tolist())
            for p in pairs
        ]

    def _body(self, shape: RawShape) -> int:
        bullet = self._bullet
        if shape.half:
            made = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=shape.half)
        else:
            made = bullet.createCollisionShape(bullet.GEOM_MESH, vertices=shape.vertices.tolist())
        return int(bullet.createMultiBody(0, made))

    def overlap(self, i: int) -> bool:
        return self.distance(i) <= 0

    def distance(self, i: int) -> float:
        a, pose_a, b, pose_b = self._pairs[i]
        bullet = self._bullet
        bullet.resetBasePositionAndOrientation(a, pose_a[:3], pose_a[3:])
        bullet.resetBasePositionAndOrientation(b, pose_b[:3], pose_b[3:])
        found = bullet.getClosestPoints(a, b, 1e6)
        return min((point[8] for point in found), default=float("nan"))


PEERS: dict[str, tuple[str, type[Peer]]] = {
    "coal": ("coal", Coal),
    "python-fcl": ("fcl", Fcl),
    "mujoco": ("mujoco", Mujoco),
    "pybullet": ("pybullet", Bullet),
}
