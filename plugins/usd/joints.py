"""The joints of USD physics between rigid bodies.

A joint has a frame in each of its bodies, and an axis. In `physics:axis` lie the angle and the
length of the second frame against the first; limits are in degrees, or in the unit of the stage.
Source: the schemas of UsdPhysics.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, Literal

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray
from pxr import Gf, UsdGeom, UsdPhysics

from satcheck.plugins.usd.physics import body_at
from satcheck.plugins.usd.stage import Remarks, Stage
from satcheck.scene.document import RawJoint
from satcheck.scene.units import ratio

Floats = NDArray[np.float64]
_AXES = {"X": 0, "Y": 1, "Z": 2}
# Frames that are this far apart, in radians and as a share of their distance from the origins of
# their bodies, do not meet: files store them as float32, and programs write few digits.
_APART = 1e-3
_STAYS = "it is not moved, its bodies stay as the file places them"
_KINDS: dict[str, Literal["revolute", "prismatic"]] = {
    "PhysicsRevoluteJoint": "revolute",
    "PhysicsPrismaticJoint": "prismatic",
}
# These hold no body in a place.
_LOOSE = frozenset(("PhysicsDistanceJoint",))


class Joints:
    def __init__(self, stage: Stage, time: Any, said: Remarks) -> None:
        self._stage = stage
        self._time = time
        self._said = said
        self._cache = UsdGeom.XformCache(time)
        self._metres = ratio(stage.unit, "m")

    def of(self, prims: Iterable[Any]) -> tuple[RawJoint, ...]:
        """Those of these joints that are enabled and hold two bodies, or one and the world."""
        return tuple(joint for prim in prims if (joint := self._joint(prim)) is not None)

    def _joint(self, prim: Any) -> RawJoint | None:
        joint, kind, name = UsdPhysics.Joint(prim), str(prim.GetTypeName()), str(prim.GetPath())
        ends = [joint.GetBody0Rel(), joint.GetBody1Rel()]
        parent, child = (body_at(self._stage.stage, end, self._time) for end in ends)
        is_on = joint.GetJointEnabledAttr().Get(self._time)
        if not is_on or parent == child or kind in _LOOSE:
            return None
        if any(map(self._is_lost, ends)):
            self._said.add("joint-not-moved", "a body that it names is missing: ignored", name)
            return None
        frames = [self._frame(joint, number, end) for number, end in enumerate(ends)]
        if not np.isfinite(frames).all():
            self._said.add("joint-not-moved", "its frames are not finite: ignored", name)
            return None
        frame = tuple(frames[0].ravel().tolist())
        still = RawJoint(name, "fixed", parent, child, frame, (0.0, 0.0, 1.0), None, 0.0)
        found = still if kind == "PhysicsFixedJoint" else self._moving(prim, frames, still)
        if isinstance(found, str):
            self._said.add("joint-not-moved", f"{found}: {_STAYS}", name)
            return still
        return found

    def _moving(self, prim: Any, frames: list[Floats], still: RawJoint) -> RawJoint | str:
        """The joint with its axis and limits, or why it is not moved."""
        name = str(prim.GetTypeName())
        if name not in _KINDS:
            return f"a joint of type {name}"
        kind, axis = _KINDS[name], _AXES[str(prim.GetAttribute("physics:axis").Get())]
        rest = _along(kind, axis, *frames)
        if rest is None:
            return "its frames do not meet"
        unit = math.radians(1) if kind == "revolute" else self._stage.scale * self._metres
        low, high = (
            float(prim.GetAttribute(f"physics:{end}Limit").Get()) * unit
            for end in ("lower", "upper")
        )
        if low > high:
            return "its limits leave no value"
        x, y, z = np.eye(3)[axis].tolist()
        return replace(
            still,
            kind=kind,
            axis=(x, y, z),
            limits=(low, high) if math.isfinite(low) and math.isfinite(high) else None,
            rest=rest if kind == "revolute" else rest * self._metres,
        )

    def _is_lost(self, end: Any) -> bool:
        targets = end.GetForwardedTargets()
        return bool(targets) and not self._stage.stage.GetPrimAtPath(targets[0])

    def _frame(self, joint: Any, number: int, end: Any) -> Floats:
        """World pose of a frame of the joint, shape (4, 4), for column vectors, rigid. Mirrored
        bodies give a left-handed one."""
        position = joint.GetPrim().GetAttribute(f"physics:localPos{number}").Get()
        turn = joint.GetPrim().GetAttribute(f"physics:localRot{number}").Get()
        local = Gf.Matrix4d().SetTransform(Gf.Rotation(Gf.Quatd(turn)), Gf.Vec3d(position))
        targets = end.GetForwardedTargets()
        body = self._stage.stage.GetPrimAtPath(targets[0]) if targets else None
        if body:
            local = local * self._cache.GetLocalToWorldTransform(body)
        frame = np.array(self._stage.matrix(local)).reshape(4, 4)
        if np.isfinite(frame).all():
            left, _, right = np.linalg.svd(frame[:3, :3])
            frame[:3, :3] = left @ right
        return frame


def _along(kind: str, axis: int, first: Floats, second: Floats) -> float | None:
    """The angle or the length of the second frame along the axis of the first one; None: it is
    also off this axis."""
    turn = first[:3, :3].T @ second[:3, :3]
    step = first[:3, :3].T @ (second[:3, 3] - first[:3, 3])
    if np.linalg.det(turn) < 0 or np.linalg.det(first[:3, :3]) < 0:
        return None
    u, v = (axis + 1) % 3, (axis + 2) % 3
    angle = math.atan2(turn[v, u] - turn[u, v], turn[u, u] + turn[v, v])
    off_axis = math.acos(min(1.0, turn[axis, axis]))
    length = float(step[axis])
    off = [off_axis, *np.delete(step, axis) / (np.abs(second[:3, 3]).max() or 1.0)]
    off += [length / (np.abs(second[:3, 3]).max() or 1.0)] if kind == "revolute" else [angle]
    if max(map(abs, off)) > _APART:
        return None
    return angle if kind == "revolute" else length
