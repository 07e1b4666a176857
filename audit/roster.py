"""Who takes part, and which pairs are asked about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from satcheck.audit.placed_body import MeshKey, PlacedBody, SharedMesh, mesh_key
from satcheck.audit.report import Issue
from satcheck.audit.settings import Settings
from satcheck.scene import Body

if TYPE_CHECKING:
    from satcheck.scene import Scene


@dataclass(frozen=True, slots=True)
class Lost:
    """A body that takes part in pairs, none of which can be decided."""

    id: str
    file: str
    reason: str
    groups: tuple[str, ...] = ()
    path: str | None = None


@dataclass(frozen=True, slots=True)
class Roster:
    """Bodies by index, in the order given: each is either placed or lost. ids follow it.

    ignored_of: of each body, the groups it is in whose pairs nobody asks about.
    """

    placed: dict[int, PlacedBody]
    lost: dict[int, Lost]
    ids: tuple[str, ...]
    ignored_of: tuple[frozenset[str], ...]
    ignored_groups: frozenset[str]
    allowed_ids: frozenset[frozenset[str]]
    issues: tuple[Issue, ...]

    def is_ignored(self, i: int, j: int) -> bool:
        """Both in one group whose pairs nobody asks about."""
        return not self.ignored_of[i].isdisjoint(self.ignored_of[j])

    def is_allowed(self, i: int, j: int) -> bool:
        return frozenset((self.ids[i], self.ids[j])) in self.allowed_ids

    def is_asked(self, i: int, j: int) -> bool:
        return not self.is_ignored(i, j) and not self.is_allowed(i, j)

    def asked_pairs(self) -> Iterator[tuple[int, int]]:
        """All asked pairs, lost bodies included: quadratic, for few bodies."""
        for j in range(len(self.ids)):
            for i in range(j):
                if self.is_asked(i, j):
                    yield i, j

    def unreadable_pairs(self) -> Iterator[tuple[int, int, str]]:
        """Asked pairs of which one body is lost, with the reason."""
        for k, body in self.lost.items():
            for other in range(len(self.ids)):
                if other in self.lost and other >= k:
                    continue
                if self.is_asked(k, other):
                    yield min(k, other), max(k, other), body.reason

    def total(self) -> int:
        """Pairs that are not ignored."""
        kinds, alike = kinds_of(self.ignored_of)
        size = Counter(kinds)
        ignored = sum(_pairs(size[a]) if a == b else size[a] * size[b] for a, b in alike)
        return _pairs(len(self.ids)) - ignored

    def allowed_pairs(self) -> Iterator[tuple[int, int]]:
        """Allowed pairs of bodies that are here and not ignored anyway; the first body first."""
        index = {id: k for k, id in enumerate(self.ids)} if self.allowed_ids else {}
        for pair in self.allowed_ids:
            members = sorted(index[id] for id in pair if id in index)
            if len(members) == 2 and not self.is_ignored(*members):
                yield members[0], members[1]


def kinds_of(groups: Sequence[frozenset[str]]) -> tuple[list[int], list[tuple[int, int]]]:
    """Bodies in the same groups are of one kind: the kind of each, and the pairs of kinds that
    have a group in common, each once with the lower kind first."""
    kinds: dict[frozenset[str], int] = {}
    kind_of = [kinds.setdefault(one, len(kinds)) for one in groups]
    members: dict[str, list[int]] = {}
    for one, kind in kinds.items():
        for group in one:
            members.setdefault(group, []).append(kind)
    alike = {(a, b) for kinds_in in members.values() for b in kinds_in for a in kinds_in if a <= b}
    return kind_of, sorted(alike)


def _pairs(n: int) -> int:
    return n * (n - 1) // 2


def place(
    scene: Scene, settings: Settings, shared: dict[MeshKey, SharedMesh] | None = None
) -> Roster:
    """Put every body into the world; one whose pose leaves the number range is lost.

    shared: what is known of meshes; those that are new here are added.
    """
    shared = {} if shared is None else shared
    placed: dict[int, PlacedBody] = {}
    lost: dict[int, Lost] = {}
    issues: list[Issue] = []
    members = scene.in_order()
    for index, body in enumerate(members):
        if not isinstance(body, Body):
            reason = f"unreadable {body.file}: {body.issue.code}"
            lost[index] = Lost(body.id, body.file, reason, body.groups, body.path)
            continue
        key = mesh_key(body.file)
        if key not in shared:
            shared[key] = SharedMesh(body.file, settings)
        mesh = shared[key]
        try:
            placed[index] = PlacedBody(body, mesh)
        except (ValueError, OverflowError) as error:
            reason = f"cannot be placed: {error}"
            lost[index] = Lost(body.id, body.file.path, reason, body.groups, body.path)
            issues.append(_unplaceable(body, error))
    return Roster(
        placed=placed,
        lost=lost,
        ids=tuple(body.id for body in members),
        ignored_of=tuple(scene.ignore_within_groups.intersection(body.groups) for body in members),
        ignored_groups=scene.ignore_within_groups,
        allowed_ids=frozenset(scene.allowed_pairs),
        issues=tuple(issues),
    )


def _unplaceable(body: Body, error: ArithmeticError | ValueError) -> Issue:
    return Issue("unplaceable", "error", body.id, body.file.path, str(error))
