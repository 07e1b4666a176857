"""Joins several scene files and other inputs into one scene.

Motions and groups of a file apply to its own bodies. Its rules apply to these, and to mesh files
and robots, which have no rules of their own. The rules of a file without bodies apply to all
bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import chain, product
from typing import NamedTuple, TypeVar

from msgspec.structs import replace

from satcheck.scene.bodies import Accepted, Body, Unreadable
from satcheck.scene.document import FilePart
from satcheck.scene.errors import Refused
from satcheck.scene.motion import Motion, scaled_motion
from satcheck.scene.rules import Rule, Selectable, Selector
from satcheck.scene.scene_file.entries import SceneFile
from satcheck.scene.statics import BodyRule, StaticsTerms, joined_terms

Bodies = Sequence[Body | Unreadable]
R = TypeVar("R", Rule, BodyRule)

MOST_PAIRS = 100_000  # of a rule that is expanded pair by pair


class _Own(NamedTuple):
    """The bodies that the rules of a scene are about: its own, and those without rules. final:
    Python's id of each of them -> its id in the check."""

    bodies: Sequence[Selectable]
    final: Mapping[int, str]
    everybody: Bodies
    scene: SceneFile

    def chosen(self, selector: Selector) -> list[str]:
        return [self.final[id(body)] for body in selector.select(self.bodies)]


class JoinedScenes:
    """Rules, motions and groups of all scene files, with the ids that bodies have in the check.

    check_static: whether any file requires it. ignored: groups whose pairs are not checked.
    """

    def __init__(self) -> None:
        self._scenes: list[tuple[SceneFile, Mapping[str, str]]] = []
        self.ignored: set[str] = set()
        self.check_static = False
        self._motions: list[tuple[str, Motion]] = []  # with the path of their file

    def add(self, scene: SceneFile, ids: Sequence[str], groups: Mapping[str, str]) -> None:
        """ids: of its items in the check. groups: in the file -> in the check."""
        known = {item.id: id_ for item, id_ in zip(scene.items, ids, strict=True)}
        self._scenes.append((scene, known))
        self.ignored.update(groups[group] for group in scene.ignore_within_groups)
        self.check_static |= scene.check_static
        self._motions += [
            (scene.path, replace(motion, bodies=tuple(known[id_] for id_ in motion.bodies)))
            for motion in scene.motions
        ]

    def accepted(self, *, alone: bool) -> tuple[Accepted, ...]:
        """Issues that may stay. alone: no input stands beside the file. What a file without bodies
        accepts counts for all, as its rules do."""
        return tuple(
            Accepted(text, None if alone or not scene.items else _named_by(scene, ids))
            for scene, ids in self._scenes
            for text in scene.accept
        )

    def motions(self, scales: Mapping[str, float]) -> tuple[Motion, ...]:
        """scales: path of a scene -> the factor of its lengths; 1 if missing."""
        return tuple(scaled_motion(motion, scales.get(path, 1.0)) for path, motion in self._motions)

    def rules(self, everybody: Bodies, scales: Mapping[str, float]) -> tuple[Rule, ...]:
        """everybody: all bodies of the check. scales: as for motions. Raises Refused if a
        rule has to be expanded into too many pairs."""
        return tuple(self._in_check(lambda scene: scene.rules, _own_rules, everybody, scales))

    def body_rules(self, everybody: Bodies, scales: Mapping[str, float]) -> tuple[BodyRule, ...]:
        """everybody, scales: as for rules. Beside other inputs a rule is written out body by
        body."""
        rules = self._in_check(lambda scene: scene.body_rules, _own_body_rules, everybody, scales)
        return tuple(rules)

    def _in_check(
        self,
        rules_of: Callable[[SceneFile], Sequence[R]],
        expanded: Callable[[Sequence[R], _Own], Iterator[R]],
        everybody: Bodies,
        scales: Mapping[str, float],
    ) -> Iterator[R]:
        placed = {id_ for _, ids in self._scenes for id_ in ids.values()}
        bare = [body for body in everybody if body.id not in placed]
        for scene, ids in self._scenes:
            rules = [rule.scaled(scales.get(scene.path, 1.0)) for rule in rules_of(scene)]
            if len(everybody) == len(scene.items) or not scene.items:
                yield from rules
            elif rules:
                final = {id(body): ids[body.id] for body in scene.items}
                final |= {id(body): body.id for body in bare}
                bodies = list[Selectable](chain(scene.items, bare))
                yield from expanded(rules, _Own(bodies, final, everybody, scene))

    def statics(self, scales: Mapping[str, float]) -> StaticsTerms | None:
        """What all files together state; None: none does. Raises SatcheckError if they differ."""
        stated = [
            scene.statics.scaled(scales.get(scene.path, 1.0))
            for scene, _ in self._scenes
            if scene.statics is not None
        ]
        return joined_terms(stated) if stated else None


def _named_by(scene: SceneFile, ids: Mapping[str, str]) -> frozenset[str]:
    files = (item.shape.path for item in scene.items if isinstance(item.shape, FilePart))
    return frozenset((scene.path, *ids.values(), *files))


def _own_body_rules(rules: Sequence[BodyRule], own: _Own) -> Iterator[BodyRule]:
    for rule in rules:
        chosen = own.chosen(rule.bodies)
        for id_ in chosen:
            yield replace(rule, bodies=Selector.exactly(id_))
        if not chosen:
            yield replace(rule, bodies=Selector.nobody())


def _own_rules(rules: Sequence[Rule], own: _Own) -> Iterator[Rule]:
    """Keeps a rule if its selectors match the same bodies in the whole check as in its file and
    among the bodies without rules. Otherwise it is expanded pair by pair."""

    @cache
    def chosen(selector: Selector) -> tuple[bool, list[str]]:
        """(whether it matches the same bodies in the whole check as in its file, these bodies)."""
        ids = own.chosen(selector)
        return {body.id for body in selector.select(own.everybody)} == set(ids), ids

    for rule in rules:
        (a_stays, a), (b_stays, b) = chosen(rule.a), chosen(rule.b)
        if a_stays and b_stays:
            yield rule
        elif not a or not b:
            yield replace(rule, a=Selector.nobody())  # the check then warns that it selects no pair
        elif len(a) * len(b) > MOST_PAIRS:
            message = (
                f"{rule.name}: beside the other inputs this rule has to be written out for "
                f"{len(a) * len(b)} pairs; check this scene alone, or select fewer bodies"
            )
            raise Refused("too-large", message, file=own.scene.path)
        else:
            pairs: dict[frozenset[str], tuple[str, str]] = {}
            for pair in product(a, b):
                pairs.setdefault(frozenset(pair), pair)
            for first, second in pairs.values():
                if first != second:
                    yield replace(rule, a=Selector.exactly(first), b=Selector.exactly(second))
