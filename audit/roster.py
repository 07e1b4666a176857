"""Who takes part, and which pairs are asked about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from satcheck.audit.placed_body import PlacedBody, SharedMesh
from satcheck.audit.report import Issue
from satcheck.audit.settings import Settings

if TYPE_CHECKING:
    from satcheck.scene import Body, Scene


@dataclass(frozen=True, slots=True)
class Lost:
    """A body that takes part in pairs, none of which can be decided."""

    id: str
    file: str
    reason: str


@dataclass(frozen=True, slots=True)
class Roster:
    """Bodies by index: first the placed ones, then the lost ones. ids and groups follow it."""

    placed: tuple[PlacedBody, ...]
    lost: tuple[Lost, ...]
    ids: tuple[str, ...]
    groups: tuple[str | None, ...]
    ignored_groups: frozenset[str]
    allowed_ids: frozenset[frozenset[str]]
    issues: tuple[Issue, ...]

    def is_ignored(self, i: int, j: int) -> bool:
        """Both in one group whose pairs nobody asks about."""
        group = self.groups[i]
        return group is not None and group == self.groups[j] and group in self.ignored_groups

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
        for j in range(len(self.placed), len(self.ids)):
            for i in range(j):
                if self.is_asked(i, j):
                    yield i, j, self.lost[j - len(self.placed)].reason

    def total(self) -> int:
        """Pairs that are not ignored."""
        sizes = Counter(group for group in self.groups if group in self.ignored_groups)
        return _pairs(len(self.ids)) - sum(_pairs(size) for size in sizes.values())

    def allowed(self) -> int:
        """Allowed pairs of bodies that are here and not ignored anyway."""
        index = {id: k for k, id in enumerate(self.ids)}
        found = 0
        for pair in self.allowed_ids:
            members = [index[id] for id in pair if id in index]
            found += len(members) == 2 and not self.is_ignored(*members)
        return found


def _pairs(n: int) -> int:
    return n * (n - 1) // 2


def place(scene: Scene, settings: Settings) -> Roster:
    """Put every body into the world; one whose pose leaves the number range is lost."""
    shared: dict[str, SharedMesh] = {}
    placed: list[PlacedBody] = []
    groups: list[str | None] = []
    lost: list[Lost] = []
    lost_groups: list[str | None] = []
    issues: list[Issue] = []
    for body in scene.bodies:
        mesh = shared.setdefault(body.file.sha256, SharedMesh(body.file, settings))
        try:
            placed.append(PlacedBody(body, mesh))
            groups.append(body.group)
        except ValueError as error:
            lost.append(Lost(body.id, body.file.path, f"cannot be placed: {error}"))
            lost_groups.append(body.group)
            issues.append(_unplaceable(body, error))
    for unreadable in scene.unreadable:
        reason = f"unreadable {unreadable.file}: {unreadable.issue.code}"
        lost.append(Lost(unreadable.id, unreadable.file, reason))
        lost_groups.append(None)
    return Roster(
        placed=tuple(placed),
        lost=tuple(lost),
        ids=(*(body.id for body in placed), *(body.id for body in lost)),
        groups=(*groups, *lost_groups),
        ignored_groups=frozenset(scene.ignore_within_groups),
        allowed_ids=frozenset(scene.allowed_pairs),
        issues=tuple(issues),
    )


def _unplaceable(body: Body, error: ValueError) -> Issue:
    return Issue("unplaceable", "error", body.id, body.file.path, str(error))
