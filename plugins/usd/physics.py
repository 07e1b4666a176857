"""Rules of USD physics: which pairs a simulator does not collide, and why."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations_with_replacement
from typing import Any

from msgspec.structs import replace
from pxr import Usd, UsdPhysics

from satcheck.plugins.usd.stage import Remarks
from satcheck.plugins.usd.walk import WORLD, PlacedPrim, of_prototype
from satcheck.scene.document import Item, RawRule


def with_physics(
    stage: Any, nodes: Sequence[Item], prims: Sequence[PlacedPrim], time: Any, said: Remarks
) -> tuple[tuple[Item, ...], tuple[RawRule, ...], tuple[Any, ...]]:
    """(the nodes with the groups that the rules name, and their rigid bodies, the rules, the prims
    of joints).

    prims: where each node comes from. time: a Usd.TimeCode. Simulators do not collide
    colliders of one rigid body, FilteredPairs, members of CollisionGroups that filter each other,
    and bodies that a joint connects without collisionEnabled. Visual geometry below these prims is
    treated alike.
    """
    made = _Rules(stage, prims, time, said)
    rules = tuple(made.rules())
    links = {number: body for body, numbers in made.of_body.items() for number in numbers}
    own = tuple(
        replace(node, groups=tuple(made.groups[number]), link=links.get(number))
        for number, node in enumerate(nodes)
    )
    return own, rules, tuple(made.joints)


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
        self._made: set[str] = set()
        self._filters: list[Any] = []
        self.joints: list[Any] = []
        self.of_body: dict[str, list[int]] = {}
        self.groups: list[list[str]] = [[] for _ in prims]
        has_bodies = False
        for prim in chain(stage.Traverse(Usd.TraverseInstanceProxies()), *_undefined(prims)):
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
        if name not in self._made:
            self._made.add(name)
            for number in numbers:
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


def _undefined(prims: Sequence[PlacedPrim]) -> Iterator[Any]:
    """Ranges of the prims of prototypes below an `over`, which a walk of the stage leaves out."""
    roots = {root.GetPath(): root for each in prims if (root := each.frame.root) is not None}
    yield from (of_prototype(root) for root in roots.values() if not root.IsDefined())


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
