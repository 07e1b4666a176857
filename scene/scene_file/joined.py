"""Joins several scene files and other inputs into one scene.

Motions and groups of a file apply to its own bodies. Its rules apply to these, and to mesh files
and robots, which have no rules of their own. The rules of a file without bodies apply to all
bodies.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from functools import cache
from itertools import product
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.scene.bodies import Accepted, Body, Scene, Unreadable
from satcheck.scene.document import Document, FilePart
from satcheck.scene.errors import Refused
from satcheck.scene.motion import Motion, scaled_motion
from satcheck.scene.rules import Rule, Selectable, Selector, stated_keys
from satcheck.scene.statics import KEYS, BodyRule, StaticsTerms, joined_terms
from satcheck.scene.words import with_closed_brackets

if TYPE_CHECKING:
    from satcheck.scene.building import Input

Bodies = Sequence[Body | Unreadable]

MOST_PAIRS = 100_000  # of a rule that is expanded pair by pair


class SceneFile(Document, frozen=True, kw_only=True):
    """A document whose items have ids, and name mesh files or state shapes. Rules and motions
    refer to bodies of this file only. reading: the options with which its mesh files are read, by
    their names. accept: issues that may stay."""

    has_own_groups = True
    check_static: bool
    rules: tuple[Rule, ...]
    motions: tuple[Motion, ...] = ()
    body_rules: tuple[BodyRule, ...] = ()
    statics: StaticsTerms | None = None
    reading: Mapping[str, Any] = {}
    accept: tuple[str, ...] = ()


class Joined(Struct, frozen=True):
    """A scene file in a check. ids, groups: in the file -> in the check. scale: the factor of its
    lengths."""

    file: SceneFile
    ids: Mapping[str, str]
    groups: Mapping[str, str]
    scale: float

    def accepted(self, *, alone: bool) -> Iterator[Accepted]:
        """Issues that may stay. alone: no input stands beside the file. What a file without bodies
        accepts counts for all, as its rules do."""
        items = self.file.items
        files = (item.shape.path for item in items if isinstance(item.shape, FilePart))
        names = frozenset((self.file.path, *self.ids.values(), *files))
        for text in self.file.accept:
            yield Accepted(text, None if alone or not items else names)

    def motions(self) -> Iterator[Motion]:
        for motion in self.file.motions:
            ids = tuple(self.ids[id_] for id_ in motion.bodies)
            yield scaled_motion(replace(motion, bodies=ids), self.scale)

    def is_everything(self, everybody: Bodies) -> bool:
        """Whether its selectors select the same in the check as in the file."""
        return len(everybody) == len(self.file.items) or not self.file.items

    def chosen(self, selector: Selector, bare: Bodies) -> list[str]:
        """The ids of its own bodies, and of those without rules, that it selects."""
        final = {id(item): self.ids[item.id] for item in self.file.items}
        bodies: list[Selectable] = [*self.file.items, *bare]
        return [final.get(id(body), body.id) for body in selector.select(bodies)]

    def rules(self, everybody: Bodies, bare: Bodies) -> Iterator[Rule]:
        """Keeps a rule if its selectors match the same bodies in the whole check as in its file and
        among the bodies without rules. Otherwise it is expanded pair by pair. Raises Refused for
        too many pairs."""

        @cache
        def chosen(selector: Selector) -> tuple[bool, list[str]]:
            """(whether it matches the same bodies in the whole check, these bodies)."""
            ids = self.chosen(selector, bare)
            return {body.id for body in selector.select(everybody)} == set(ids), ids

        for rule in (rule.scaled(self.scale) for rule in self.file.rules):
            if self.is_everything(everybody):
                yield rule
                continue
            (a_stays, a), (b_stays, b) = chosen(rule.a), chosen(rule.b)
            if a_stays and b_stays:
                yield rule
            elif not a or not b:
                yield replace(rule, a=Selector.nobody())  # the check then warns of it
            elif len(a) * len(b) > MOST_PAIRS:
                message = (
                    f"{rule.name}: beside the other inputs this rule has to be written out for "
                    f"{len(a) * len(b)} pairs; check this scene alone, or select fewer bodies"
                )
                raise Refused("too-large", message, file=self.file.path)
            else:
                pairs: dict[frozenset[str], tuple[str, str]] = {}
                for pair in product(a, b):
                    pairs.setdefault(frozenset(pair), pair)
                for first, second in pairs.values():
                    if first != second:
                        yield replace(rule, a=Selector.exactly(first), b=Selector.exactly(second))

    def body_rules(self, everybody: Bodies, bare: Bodies) -> Iterator[BodyRule]:
        """A rule about some files, and any rule beside other inputs, is written out body by
        body."""
        files = {
            body.id: body.file if isinstance(body, Unreadable) else body.file.path
            for body in everybody
        }
        for rule in (rule.scaled(self.scale) for rule in self.file.body_rules):
            is_everything = self.is_everything(everybody)
            if rule.asset is None and is_everything:
                yield rule
                continue
            ids = (
                [body.id for body in rule.bodies.select(everybody)]
                if is_everything
                else (self.chosen(rule.bodies, bare))
            )
            if rule.asset is not None:
                ids = [id_ for id_ in ids if _is_of(files[id_], rule.asset)]
            for selector in [*map(Selector.exactly, ids)] or [Selector.nobody()]:
                yield replace(rule, bodies=selector, asset=None)


def _is_of(file: str, pattern: str) -> bool:
    glob = with_closed_brackets(pattern)
    return any(fnmatchcase(name, glob) for name in (file, PurePosixPath(file).name))


def joined(scene: Scene, inputs: Sequence[Input], scales: Mapping[str, float]) -> Scene:
    """The scene with what its scene files state. scales: path of a file -> the factor of its
    lengths. Raises Refused if a rule has to be expanded into too many pairs, and SatcheckError if
    they differ."""
    files = [
        Joined(
            each.document,
            {item.id: id_ for item, id_ in each.named()},
            each.groups,
            scales.get(each.document.path, 1.0),
        )
        for each in inputs
        if isinstance(each.document, SceneFile)
    ]
    if not files:
        return scene
    alone = sum(each.document.kind != "rules" for each in inputs) == 1
    everybody: Bodies = [*scene.bodies, *scene.unreadable]
    placed = {id_ for each in files for id_ in each.ids.values()}
    bare = [body for body in everybody if body.id not in placed]
    rules = [rule for each in files for rule in each.rules(everybody, bare)]
    body_rules = [rule for each in files for rule in each.body_rules(everybody, bare)]
    opened: dict[str, bool] = {}
    for rule in body_rules:
        if rule.open is not None:
            opened |= dict.fromkeys((body.id for body in rule.bodies.select(everybody)), rule.open)
    body_rules = [rule for rule in body_rules if stated_keys(rule, KEYS)]
    spaces = (rule.permission for rule in body_rules if rule.region)
    terms = [
        each.file.statics.scaled(each.scale) for each in files if each.file.statics is not None
    ]
    ignored = (each.groups[name] for each in files for name in each.file.ignore_within_groups)
    return replace(
        scene,
        bodies=tuple(
            replace(body, open=True) if opened.get(body.id) else body for body in scene.bodies
        )
        if opened
        else scene.bodies,
        ignore_within_groups=frozenset(ignored),
        # Those of documents and of regions first, so that a rule of a scene can override them.
        rules=(*scene.rules, *spaces, *rules),
        body_rules=tuple(body_rules),
        statics=joined_terms(terms) if terms else None,
        check_static=any(each.file.check_static for each in files),
        accept=tuple(each for file in files for each in file.accepted(alone=alone)),
        motions=tuple(motion for each in files for motion in each.motions()),
    )
