"""USD physics: which pairs a simulator does not collide, and why, and the joints of rigid bodies.

A joint has a frame in each of its bodies, and an axis. In `physics:axis` lie the angle and the
length of the second frame against the first; limits are in degrees, or in the unit of the stage.
Source: the schemas of UsdPhysics.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations_with_replacement
from typing import Any, Literal

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from satcheck.plugins.usd.stage import Remarks, Stage
from satcheck.plugins.usd.walk import WORLD, PlacedPrim, of_prototype
from satcheck.scene.document import Item, RawJoint, RawRule
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


def with_physics(
    stage: Stage, nodes: Sequence[Item], prims: Sequence[PlacedPrim], time: Any, said: Remarks
) -> tuple[tuple[Item, ...], tuple[RawRule, ...], tuple[RawJoint, ...]]:
    """(the nodes with the groups that the rules name, and their rigid bodies, the rules, the joints
    that are enabled and hold two bodies, or one and the world).

    prims: where each node comes from. time: a Usd.TimeCode. Simulators do not collide
    colliders of one rigid body, FilteredPairs, members of CollisionGroups that filter each other,
    and bodies that a joint connects without collisionEnabled. Visual geometry below these prims is
    treated alike.
    """
    made = _Rules(stage.stage, prims, time, said)
    rules = tuple(made.rules())
    links = {number: body for body, numbers in made.of_body.items() for number in numbers}
    own = tuple(
        replace(node, groups=tuple(made.groups[number]), link=links.get(number))
        for number, node in enumerate(nodes)
    )
    joints = map(_Joints(stage, time, said).joint, made.joints)
    return own, rules, tuple(filter(None, joints))


class _Rules:
    """The rules, and the groups of each node that they name. A prim, and a rigid body, has a name
    in each instance.

    of_body: the nodes in each rigid body. joints: the prims of joints.
    """

    def __init__(self, stage: Any, prims: Sequence[PlacedPrim], time: Any, said: Remarks) -> None:
        self._stage = stage
        self._prims = prims
        self._time = time
        self._said = said
        self._below: dict[str, list[int]] = {}  # name of a prim -> the nodes below
        self._names: dict[str, dict[str, str]] = {}  # path of a prim -> frame -> name there
        self._around: dict[str, str] = {}  # frame -> the one around it
        self._filters: list[Any] = []
        self.joints: list[Any] = []
        self.of_body: dict[str, list[int]] = {}
        self.groups: list[list[str]] = [[] for _ in prims]
        has_bodies = False
        roots = {root.GetPath(): root for each in prims if (root := each.frame.root) is not None}
        # A walk of the stage leaves out what is below an `over`.
        undefined = (of_prototype(root) for root in roots.values() if not root.IsDefined())
        for prim in chain(stage.Traverse(Usd.TraverseInstanceProxies()), *undefined):
            has_bodies = has_bodies or prim.HasAPI(UsdPhysics.RigidBodyAPI)
            if prim.HasAPI(UsdPhysics.FilteredPairsAPI):
                self._filters.append(prim)
            if prim.IsA(UsdPhysics.Joint):
                self.joints.append(prim)
        if has_bodies or self._filters or self.joints:
            for number, each in enumerate(prims):
                self._place(number, each)

    def _place(self, number: int, placed: PlacedPrim) -> None:
        if placed.prim is None:  # of an unresolved reference
            self._below.setdefault(placed.name, []).append(number)
            self._names.setdefault(placed.name, {})[WORLD.name] = placed.name
            return
        body = None
        for name, prim, frame in placed.frame.ancestors(placed.prim):
            self._below.setdefault(name, []).append(number)
            self._names.setdefault(str(prim.GetPath()), {})[frame.name] = name
            if frame.instancer is not None:
                self._around[frame.name] = frame.instancer[1].name
            body = body or (name if _is_body(prim, self._time) else None)
        if body is not None:
            self.of_body.setdefault(body, []).append(number)

    def rules(self) -> Iterator[RawRule]:
        for body, numbers in self.of_body.items():
            if len(numbers) > 1:
                own = self._group(f"rigid body {body}", numbers)
                yield _rule(own, own, f"one rigid body {body}")
        for prim in self._filters:
            yield from self._of_filter(prim)
        for prim in self.joints:
            yield from self._of_joint(UsdPhysics.Joint(prim))
        yield from self._of_collision_groups()

    def _pairs(self, one: str, other: str) -> Iterator[tuple[str, str]]:
        """The names of two prims in each instance: the other one is in the same instance, or in
        one around it, or outside of all. Prims that share no instance are no pair."""
        names = [self._names.get(path, {}) for path in (one, other)]
        for frame in names[0] | names[1]:
            a, b = (self._nearest(frame, known) for known in names)
            if a is not None and b is not None:
                yield a, b

    def _nearest(self, frame: str | None, known: Mapping[str, str]) -> str | None:
        """The name that is known in the frame, or else in the first around it."""
        while frame is not None and frame not in known:
            frame = self._around.get(frame)
        return None if frame is None else known[frame]

    def _group(self, name: str, numbers: Sequence[int]) -> str:
        for number in numbers:
            if name not in self.groups[number]:
                self.groups[number].append(name)
        return name

    def _of_filter(self, prim: Any) -> Iterator[RawRule]:
        path = prim.GetPath()
        for other in UsdPhysics.FilteredPairsAPI(prim).GetFilteredPairsRel().GetForwardedTargets():
            pairs = list(self._pairs(str(path), str(other)))
            if not pairs and {str(path), str(other)} <= self._names.keys():
                words = f"filteredPairs with {other}, in another prototype, is not applied"
                self._said.add("ignored-opinion", words, str(path))
            for pair in pairs:
                a, b = (self._group(f"below {name}", self._below.get(name, [])) for name in pair)
                yield _rule(a, b, f"filteredPairs of {path}")

    def _of_joint(self, joint: Any) -> Iterator[RawRule]:
        stage, time = self._stage, self._time
        if joint.GetCollisionEnabledAttr().Get(time) or not joint.GetJointEnabledAttr().Get(time):
            return
        ends = [body_at(stage, end, time) for end in (joint.GetBody0Rel(), joint.GetBody1Rel())]
        if ends[0] is None or ends[1] is None:
            return
        for pair in self._pairs(ends[0], ends[1]):
            held = [self.of_body.get(end, []) for end in pair]
            if all(held):
                a, b = map(self._group, [f"rigid body {end}" for end in pair], held)
                yield _rule(a, b, f"joint {joint.GetPath()}")

    def _of_collision_groups(self) -> Iterator[RawRule]:
        """As the table of the stage says, with merged and inverted groups."""
        table = UsdPhysics.CollisionGroup.ComputeCollisionGroupTable(self._stage)
        held = {path: self._members_of(path) for path in table.GetGroups()}
        for one, other in combinations_with_replacement(held, 2):
            if held[one] and held[other] and not table.IsCollisionEnabled(one, other):
                a, b = (self._group(f"collision group {path}", held[path]) for path in (one, other))
                both = f"groups {one} and {other}" if one != other else f"group {one}"
                yield _rule(a, b, f"collision {both}")

    def _members_of(self, group: Any) -> list[int]:
        """The nodes in a collision group."""
        api = UsdPhysics.CollisionGroup.Get(self._stage, group).GetCollidersCollectionAPI()
        query = api.ComputeMembershipQuery()
        return [
            number
            for number, each in enumerate(self._prims)
            if each.prim is not None and query.IsPathIncluded(each.outermost())
        ]


def _is_body(prim: Any, time: Any) -> bool:
    if not prim.HasAPI(UsdPhysics.RigidBodyAPI):
        return False
    return bool(UsdPhysics.RigidBodyAPI(prim).GetRigidBodyEnabledAttr().Get(time))


def _rule(a: str, b: str, reason: str) -> RawRule:
    return RawRule(a, b, f"USD: {reason}", of_groups=True)


def body_at(stage: Any, relationship: Any, time: Any) -> str | None:
    """The rigid body that the end of a joint is in; None: the world."""
    for path in relationship.GetForwardedTargets():
        prim = stage.GetPrimAtPath(path)
        while prim and not prim.IsPseudoRoot():
            if _is_body(prim, time):
                return str(prim.GetPath())
            prim = prim.GetParent()
    return None


class _Joints:
    def __init__(self, stage: Stage, time: Any, said: Remarks) -> None:
        self._stage = stage
        self._time = time
        self._said = said
        self._cache = UsdGeom.XformCache(time)
        self._metres = ratio(stage.unit, "m")

    def joint(self, prim: Any) -> RawJoint | None:
        joint, kind, name = UsdPhysics.Joint(prim), str(prim.GetTypeName()), str(prim.GetPath())
        ends = [joint.GetBody0Rel(), joint.GetBody1Rel()]
        parent, child = (body_at(self._stage.stage, end, self._time) for end in ends)
        is_on = joint.GetJointEnabledAttr().Get(self._time)
        if not is_on or parent == child or kind in _LOOSE:
            return None
        named = (path for end in ends for path in end.GetForwardedTargets()[:1])
        if not all(map(self._stage.stage.GetPrimAtPath, named)):
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
