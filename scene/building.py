"""Makes one scene of documents: with unique ids and groups, in one unit, with all issues."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.scene.bodies import Body, Entry, MeshFile, Scene, Unreadable
from satcheck.scene.document import COMPONENT_MARK, Document, FilePart, Held, Item, UniqueNames
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import multiply
from satcheck.scene.files.readers import mesh_reader
from satcheck.scene.issue import BLOCKING, Issue, issue
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.opening import suffix_of
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.units import (
    RESCALED,
    InOneUnit,
    in_one_unit,
    ratio,
    scaled_mesh,
    scaled_world,
    stated_unit,
)

if TYPE_CHECKING:
    from satcheck.core.transform import Transform
    from satcheck.scene.planar.outline import Shape
    from satcheck.scene.robot import Srdf


class Input(Struct):
    """A document in the check.

    unit: meant by the units that it declares, or given for inputs that declare none; None: unknown.
    groups: in the file -> in the check. file_id: of items without an id, before the paths of their
    nodes. alone: these paths are the ids. ids: of its items in the check. bodies: of these items.
    """

    document: Document
    unit: str | None
    groups: Mapping[str, str]
    file_id: str
    alone: bool
    ids: list[str] = []
    bodies: list[Body | Unreadable] = []

    @property
    def readable(self) -> list[Body]:
        """Return the bodies that can be used."""
        return [body for body in self.bodies if isinstance(body, Body)]

    def named(self) -> Iterator[tuple[Item, str]]:
        """Return its items, each with its id in the check."""
        return zip(self.document.items, self.ids, strict=True)

    def id_of(self, item: Item) -> str:
        """Return the id that is wanted for an item."""
        if item.id or item.path is None:
            return item.id or self.file_id
        if item.path.startswith(COMPONENT_MARK):  # of a file without nodes
            return self.file_id + item.path
        return item.path if self.alone else f"{self.file_id}/{item.path.removeprefix('/')}"


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
        self._rule_files: set[str] = set()
        self._parted: set[str] = set()  # files of which a part is named
        # What is known of a mesh that an item names, by the unit of the item and of its document.
        self._named: dict[tuple[FilePart, str | None, str | None], tuple[Item, float]] = {}
        self._entries: dict[str, Entry] = {}
        self._srdfs: list[Srdf] = []
        self._issues: list[Issue] = []

    def add(self, document: Document, file_id: str = "", *, alone: bool = False) -> None:
        """Adds the bodies of a document. A file of rules is added only once. file_id, alone: as in
        `Input`."""
        if document.kind == "rules":
            place = os.path.realpath(document.path)
            if place in self._rule_files:
                return
            self._rule_files.add(place)
        given = None if document.kind == "rules" else self._given_units
        unit = stated_unit(document.units) or given
        own = Input(document, unit, self._groups_of(document), file_id, alone)
        self._inputs.append(own)
        self._issues.extend(document.issues)
        own.ids += [self._add(item, own) for item in document.items]

    def add_srdf(self, srdf: Srdf) -> None:
        self._srdfs.append(srdf)

    def _groups_of(self, document: Document) -> dict[str, str]:
        """Groups of the document -> their names in the check.

        Groups of several files are different, even if they have the same name. Those of mesh files,
        buildings and stages are one group, unless rules of the file name the group.
        """
        named = dict.fromkeys(group for item in document.items for group in item.groups)
        named |= dict.fromkeys(sorted(document.ignore_within_groups))
        if not named:
            return {}
        own = {group for rule in document.pairs if rule.of_groups for group in (rule.a, rule.b)}
        prefix = f"{document.name}: " if document.robot else ""
        if document.has_own_groups:
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

    def _add(self, item: Item, own: Input) -> str:
        """Adds a body of this input and returns its id."""
        wanted, path = own.id_of(item), own.document.path
        id_ = self._ids.unique(wanted)
        if item.entry is not None:
            self._entries[id_] = item.entry
            path = item.entry.file
        shape, transform, node = item.shape, item.transform, item.path
        if isinstance(shape, FilePart):
            path, node = shape.path, shape.part
            shape, transform = self._in_other_file(item, shape, own.unit)
        is_named = item.id or node
        exact: Shape | None = None
        match shape:
            case MeshFile() | Refused() as file:
                pass
            case FilePart() | int():
                raise AssertionError("a file names parts of others, or has its own")
            case exact:
                # A report states it by its sizes, and no node of a file.
                file, node = self._files.shape(exact, path), None
        groups_here = tuple(map(own.groups.__getitem__, item.groups))
        if isinstance(file, Refused):
            # A file of shapes has many bodies: the message is about the body, not the file.
            message = str(file) if exact is None else file.message
            reason = issue(file.code, message, body=id_, file=path)
            lost = Unreadable(id_, path, reason, groups_here, node, item.static, item.link)
            own.bodies.append(lost)
            return id_
        is_floor = isinstance(exact, HalfSpace)
        body = Body(
            id_,
            item.title or (wanted if is_named else own.document.name),
            file,
            transform,
            groups_here,
            item.static or is_floor,
            exact,
            node,
            item.pinned or is_floor,
            stated_unit(item.units or file.units) or own.unit,
            surface_tolerance=item.surface_tolerance,
            link=item.link,
        )
        own.bodies.append(body)
        return id_

    def _in_other_file(
        self, item: Item, named: FilePart, own: str | None
    ) -> tuple[Held, Transform | None]:
        """The mesh that an item names, and where both files together place it. own: the unit of its
        document."""
        key = named, item.units, own
        if key not in self._named:
            self._named[key] = self._named_mesh(*key)
        found, scale = self._named[key]
        if found.transform is None:
            return found.shape, scaled_mesh(item.transform, scale)
        return found.shape, multiply(item.transform, scaled_world(found.transform, scale))

    def _named_mesh(
        self, named: FilePart, units: str | None, own: str | None
    ) -> tuple[Item, float]:
        """The mesh that a file names, where its own file places it, and the factor of its lengths.
        units: that override its own; own: the unit of the document. What blocks a pass about a file
        is said once, whoever names a part of it."""
        found = self._files.item(named)
        if named.part is not None and named.location not in self._parted:
            self._parted.add(named.location)
            issues = self._files.issues_of_parts(named.location)
            self._issues += [each for each in issues if each.code in BLOCKING]
        if not isinstance(found.shape, MeshFile):
            return found, 1.0
        if units and found.shape.units == RESCALED:
            message = "`units` cannot override the unit of this file: leave it out"
            return Item(Refused("unsupported-feature", message, file=named.path)), 1.0
        scale = 1.0 if own is None else ratio(stated_unit(units or found.shape.units) or own, own)
        return found, scale

    def scene(self) -> Scene:
        """Raises Refused if a rule has to be expanded into too many pairs."""
        common = in_one_unit(self._inputs)
        scene = self._bodies_and_files(common)
        if self._srdfs or any(each.document.moves for each in self._inputs):
            from satcheck.scene.robot.joined import with_robots

            scene = with_robots(scene, self._inputs, self._srdfs, common)
        return scene.reaching()

    def _bodies_and_files(self, common: InOneUnit) -> Scene:
        inputs = [each for each in self._inputs if each.document.kind != "rules"]
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
            name=" ".join(each.document.name for each in inputs),
            units=common.label,
            bodies=common.bodies,
            unreadable=tuple(lost),
            order=tuple(body.id for body in everyone),
            rules=tuple(
                rule for each in self._inputs if each.document.pairs for rule in _rules(each)
            ),
            entries=self._entries,
            reading=self._files.allowed.options,
            composed=any(each.document.kind != "mesh" or len(each.bodies) > 1 for each in inputs),
            issues=(*issues, *_unclear_axes(inputs, issues)),
        )
        if not any(each.document.kind in ("scene", "rules") for each in self._inputs):
            return scene
        from satcheck.scene.scene_file.joined import joined

        return joined(scene, self._inputs, common.scales)


def _rules(added: Input) -> Iterator[Rule]:
    """The rules of a document about its own items and groups."""
    path, pairs = added.document.path, added.document.pairs
    ids = {item.path or "": id_ for item, id_ in added.named()}
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


def _unclear_axes(inputs: Sequence[Input], issues: Sequence[Issue]) -> Iterator[Issue]:
    """A mesh file whose axis nothing turns, beside one that names no axis."""
    meshes = [each.document.path for each in inputs if each.document.kind == "mesh"]
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
        if body.file.issues:
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
