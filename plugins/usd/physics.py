"""Rules of USD physics: which pairs a simulator does not collide, and why."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations_with_replacement
from typing import Any

from msgspec import Struct
from msgspec.structs import replace
from pxr import Usd, UsdPhysics

from satcheck.plugins.usd.stage import Remarks
from satcheck.plugins.usd.walk import WORLD, PlacedPrim, of_prototype
from satcheck.scene.loading.raw_mesh import RawNode, RawRule


class Physics(Struct, frozen=True):
    """nodes: with the groups that the rules name, and their rigid bodies. joints: the prims of
    joints."""

    nodes: tuple[RawNode, ...]
    rules: tuple[RawRule, ...] = ()
    joints: tuple[Any, ...] = ()


def with_physics(
    stage: Any, nodes: Sequence[RawNode], prims: Sequence[PlacedPrim], time: Any, said: Remarks
) -> Physics:
    """What physics says of the nodes.

    prims: where each node comes from. time: a Usd.TimeCode. Simulators do not collide
    colliders of one rigid body, FilteredPairs, members of CollisionGroups that filter each other,
    and bodies that a joint connects without collisionEnabled. Visual geometry below these prims is
    treated alike.
    """
    sources = _Sources(stage, prims, time)
    if not sources:
        return Physics(tuple(nodes))
    members = _Members(sources, prims)
    made = _Rules(sources, members, len(nodes), said)
    rules = tuple(made.rules())
    links = {number: body for body, numbers in members.of_body.items() for number in numbers}
    own = tuple(
        replace(node, groups=tuple(made.groups[number]), link=links.get(number))
        for number, node in enumerate(nodes)
    )
    return Physics(own, rules, tuple(joint.GetPrim() for joint in sources.joints))


class _Sources:
    """The prims of a stage that make rules."""

    def __init__(self, stage: Any, prims: Sequence[PlacedPrim], time: Any) -> None:
        self.filters: list[Any] = []
        self.joints: list[Any] = []
        self.has_bodies = False
        for prim in chain(stage.Traverse(Usd.TraverseInstanceProxies()), *_undefined(prims)):
            if prim.HasAPI(UsdPhysics.RigidBodyAPI):
                self.has_bodies = True
            if prim.HasAPI(UsdPhysics.FilteredPairsAPI):
                self.filters.append(prim)
            if prim.IsA(UsdPhysics.Joint):
                self.joints.append(UsdPhysics.Joint(prim))
        self.table = UsdPhysics.CollisionGroup.ComputeCollisionGroupTable(stage)
        self.stage = stage
        self.time = time

    def __bool__(self) -> bool:
        return bool(self.has_bodies or self.filters or self.joints or self.table.GetGroups())


def _undefined(prims: Sequence[PlacedPrim]) -> Iterator[Any]:
    """Ranges of the prims of prototypes below an `over`, which a walk of the stage leaves out."""
    roots = {root.GetPath(): root for each in prims if (root := each.frame.root) is not None}
    yield from (of_prototype(root) for root in roots.values() if not root.IsDefined())


class _Members:
    """Which nodes are below a prim, or in a rigid body. Both have a name in each instance."""

    def __init__(self, sources: _Sources, prims: Sequence[PlacedPrim]) -> None:
        self._stage = sources.stage
        self._prims = prims
        self._below: dict[str, list[int]] = {}
        self._names: dict[str, dict[str, str]] = {}  # path of a prim -> frame -> name there
        self._around: dict[str, str] = {}  # frame -> the one around it
        self.of_body: dict[str, list[int]] = {}
        for number, each in enumerate(prims):
            if each.prim is None:  # of an unresolved reference
                self._below.setdefault(each.name, []).append(number)
                self._names.setdefault(each.name, {})[WORLD.name] = each.name
                continue
            body = None
            for name, prim, frame in each.frame.ancestors(each.prim):
                self._below.setdefault(name, []).append(number)
                self._names.setdefault(str(prim.GetPath()), {})[frame.name] = name
                if frame.instancer is not None:
                    self._around[frame.name] = frame.instancer[1].name
                body = body or (name if _is_body(prim, sources.time) else None)
            if body is not None:
                self.of_body.setdefault(body, []).append(number)

    def below(self, name: str) -> list[int]:
        return self._below.get(name, [])

    def has(self, path: str) -> bool:
        """Whether any node is below the prim."""
        return path in self._names

    def pairs(self, one: str, other: str) -> Iterator[tuple[str, str]]:
        """The names of two prims in each instance: the other one is in the same instance, or in
        one around it, or outside of all. Prims that share no instance are no pair."""
        others = self._names.get(other, {})
        swapped = self._names.get(one, {})
        for frame, name in self._names.get(one, {}).items():
            if (around := self._nearest(frame, others)) is not None:
                yield name, others[around]
        for frame, name in others.items():
            around = self._nearest(frame, swapped)
            if around is not None and around != frame:
                yield swapped[around], name

    def _nearest(self, frame: str, known: Mapping[str, str]) -> str | None:
        """The frame, or the first around it, that is among the known ones."""
        place: str | None = frame
        while place is not None and place not in known:
            place = self._around.get(place)
        return place

    def of_collision_group(self, path: Any) -> list[int]:
        api = UsdPhysics.CollisionGroup.Get(self._stage, path).GetCollidersCollectionAPI()
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


class _Rules:
    """The rules, and the groups of each node that they name."""

    def __init__(self, sources: _Sources, members: _Members, count: int, said: Remarks) -> None:
        self._sources = sources
        self._said = said
        self._members = members
        self._made: set[str] = set()
        self.groups: list[list[str]] = [[] for _ in range(count)]

    def rules(self) -> Iterator[RawRule]:
        for body, numbers in self._members.of_body.items():
            if len(numbers) > 1:
                own = self._group(f"rigid body {body}", numbers)
                yield _rule(own, own, f"one rigid body {body}")
        for prim in self._sources.filters:
            yield from self._of_filter(prim)
        for joint in self._sources.joints:
            yield from self._of_joint(joint)
        yield from self._of_collision_groups()

    def _group(self, name: str, numbers: Sequence[int]) -> str:
        if name not in self._made:
            self._made.add(name)
            for number in numbers:
                self.groups[number].append(name)
        return name

    def _of_filter(self, prim: Any) -> Iterator[RawRule]:
        path = prim.GetPath()
        for other in UsdPhysics.FilteredPairsAPI(prim).GetFilteredPairsRel().GetForwardedTargets():
            pairs = list(self._members.pairs(str(path), str(other)))
            if not pairs and self._members.has(str(path)) and self._members.has(str(other)):
                words = f"filteredPairs with {other}, in another prototype, is not applied"
                self._said.add("ignored-opinion", words, str(path))
            for pair in pairs:
                a, b = (self._group(f"below {name}", self._members.below(name)) for name in pair)
                yield _rule(a, b, f"filteredPairs of {path}")

    def _of_joint(self, joint: Any) -> Iterator[RawRule]:
        stage, time = self._sources.stage, self._sources.time
        if joint.GetCollisionEnabledAttr().Get(time) or not joint.GetJointEnabledAttr().Get(time):
            return
        ends = [body_at(stage, end, time) for end in (joint.GetBody0Rel(), joint.GetBody1Rel())]
        if ends[0] is None or ends[1] is None:
            return
        for pair in self._members.pairs(ends[0], ends[1]):
            held = [self._members.of_body.get(end, []) for end in pair]
            if all(held):
                a, b = map(self._group, [f"rigid body {end}" for end in pair], held)
                yield _rule(a, b, f"joint {joint.GetPath()}")

    def _of_collision_groups(self) -> Iterator[RawRule]:
        """As the table of the stage says, with merged and inverted groups."""
        table = self._sources.table
        held = {path: self._members.of_collision_group(path) for path in table.GetGroups()}
        for one, other in combinations_with_replacement(held, 2):
            if held[one] and held[other] and not table.IsCollisionEnabled(one, other):
                a, b = (self._group(f"collision group {path}", held[path]) for path in (one, other))
                both = f"groups {one} and {other}" if one != other else f"group {one}"
                yield _rule(a, b, f"collision {both}")


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
