"""Builds a Scene from inputs. Makes ids unique, and turns unreadable inputs into Unreadables."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.scene.bodies import Body, Entry, MeshFile, Scene, Unreadable
from satcheck.scene.common_units import (
    InOneUnit,
    Input,
    Kind,
    in_one_unit,
    scaled_mesh,
    scaled_world,
)
from satcheck.scene.errors import Refused
from satcheck.scene.format.entries import BodyEntry, SceneFile
from satcheck.scene.format.joined import JoinedScenes
from satcheck.scene.half_spaces import with_reach
from satcheck.scene.issue import BLOCKING, Issue, issue
from satcheck.scene.loading.nodes import Node, Nodes, Split, document_rules, groups_of
from satcheck.scene.loading.placing import multiply
from satcheck.scene.loading.readers import mesh_reader
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.plain_ids import COMPONENT_MARK, UniqueNames
from satcheck.scene.read_options import GeometryKind
from satcheck.scene.rules import Rule
from satcheck.scene.units import RESCALED, ratio, stated_unit

if TYPE_CHECKING:
    from satcheck.scene.robot import Part, SceneRobot, Srdf
    from satcheck.scene.robot.document import Jointed

ROBOT_UNITS = "m"  # of every URDF, SDFormat and MJCF file


class SceneBuilder:
    """Takes inputs one by one; `scene` returns their scene.

    files: reads their meshes. units: of the inputs that declare none.
    """

    def __init__(self, files: MeshFiles, units: str | None) -> None:
        self._files = files
        self._given_units = units
        self._ids = UniqueNames()
        self._groups = UniqueNames()
        self._shared_groups: dict[str, str] = {}  # of documents
        self._inputs: list[Input] = []
        self._scenes: JoinedScenes | None = None
        self._rule_files: set[str] = set()
        self._parted: set[Path] = set()  # files of which a part is named
        self._entries: dict[str, Entry] = {}
        self._robots: list[SceneRobot] = []
        self._srdfs: list[Srdf] = []
        self._issues: list[Issue] = []
        self._document_rules: list[Rule] = []
        self._jointed: list[Jointed] = []

    def add_file(self, kind: Kind, id_: str, path: str, split: Split, alone: bool) -> None:
        """Adds a mesh file or a document. alone: the paths of nodes are ids, without the id of the
        file before them."""
        location = Path(path)
        name = location.stem or path
        nodes = self._files.nodes(path, location, split)
        if isinstance(nodes, Refused):
            nodes = Nodes({None: Node(None, nodes)})
        self._issues.extend(nodes.issues)
        files = [node.file for node in nodes.nodes.values()]
        units = next((file.units for file in files if isinstance(file, MeshFile)), None)
        self._begin(kind, name, path, units)
        groups = groups_of(nodes, self._groups, self._shared_groups)
        ids = {}
        for place, node in nodes.nodes.items():
            wanted = _node_id(place, id_, alone)
            title = node.title or (wanted if place else name)
            # A report states an exact shape by its sizes, and no node of a file.
            own = replace(
                node,
                path=place if node.shape is None else None,
                title=title,
                groups=tuple(groups[group] for group in node.groups),
            )
            ids[place] = self._add(wanted, path, own)
        self._document_rules += document_rules(nodes, ids, groups, path)
        if any(joint.kind != "fixed" for joint in nodes.joints):
            from satcheck.scene.robot.document import Jointed

            links = {ids[place]: node.link for place, node in nodes.nodes.items() if node.link}
            self._jointed.append(Jointed(path, nodes.joints, links))

    def add_scene(self, scene: SceneFile) -> None:
        """Adds a scene file. One without bodies is a file of rules, which is added only once."""
        path = scene.path
        if not scene.bodies:
            place = os.path.realpath(path)
            if place in self._rule_files:
                return
            self._rule_files.add(place)
        self._begin("scene" if scene.bodies else "rules", scene.name, path, scene.units)
        self._scenes = self._scenes or JoinedScenes(self._groups)
        groups = self._scenes.groups_of(scene)
        ids = {entry.id: self._add_entry(entry, groups, path) for entry in scene.bodies}
        self._scenes.add(scene, ids, groups)
        places = enumerate(ids.values())
        self._entries |= {id_: Entry(path, number=number) for number, id_ in places}
        self._issues.extend(scene.issues)

    def _add_entry(self, entry: BodyEntry, names: Mapping[str, str], path: str) -> str:
        """names: group in the file -> group in the check. path: of the scene file."""
        transform = entry.transform
        if entry.shape is not None:
            node = Node(None, self._files.shape(entry.shape, path), None, entry.shape)
        else:
            path = entry.mesh.path
            node = self._part(path, entry.mesh.location, entry.part)
            if entry.units and isinstance(node.file, MeshFile) and node.file.units == RESCALED:
                message = "`units` cannot override the unit of this file: leave it out"
                node = replace(node, file=Refused("unsupported-feature", message, file=path))
            scale = self._scale(node.file, entry.units)
            if entry.part is None:
                transform = scaled_mesh(transform, scale)
            else:
                transform = multiply(transform, scaled_world(node.transform, scale))
        own = Node(
            entry.part if node.shape is None else None,
            node.file,
            transform,
            node.shape,
            groups=tuple(names[group] for group in entry.groups),
            static=entry.static,
            pinned=entry.pinned,
            units=entry.units,
            surface_tolerance=entry.surface_tolerance,
        )
        return self._add(entry.id, path, own)

    def add_robot(
        self,
        path: str,
        location: Path,
        packages: Mapping[str, str | Path] | None,
        geometry: GeometryKind,
    ) -> None:
        from satcheck.scene.robot import (
            FilePlaces,
            RobotBody,
            SceneRobot,
            bare_links,
            parts_of,
        )

        places = FilePlaces(path, packages, self._files.allowed.permitted)
        robot, issues = self._files.robot(path, location, places, packages or {}, geometry)
        self._begin("robot", robot.name, path, ROBOT_UNITS)
        self._issues += [*issues, *bare_links(robot)]
        parts = parts_of(robot, places)
        groups = self._groups_of(robot.name, parts)
        bodies = []
        for part in parts:
            own = tuple(groups[group] for group in part.groups)
            place, shape, offset = part.file, None, part.offset
            file: MeshFile | Refused
            if isinstance(part.source, Path):
                place = part.source.as_posix()
                file = self._part(place, part.source, part.piece).file
                offset = scaled_mesh(offset, self._scale(file, None)) or offset
            elif isinstance(part.source, Refused):
                file = part.source
            else:
                shape = part.source
                file = self._files.shape(shape, place)
            node = Node(part.piece, file, offset, shape, groups=own, static=part.static)
            id_ = self._add(part.id, place, node)
            self._entries[id_] = Entry(part.file, line=part.line)
            bodies.append(RobotBody(id_, part.link, offset, part.groups))
        self._robots.append(SceneRobot(robot, tuple(bodies), groups=groups))

    def _part(self, path: str, location: Path, part: str | None) -> Node:
        """A part of a file, or all of it. What blocks a pass about the file is said once, whoever
        names a part of it."""
        node = self._files.node(path, location, part)
        if part is not None and location not in self._parted:
            self._parted.add(location)
            issues = self._files.issues_of_parts(location)
            self._issues += [each for each in issues if each.code in BLOCKING]
        return node

    def _groups_of(self, robot: str, parts: Sequence[Part]) -> dict[str, str]:
        """Groups of a robot -> their names in the check."""
        groups = dict.fromkeys(group for part in parts for group in part.groups)
        return {group: self._groups.unique(f"{robot}: {group}") for group in groups}

    def add_srdf(self, path: str, location: Path) -> None:
        from satcheck.scene.robot import read_srdf

        self._srdfs.append(read_srdf(path, location))

    def _begin(self, kind: Kind, name: str, path: str, declares: str | None) -> None:
        """Starts an input. The bodies that follow belong to it."""
        unit = stated_unit(declares) or (None if kind == "rules" else self._given_units)
        self._inputs.append(Input(kind, name, path, declares, unit))

    def _scale(self, file: MeshFile | Refused, units: str | None) -> float:
        """The factor from the unit of the mesh file to the unit of the input. units: override the
        unit that the file states."""
        own = self._inputs[-1].unit
        if isinstance(file, Refused) or own is None:
            return 1.0
        return ratio(stated_unit(units or file.units) or own, own)

    def _add(self, wanted: str, path: str, node: Node) -> str:
        """Adds a body and returns its id. path: of the file that it is about. The placement is that
        of coordinates of the file; the units override what the file states."""
        id_ = self._ids.unique(wanted)
        file, is_floor = node.file, isinstance(node.shape, HalfSpace)
        if isinstance(file, Refused):
            # A file of shapes has many bodies: the message is about the body, not the file.
            message = str(file) if node.shape is None else file.message
            reason = issue(file.code, message, body=id_, file=path)
            lost = Unreadable(id_, path, reason, node.groups, node.path, node.static)
            self._inputs[-1].bodies.append(lost)
            return id_
        body = Body(
            id_,
            node.title or wanted,
            file,
            node.transform,
            node.groups,
            node.static or is_floor,
            node.shape,
            node.path,
            node.pinned or is_floor,
            stated_unit(node.units or file.units) or self._inputs[-1].unit,
            surface_tolerance=node.surface_tolerance,
        )
        self._inputs[-1].bodies.append(body)
        return id_

    def scene(self) -> Scene:
        """Raises Refused if a rule has to be expanded into too many pairs."""
        common = in_one_unit(self._inputs)
        scene = self._bodies_and_files(common)
        if not self._robots and not self._srdfs and not self._jointed:
            return with_reach(scene)
        from satcheck.scene.robot import permissions, posed, with_srdfs
        from satcheck.scene.robot.document import robots_of_documents

        robots = with_srdfs(self._robots, self._srdfs)
        allowed, issues = [], list(scene.issues)
        documents, remarks = robots_of_documents(self._jointed, scene.bodies, common)
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
            rules=tuple(self._document_rules),
            entries=self._entries,
            reading=self._files.allowed.options,
            composed=any(each.kind != "mesh" or len(each.bodies) > 1 for each in inputs),
            issues=(*issues, *_unclear_axes(inputs, issues)),
        )
        if self._scenes is None:
            return scene
        return _as_stated(scene, self._scenes, common.scales, alone=len(inputs) == 1)


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
    for path in meshes:
        reader = mesh_reader(Path(path).suffix)
        if stated and path not in stated and (reader is None or reader.up is None):
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


def _node_id(path: str | None, file_id: str, alone: bool) -> str:
    if path is None:
        return file_id
    if path.startswith(COMPONENT_MARK):  # of a file without nodes
        return file_id + path
    return path if alone else f"{file_id}/{path.removeprefix('/')}"


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
