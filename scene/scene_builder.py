"""Builds a Scene from inputs. Makes ids unique, and turns unreadable inputs into Unreadables."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.scene.bodies import IDENTITY, Body, Entry, MeshFile, Scene, Unreadable
from satcheck.scene.document import Document, FilePart, Item, UniqueNames
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import multiply
from satcheck.scene.files.readers import mesh_reader
from satcheck.scene.half_spaces import with_reach
from satcheck.scene.issue import BLOCKING, Issue, issue
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.paths import suffix_of
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.scene_file.entries import SceneFile
from satcheck.scene.scene_file.joined import JoinedScenes
from satcheck.scene.units import (
    RESCALED,
    InOneUnit,
    Input,
    in_one_unit,
    ratio,
    scaled_mesh,
    scaled_world,
    stated_unit,
)

if TYPE_CHECKING:
    from satcheck.scene.planar.outline import Shape
    from satcheck.scene.robot import SceneRobot, Srdf


class Added(Struct, frozen=True):
    """A document in the check. ids: of its items. groups: in the file -> in the check."""

    document: Document
    ids: tuple[str, ...]
    groups: Mapping[str, str]


class SceneBuilder:
    """Takes documents one by one; `scene` returns their scene.

    files: reads the meshes that they name. units: of the inputs that declare none.
    """

    def __init__(self, files: MeshFiles, units: str | None) -> None:
        self._files = files
        self._given_units = units
        self._ids = UniqueNames()
        self._groups = UniqueNames()
        self._shared_groups: dict[str, str] = {}  # of documents that are no scene files or robots
        self._inputs: list[Input] = []
        self._added: list[Added] = []
        self._rule_files: set[str] = set()
        self._parted: set[str] = set()  # files of which a part is named
        self._entries: dict[str, Entry] = {}
        self._srdfs: list[Srdf] = []
        self._issues: list[Issue] = []

    def add(self, document: Document) -> None:
        """Adds the bodies of a document. A file of rules is added only once."""
        if document.kind == "rules":
            place = os.path.realpath(document.path)
            if place in self._rule_files:
                return
            self._rule_files.add(place)
        declares, is_rules = document.units, document.kind == "rules"
        unit = stated_unit(declares) or (None if is_rules else self._given_units)
        self._inputs.append(Input(document.kind, document.name, document.path, declares, unit))
        self._issues.extend(document.issues)
        groups = self._groups_of(document)
        ids = tuple(self._add(item, document, groups) for item in document.items)
        self._added.append(Added(document, ids, groups))

    def add_srdf(self, srdf: Srdf) -> None:
        self._srdfs.append(srdf)

    def _groups_of(self, document: Document) -> dict[str, str]:
        """Groups of the document -> their names in the check.

        Groups of several files are different, even if they have the same name. Those of mesh files,
        buildings and stages are one group, unless rules of the file name the group.
        """
        own = {group for rule in document.pairs if rule.of_groups for group in (rule.a, rule.b)}
        named = dict.fromkeys(group for item in document.items for group in item.groups)
        prefix = f"{document.name}: " if document.robot else ""
        if isinstance(document, SceneFile):
            named |= dict.fromkeys(sorted(document.ignore_within_groups))
        if prefix or isinstance(document, SceneFile):
            own = {*named}
        groups = {}
        for group in named:
            if group in own:
                groups[group] = self._groups.unique(f"{prefix}{group}")
            else:
                if group not in self._shared_groups:
                    self._shared_groups[group] = self._groups.unique(group)
                groups[group] = self._shared_groups[group]
        return groups

    def _add(self, item: Item, document: Document, groups: Mapping[str, str]) -> str:
        """Adds a body and returns its id. groups: from `_groups_of`."""
        id_ = self._ids.unique(item.id)
        path = document.path
        if item.entry is not None:
            self._entries[id_] = item.entry
            path = item.entry.file
        if isinstance(item.shape, FilePart):
            path, item = item.shape.path, self._in_other_file(item, item.shape)
        exact: Shape | None = None
        node = item.path
        match item.shape:
            case MeshFile() | Refused() as file:
                pass
            case FilePart() | int():
                raise AssertionError("a file names parts of others, or has its own")
            case exact:
                # A report states it by its sizes, and no node of a file.
                file, node = self._files.shape(exact, path), None
        groups_here = tuple(groups[group] for group in item.groups)
        if isinstance(file, Refused):
            # A file of shapes has many bodies: the message is about the body, not the file.
            message = str(file) if exact is None else file.message
            reason = issue(file.code, message, body=id_, file=path)
            lost = Unreadable(id_, path, reason, groups_here, node, item.static)
            self._inputs[-1].bodies.append(lost)
            return id_
        is_floor = isinstance(exact, HalfSpace)
        body = Body(
            id_,
            item.title or item.id,
            file,
            item.transform,
            groups_here,
            item.static or is_floor,
            exact,
            node,
            item.pinned or is_floor,
            stated_unit(item.units or file.units) or self._inputs[-1].unit,
            surface_tolerance=item.surface_tolerance,
        )
        self._inputs[-1].bodies.append(body)
        return id_

    def _in_other_file(self, item: Item, named: FilePart) -> Item:
        """The item with the mesh that it names, where both files together place it. What blocks a
        pass about a file is said once, whoever names a part of it."""
        found = self._files.item(named)
        if named.part is not None and named.location not in self._parted:
            self._parted.add(named.location)
            issues = self._files.issues_of_parts(named.location)
            self._issues += [each for each in issues if each.code in BLOCKING]
        if item.units and isinstance(found.shape, MeshFile) and found.shape.units == RESCALED:
            message = "`units` cannot override the unit of this file: leave it out"
            lost = Refused("unsupported-feature", message, file=named.path)
            return replace(item, path=named.part, shape=lost)
        place, own = item.transform, self._inputs[-1].unit
        if isinstance(found.shape, MeshFile) and own is not None:
            scale = ratio(stated_unit(item.units or found.shape.units) or own, own)
            if found.transform is None:
                place = scaled_mesh(place, scale)
            else:
                place = multiply(place, scaled_world(found.transform, scale))
        elif found.transform is not None:
            place = multiply(place, found.transform)
        return replace(item, path=named.part, shape=found.shape, transform=place)

    def scene(self) -> Scene:
        """Raises Refused if a rule has to be expanded into too many pairs."""
        common = in_one_unit(self._inputs)
        scene = self._bodies_and_files(common)
        bodies = {body.id: body for each in self._inputs for body in each.readable}
        robots = [_robot(each, bodies) for each in self._added if each.document.robot]
        jointed = [
            (each.document, dict(_links(each)))
            for each in self._added
            if any(joint.kind != "fixed" for joint in each.document.joints)
        ]
        if not robots and not self._srdfs and not jointed:
            return with_reach(scene)
        from satcheck.scene.robot import permissions, posed, with_srdfs
        from satcheck.scene.robot.document import robots_of_documents

        robots = with_srdfs(robots, self._srdfs)
        allowed, issues = [], list(scene.issues)
        documents, remarks = robots_of_documents(jointed, scene.bodies, common)
        issues += remarks
        for robot in robots:
            permitted, remarks = permissions(robot)
            allowed += permitted
            issues += remarks
        scene = replace(
            scene,
            robots=(*robots, *documents),
            rules=(*allowed, *scene.rules),  # so that a rule can take a permission back
            issues=tuple(issues),
        )
        return with_reach(posed(scene, {}))

    def _bodies_and_files(self, common: InOneUnit) -> Scene:
        inputs = [each for each in self._inputs if each.kind != "rules"]
        bodies = [body for each in inputs for body in each.readable]
        everyone = [body for each in inputs for body in each.bodies]
        lost = [body for body in everyone if isinstance(body, Unreadable)]
        issues = [
            *self._issues,
            *_of_lost(lost),
            *_issues_of_files(bodies),
            *common.issues,
        ]
        scene = Scene(
            name=" ".join(each.name for each in inputs),
            units=common.label,
            bodies=common.bodies,
            unreadable=tuple(lost),
            order=tuple(body.id for body in everyone),
            rules=tuple(rule for each in self._added for rule in _rules(each)),
            entries=self._entries,
            reading=self._files.allowed.options,
            composed=any(each.kind != "mesh" or len(each.bodies) > 1 for each in inputs),
            issues=(*issues, *_unclear_axes(inputs, issues)),
        )
        stated = JoinedScenes()
        for each in self._added:
            if isinstance(each.document, SceneFile):
                stated.add(each.document, each.ids, each.groups)
        if stated.are_none:
            return scene
        return _as_stated(scene, stated, common.scales, alone=len(inputs) == 1)


def _robot(added: Added, bodies: Mapping[str, Body]) -> SceneRobot:
    """bodies: that can be used, by id, as the file places them in their links."""
    from satcheck.scene.robot import RobotBody, SceneRobot

    document = added.document
    assert document.robot is not None
    own = []
    for item, id_ in zip(document.items, added.ids, strict=True):
        placed = bodies[id_].transform if id_ in bodies else item.transform
        own.append(RobotBody(id_, item.link or "", placed or IDENTITY, item.groups))
    return SceneRobot(document.robot, tuple(own), groups=added.groups)


def _links(added: Added) -> Iterator[tuple[str, str]]:
    """The bodies of rigid bodies: (id, link)."""
    for item, id_ in zip(added.document.items, added.ids, strict=True):
        if item.link:
            yield id_, item.link


def _rules(added: Added) -> Iterator[Rule]:
    """The rules of a document about its own items and groups."""
    path, pairs = added.document.path, added.document.pairs
    ids = dict(zip((item.path or "" for item in added.document.items), added.ids, strict=True))
    for rule in pairs:
        select = Selector.exactly_group if rule.of_groups else Selector.exactly
        names = added.groups if rule.of_groups else ids
        if rule.a in names and rule.b in names:
            yield Rule(
                a=select(names[rule.a]),
                b=select(names[rule.b]),
                allowed=True if rule.severity is None else None,
                severity=rule.severity,
                reason=rule.reason,
                where=f"{path}: {rule.reason}",
                file=path,
            )


def _as_stated(
    scene: Scene, stated: JoinedScenes, scales: Mapping[str, float], *, alone: bool
) -> Scene:
    """The scene with what its scene files state of all bodies. alone: they are one input."""
    everybody: list[Body | Unreadable] = [*scene.bodies, *scene.unreadable]
    body_rules = stated.body_rules(everybody, scales)
    spaces = (rule.permission for rule in body_rules if rule.region)
    return replace(
        scene,
        ignore_within_groups=frozenset(stated.ignored),
        # Those of documents and of regions first, so that a rule of a scene can override them.
        rules=(*scene.rules, *spaces, *stated.rules(everybody, scales)),
        body_rules=body_rules,
        statics=stated.statics(scales),
        check_static=stated.check_static,
        accept=stated.accepted(alone=alone),
        motions=stated.motions(scales),
    )


def _unclear_axes(inputs: Sequence[Input], issues: Sequence[Issue]) -> Iterator[Issue]:
    """A mesh file whose axis nothing turns, beside one that names no axis."""
    meshes = [each.path for each in inputs if each.kind == "mesh"]
    stated = {issue.file for issue in issues if issue.code == "up-axis"}.intersection(meshes)
    for path in meshes if stated else ():
        reader = mesh_reader(suffix_of(path))
        if path not in stated and (reader is None or reader.up is None):
            other = min(filter(None, stated))
            message = (
                f"{path} does not say which axis points up, as {other} does: nothing is turned"
            )
            yield issue("axes-unclear", message, file=other)
            return


def _of_lost(bodies: Sequence[Unreadable]) -> Iterator[Issue]:
    """One issue for each cause. Unreadable bodies with the same cause share it."""
    causes: dict[tuple[str, str | None, str], list[Issue]] = {}
    for body in bodies:
        reason = body.issue
        causes.setdefault((reason.code, reason.file, reason.message), []).append(reason)
    for first, *others in causes.values():
        yield replace(first, body=None) if others else first


def _issues_of_files(bodies: Sequence[Body]) -> list[Issue]:
    """The warnings of each file once; with the id of the body if only one body uses the file."""
    users: dict[tuple[str, str | None], list[Body]] = {}
    for body in bodies:
        users.setdefault((body.file.path, body.file.part), []).append(body)
    return [
        _shared(warning, together)
        for together in users.values()
        for warning in together[0].file.issues
    ]


def _shared(warning: Issue, bodies: list[Body]) -> Issue:
    part, message = bodies[0].file.part, warning.message
    if len(bodies) == 1:
        return replace(warning, body=bodies[0].id)
    return warning if part is None else replace(warning, message=f"mesh {part!r}: {message}")
