"""The placed bodies of a check, and the pairs to check."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import combinations, product
from typing import TYPE_CHECKING, Any, Literal

from msgspec import Struct

from satcheck.audit.body import (
    Box,
    MeshKey,
    PlacedBody,
    SharedMesh,
    largest_coordinate,
    mesh_key,
    world_bounds,
)
from satcheck.audit.settings import Settings
from satcheck.report.report import Issue, RuleReport
from satcheck.report.rule_book import RuleBook
from satcheck.scene import Body, Unreadable
from satcheck.scene.half_spaces import farthest, reach_in_world
from satcheck.scene.rules import KEYS, Members
from satcheck.scene.words import told_apart

if TYPE_CHECKING:
    from satcheck.scene import Scene
    from satcheck.scene.rules import Rule

# The code of an issue about a rule that selects no pair.
UNUSED_RULE = "unused-rule"
# How the reasons of rules begin that `satcheck suggest` writes.
SUGGESTED = "suggested: "
# The largest world coordinate. A body that is moved out of another, by twice this at most, stays in
# the range of the core.
LARGEST_PLACED = 2e44


class UnusableBody(Struct, frozen=True):
    """A body whose pairs cannot be decided."""

    body: Body | Unreadable
    reason: str

    @property
    def id(self) -> str:
        return self.body.id


class PlacedBodies(Struct, frozen=True):
    """Bodies by index, in the order given: each is placed or unusable. ids and the book of rules
    have the same order. units: of the placed bodies; None: not stated. Bodies with different units
    have no common frame."""

    placed: dict[int, PlacedBody]
    unusable: dict[int, UnusableBody]
    ids: tuple[str, ...]
    book: RuleBook
    issues: tuple[Issue, ...]
    units: dict[int, str | None]

    @property
    def undecidable_count(self) -> int:
        """The number of `undecidable_pairs`, without a visit to each."""
        alike, endless = self._alike(), sum(1 for _ in self.endless_pairs())
        if not self.unusable and len(alike) < 2:
            return endless
        return self._checked_count(None) - sum(map(self._checked_count, alike)) + endless

    @property
    def several_units_count(self) -> int:
        """The number of `pairs_of_several_units`."""
        alike = self._alike()
        if len(alike) < 2:
            return 0
        return self._checked_count(self.placed) - sum(map(self._checked_count, alike))

    def _checked_count(self, among: Collection[int] | None) -> int:
        total, allowed = self.book.count(among)
        return total - allowed

    def _alike(self) -> list[dict[int, None]]:
        """The placed bodies, by their units."""
        if len({*self.units.values()}) < 2:
            return [dict.fromkeys(self.placed)]
        alike: dict[str | None, dict[int, None]] = {}
        for k in self.placed:
            alike.setdefault(self.units.get(k), {})[k] = None
        return list(alike.values())

    def undecidable_pairs(self) -> Iterator[tuple[int, int, str]]:
        """Pairs that cannot be decided because a body is unusable or in unknown units, with the
        reason."""
        yield from self._pairs_of_unusable_bodies()
        yield from self.pairs_of_several_units()
        yield from self.endless_pairs()

    def is_comparable(self, i: int, j: int) -> bool:
        """Return whether two placed bodies may have the same unit of length."""
        return self.units.get(i) == self.units.get(j)

    def endless_pairs(self) -> Iterator[tuple[int, int, str]]:
        """Pairs of half spaces that do not face each other with a gap: blocks cannot stand for
        them."""
        floors = [k for k, body in self.placed.items() if body.endless]
        if len(floors) < 2:
            return
        from satcheck.core.half_space import gap_of_planes, plane_of

        for i, j in combinations(floors, 2):
            if self.is_comparable(i, j) and self.book.is_checked(i, j):
                gap = gap_of_planes(*(plane_of(self.placed[k].body.transform) for k in (i, j)))
                if gap is None or gap < 0:
                    yield i, j, "two half spaces that share a region without end are not measured"

    def _pairs_of_unusable_bodies(self) -> Iterator[tuple[int, int, str]]:
        for k, body in self.unusable.items():
            for other in range(len(self.ids)):
                if other in self.unusable and other >= k:
                    continue
                if self.book.is_checked(k, other):
                    yield min(k, other), max(k, other), body.reason

    def pairs_of_several_units(self) -> Iterator[tuple[int, int, str]]:
        """Undecidable pairs whose only problem is the units."""
        for some, others in combinations(self._alike(), 2):
            for i, j in map(sorted, product(some, others)):
                if self.book.is_checked(i, j):
                    yield i, j, f"{self._in_units(i)}, and {self._in_units(j)}"

    def _in_units(self, k: int) -> str:
        unit = self.units.get(k)
        known = f"{self.ids[k]} is in {unit}"
        return known if unit else f"no unit of length is stated for {self.ids[k]}"


class BodyCache:
    """Data that a check leaves for checks of the same bodies in other places, with the same
    settings.

    meshes: data that depend on a mesh alone. placed: bodies by id; a body that did not move is
    reused. book: the rules of the scene; None: not compiled yet.
    """

    __slots__ = ("book", "meshes", "placed")

    def __init__(self) -> None:
        self.meshes: dict[MeshKey, SharedMesh] = {}
        self.placed: dict[str, PlacedBody] = {}
        self.book: RuleBook | None = None

    def place(self, body: Body, settings: Settings, bounds: Box | None) -> PlacedBody:
        """bounds: of its mesh in the world, where known. Raises OverflowError where its pose leaves
        the number range, ValueError where it has no shape there."""
        earlier = self.placed.get(body.id)
        if earlier is not None and earlier.body is body:
            return earlier
        meshes: dict[Any, SharedMesh] = self.meshes
        key: tuple[object, ...] = mesh_key(body.file, is_open=body.open)
        if body.file.prepared is not None:  # of one mesh, whatever the body is called
            meshes, key = body.file.prepared, (*key[2:], *SharedMesh.terms(settings))
        shared = meshes.get(key)
        if shared is None:
            shared = meshes[key] = SharedMesh(body.file, settings, is_open=body.open)
        placed = PlacedBody(body, shared, bounds)
        if (largest := largest_coordinate(placed.bounds)) > LARGEST_PLACED:
            far, most = told_apart(largest, LARGEST_PLACED)
            raise OverflowError(
                f"the body reaches {far}, and world coordinates may be up to {most}; use a larger "
                "unit of length"
            )
        self.placed[body.id] = placed
        return placed


def place(scene: Scene, settings: Settings, cache: BodyCache | None = None) -> PlacedBodies:
    """Put every body into the world; one that cannot be placed is unusable.

    cache: from earlier checks of these bodies; what is new here is added.
    """
    cache = cache or BodyCache()
    if settings.planar is not None:
        cache.meshes.clear()  # an outline is that of one placement
    placed: dict[int, PlacedBody] = {}
    unusable: dict[int, UnusableBody] = {}
    issues: list[Issue] = []
    members = scene.in_order()
    readable = [body for body in members if isinstance(body, Body)]
    bounds = iter(world_bounds(readable, settings.jobs))
    for index, body in enumerate(members):
        if not isinstance(body, Body):
            unusable[index] = UnusableBody(body, f"unreadable {body.file}: {body.issue.code}")
            continue
        try:
            placed[index] = cache.place(body, settings, next(bounds))
        except (ValueError, OverflowError) as error:
            unusable[index] = UnusableBody(body, f"cannot be placed: {error}")
            code, file = code_of_placing(error), body.file.path
            issues.append(Issue(code, "error", body.id, file, str(error)))
    for index, reason in _too_short(placed):
        body = placed.pop(index).body
        unusable[index] = UnusableBody(body, reason)
        issues.append(Issue("out-of-range", "warning", body.id, body.file.path, reason))
    cache.book = cache.book or book_of(
        members, scene.rules, scene.ignore_within_groups, scene.check_static
    )
    return PlacedBodies(
        placed=placed,
        unusable=unusable,
        ids=tuple(body.id for body in members),
        book=cache.book,
        issues=(*(_unused(scene.rules[number]) for number in cache.book.unused()), *issues),
        units={k: body.body.units for k, body in placed.items()},
    )


def book_of(
    bodies: Sequence[Body | Unreadable],
    rules: Sequence[Rule],
    ignored_groups: frozenset[str] = frozenset(),
    check_static: bool = True,
) -> RuleBook:
    """Return the rules of a scene, compiled for these bodies."""
    selected = []
    if rules:
        members = Members(bodies)
        selected = [(members.of(rule.a.text), members.of(rule.b.text)) for rule in rules]
    return RuleBook(
        bodies,
        [
            RuleReport(
                a=rule.a.text,
                b=rule.b.text,
                **{key: getattr(rule, key) for key in (*KEYS, "reason", "where")},
            )
            for rule in rules
        ],
        selected,
        ignored_groups,
        check_static,
    )


def _too_short(placed: Mapping[int, PlacedBody]) -> list[tuple[int, str]]:
    """Half spaces whose block does not stand for them beside all other bodies, and why."""
    others = [body for body in placed.values() if not body.endless]
    short = []
    for index, floor in placed.items():
        if floor.endless:
            origin, reach = reach_in_world(floor.body)
            beyond = next((o.id for o in others if not farthest(origin, o.bounds) <= reach), None)
            if beyond is not None:
                short.append((index, f"{beyond} lies beyond the reach of the half space"))
    return short


def code_of_placing(error: ArithmeticError | ValueError) -> str:
    """Return the code of an error of `BodyCache.place`."""
    return "out-of-range" if isinstance(error, OverflowError) else "unplaceable"


def _unused(rule: Rule) -> Issue:
    """A suggested rule only permits, and may be about another asset of its folder."""
    message = f"{rule.name}: the rule selects no pair of bodies"
    severity: Literal["warning", "note"] = "warning"
    if rule.reason.startswith(SUGGESTED) and not (rule.clearance or rule.tolerance):
        severity = "note"
    return Issue(UNUSED_RULE, severity, None, rule.file, message, rule.line)
