"""Joins several scene files and other inputs into one scene.

Motions and groups of a file apply to its own bodies. Its rules apply to these, and to mesh files
and robots, which have no rules of their own. The rules of a file without bodies apply to all
bodies.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.scene.bodies import Body, Unreadable
from satcheck.scene.errors import Refused
from satcheck.scene.format.entries import SceneFile
from satcheck.scene.motion import Motion, scaled_motion
from satcheck.scene.plain_ids import UniqueNames
from satcheck.scene.rules import Rule, Selector

if TYPE_CHECKING:
    from satcheck.scene.statics import BodyRule, StaticsTerms

MOST_PAIRS = 100_000  # of a rule that is expanded pair by pair


class JoinedScenes:
    """Rules, motions and groups of all scene files, with the ids that bodies have in the check.

    group_names: makes names of groups unique in the check. check_static: whether any file requires
    it. ignored: groups whose pairs are not checked. accepted: issues that may stay.
    """

    def __init__(self, group_names: UniqueNames) -> None:
        self._group_names = group_names
        self._scenes: list[tuple[SceneFile, Mapping[str, str]]] = []
        self.ignored: set[str] = set()
        self.accepted: list[str] = []
        self.check_static = False
        self._motions: list[tuple[str, Motion]] = []  # with the path of their file

    def groups_of(self, scene: SceneFile) -> dict[str, str]:
        """Its groups -> their names in the check. Groups of different scenes are different, even if
        they have the same name."""
        groups = dict.fromkeys(group for entry in scene.bodies for group in entry.groups)
        groups |= dict.fromkeys(sorted(scene.ignore_within_groups))
        return {group: self._group_names.unique(group) for group in groups}

    def add(self, scene: SceneFile, ids: Mapping[str, str], groups: Mapping[str, str]) -> None:
        """ids: in the file -> in the check; groups: likewise, from `groups_of`."""
        self._scenes.append((scene, ids))
        self.ignored.update(groups[group] for group in scene.ignore_within_groups)
        self.check_static |= scene.check_static
        self.accepted += scene.accept
        self._motions += [
            (scene.path, replace(motion, bodies=tuple(ids[id_] for id_ in motion.bodies)))
            for motion in scene.motions
        ]

    def motions(self, scales: Mapping[str, float]) -> tuple[Motion, ...]:
        """scales: path of a scene -> the factor of its lengths; 1 if missing."""
        if not self._motions:
            return ()
        return tuple(scaled_motion(motion, scales.get(path, 1.0)) for path, motion in self._motions)

    def rules(
        self, everybody: Sequence[Body | Unreadable], scales: Mapping[str, float]
    ) -> tuple[Rule, ...]:
        """everybody: all bodies of the check. scales: as for motions. Raises Refused if a
        rule has to be expanded into too many pairs."""
        placed = {id_ for _, ids in self._scenes for id_ in ids.values()}
        bare = [body for body in everybody if body.id not in placed]
        rules: list[Rule] = []
        for scene, ids in self._scenes:
            scale = scales.get(scene.path, 1.0)
            scene = replace(scene, rules=tuple(rule.scaled(scale) for rule in scene.rules))
            if len(everybody) == len(scene.bodies) or not scene.bodies:
                rules += scene.rules
            else:
                rules += _own_rules(scene, ids, bare, everybody)
        return tuple(rules)

    def body_rules(
        self, everybody: Sequence[Body | Unreadable], scales: Mapping[str, float]
    ) -> tuple[BodyRule, ...]:
        """everybody, scales: as for rules. A rule that selects other bodies in the whole check than
        in its file is written out body by body."""
        if not any(scene.body_rules for scene, _ in self._scenes):
            return ()
        placed = {id_ for _, ids in self._scenes for id_ in ids.values()}
        bare = [body for body in everybody if body.id not in placed]
        rules: list[BodyRule] = []
        for scene, ids in self._scenes:
            scale = scales.get(scene.path, 1.0)
            own = [rule.scaled(scale) for rule in scene.body_rules]
            if len(everybody) == len(scene.bodies) or not scene.bodies:
                rules += own
            else:
                rules += _own_body_rules(own, scene, ids, bare)
        return tuple(rules)

    def statics(self, scales: Mapping[str, float]) -> StaticsTerms | None:
        """What all files together state; None: none does. Raises SatcheckError if they differ."""
        stated = [
            scene.statics.scaled(scales.get(scene.path, 1.0))
            for scene, _ in self._scenes
            if scene.statics is not None
        ]
        if not stated:
            return None
        from satcheck.scene.statics import joined_terms

        return joined_terms(stated)


def _own_body_rules(
    rules: Sequence[BodyRule],
    scene: SceneFile,
    ids: Mapping[str, str],
    bare: Sequence[Body | Unreadable],
) -> Iterator[BodyRule]:
    final = {id(b): ids[b.id] for b in scene.bodies} | {id(b): b.id for b in bare}
    for rule in rules:
        chosen = rule.bodies.select((*scene.bodies, *bare))
        for body in chosen:
            yield replace(rule, bodies=Selector.exactly(final[id(body)]))
        if not chosen:
            yield replace(rule, bodies=Selector.nobody())


def _own_rules(
    scene: SceneFile,
    ids: Mapping[str, str],
    bare: Sequence[Body | Unreadable],
    everybody: Sequence[Body | Unreadable],
) -> Iterator[Rule]:
    """Keeps a rule if its selectors match the same bodies in the whole check as in its file and
    among the bodies without rules. Otherwise it is expanded pair by pair."""
    known: dict[Selector, tuple[bool, list[str]]] = {}
    known_here = (*scene.bodies, *bare)
    final = {id(b): ids[b.id] for b in scene.bodies} | {id(b): b.id for b in bare}

    def chosen(selector: Selector) -> tuple[bool, list[str]]:
        """(whether it matches the same bodies in the whole check as in its file, these bodies)."""
        if selector not in known:
            own = [final[id(b)] for b in selector.select(known_here)]
            among_all = {b.id for b in selector.select(everybody)}
            known[selector] = among_all == set(own), own
        return known[selector]

    for rule in scene.rules:
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
            raise Refused("too-large", message, file=scene.path)
        else:
            yield from _written_out(rule, a, b)


def _written_out(rule: Rule, a: Sequence[str], b: Sequence[str]) -> Iterator[Rule]:
    seen = set()
    for first in a:
        for second in b:
            pair = frozenset((first, second))
            if len(pair) == 2 and pair not in seen:
                seen.add(pair)
                yield replace(rule, a=Selector.exactly(first), b=Selector.exactly(second))
