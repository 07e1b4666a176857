"""Builds a Scene from inputs. Makes ids unique, and turns unreadable inputs into Unreadables."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from msgspec.structs import replace

from satcheck.core.shapes import HalfSpace
from satcheck.core.transform import Transform
from satcheck.scene.bodies import Body, Entry, MeshFile, Scene, Unreadable
from satcheck.scene.common_units import (
    InOneUnit,
    Input,
    Kind,
    in_one_unit,
    scaled_mesh,
    scaled_world,
)
from satcheck.scene.document_rules import DocumentGroups, document_rules, jointed
from satcheck.scene.errors import MeshFileError
from satcheck.scene.format.entries import BodyEntry, SceneFile
from satcheck.scene.format.joined import JoinedScenes
from satcheck.scene.half_spaces import with_reach
from satcheck.scene.issue import BLOCKING, Issue, issue
from satcheck.scene.loading.nodes import Node
from satcheck.scene.loading.placing import multiply
from satcheck.scene.loading.readers import mesh_reader
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.permitted import Permitted
from satcheck.scene.plain_ids import COMPONENT_MARK, UniqueNames
from satcheck.scene.planar.outline import Shape
from satcheck.scene.read_options import GeometryKind, ReadOptions
from satcheck.scene.rules import Rule
from satcheck.scene.units import ratio, stated_unit

if TYPE_CHECKING:
    from satcheck.scene.document_rules import Jointed
    from satcheck.scene.robot import Part, SceneRobot, Srdf
    from satcheck.scene.statics import BodyRule

Split = Literal["nodes", "components", "none"]

ROBOT_UNITS = "m"  # of every URDF, SDFormat and MJCF file


class SceneBuilder:
    """Takes inputs one by one; `scene` returns their scene.

    files: reads their meshes, with the options `reading`. units: of the inputs that declare none.
    """

    def __init__(self, files: MeshFiles, units: str | None, reading: ReadOptions) -> None:
        self._files = files
        self._reading = reading
        self._given_units = units
        self._ids = UniqueNames()
        self._group_names = UniqueNames()
        self._order: list[str] = []
        self._names: list[str] = []
        self._inputs: list[Input] = []
        self._rule_units: dict[str, str | None] = {}  # of files of rules, as declared
        self._only_meshes = True
        self._bodies: list[Body] = []
        self._unreadable: list[Unreadable] = []
        self._scenes: JoinedScenes | None = None
        self._rule_files: set[str] = set()
        self._taken_apart = False
        self._parted: set[Path] = set()  # files of which a part is named
        self._entries: dict[str, Entry] = {}
        self._robots: list[SceneRobot] = []
        self._srdfs: list[Srdf] = []
        self._issues: list[Issue] = []
        self._document_rules: list[Rule] = []
        self._jointed: list[Jointed] = []
        self._document_groups = DocumentGroups(self._group_names)

    def add_mesh(self, id_: str, path: str, location: Path) -> None:
        name = location.stem or path
        self._names.append(name)
        file = self._files.whole(path, location)
        self._begin("mesh", path, file.units if isinstance(file, MeshFile) else None)
        self._add(id_, name, path, file, None)

    def add_nodes(self, id_: str, path: str, location: Path, split: Split, alone: bool) -> None:
        """alone: the paths of nodes are ids, without the id of the file before them."""
        name = location.stem or path
        self._names.append(name)
        parts = self._files.nodes(path, location, components=split == "components")
        if isinstance(parts, MeshFileError):
            self._begin("mesh", path, None)
            self._add(id_, name, path, parts, None)
            return
        self._issues.extend(parts.issues)
        self._taken_apart |= len(parts.nodes) > 1
        units = (node.file.units for node in parts.nodes if isinstance(node.file, MeshFile))
        self._begin("mesh", path, next(units, None))
        groups = self._document_groups.of(parts)
        ids = {}
        for node in parts.nodes:
            wanted = _node_id(node.path, id_, alone)
            title = wanted if node.path else name
            own = tuple(groups[group] for group in node.groups)
            place = node.path if node.shape is None else None  # as in a document
            ids[node.path] = self._add(
                wanted, title, path, node.file, node.transform, own, shape=node.shape, node=place
            )
        self._document_rules += document_rules(parts, ids, groups, path)

    def add_document(self, id_: str, path: str, location: Path, alone: bool) -> None:
        """alone: as in `add_nodes`."""
        name = location.stem or path
        self._names.append(name)
        self._only_meshes = False
        nodes = self._files.nodes(path, location, components=False)
        if isinstance(nodes, MeshFileError):
            self._begin("scene", path, None)
            self._add(id_, name, path, nodes, None)
            return
        self._issues.extend(nodes.issues)
        units = (node.file.units for node in nodes.nodes if isinstance(node.file, MeshFile))
        self._begin("scene", path, next(units, None))
        groups = self._document_groups.of(nodes)
        ids = {}
        for node in nodes.nodes:
            wanted = _node_id(node.path, id_, alone)
            own = tuple(groups[group] for group in node.groups)
            # A report states an exact shape by its sizes, and no node of a file.
            place = node.path if node.shape is None else None
            ids[node.path] = self._add(
                wanted, node.title or wanted, path, node.file, node.transform, own, node.static,
                node.shape, place,
            )  # fmt: skip
        self._document_rules += document_rules(nodes, ids, groups, path)
        self._jointed += jointed(nodes, ids, path)

    def add_scene(self, scene: SceneFile) -> None:
        """Adds a scene file. One without bodies is a file of rules, which is added only once."""
        path = scene.path
        if not scene.bodies:
            place = os.path.realpath(path)
            if place in self._rule_files:
                return
            self._rule_files.add(place)
            self._rule_units[path] = scene.units
        else:
            self._names.append(scene.name)
            self._only_meshes = False
            self._begin("scene", path, scene.units)
        self._scenes = self._scenes or JoinedScenes(self._group_names)
        groups = self._scenes.groups_of(scene)
        ids = {entry.id: self._add_entry(entry, groups, path) for entry in scene.bodies}
        self._scenes.add(scene, ids, groups)
        places = enumerate(ids.values())
        self._entries |= {id_: Entry(path, number=number) for number, id_ in places}
        self._issues.extend(scene.issues)

    def _add_entry(self, entry: BodyEntry, names: Mapping[str, str], path: str) -> str:
        """names: group in the file -> group in the check. path: of the scene file."""
        file: MeshFile | MeshFileError
        transform, shape, part = entry.transform, entry.shape, entry.part
        if entry.shape is not None:
            file = self._files.shape(entry.shape, path)
        else:
            path = entry.mesh.path
            if entry.part is None:
                file = self._files.whole(path, entry.mesh.location)
                transform = scaled_mesh(transform, self._scale(file, entry.units))
            else:
                node = self._part(path, entry.mesh.location, entry.part)
                if isinstance(node, MeshFileError):
                    file, transform = node, None
                else:
                    file, shape = node.file, node.shape
                    scale = self._scale(file, entry.units)
                    transform = multiply(transform, scaled_world(node.transform, scale))
                    part = entry.part if shape is None else None
        return self._add(
            entry.id,
            entry.id,
            path,
            file,
            transform,
            tuple(names[group] for group in entry.groups),
            entry.static,
            shape,
            part,
            entry.pinned,
            entry.units,
            entry.surface_tolerance,
        )

    def add_robot(
        self,
        path: str,
        location: Path,
        packages: Mapping[str, str | Path] | None,
        permitted: Permitted,
        geometry: GeometryKind,
    ) -> None:
        from satcheck.scene.robot import (
            FilePlaces,
            RobotBody,
            SceneRobot,
            bare_links,
            parts_of,
        )

        places = FilePlaces(path, packages, permitted)
        hulls = bool(self._reading.mesh_hulls)
        robot, issues = self._files.robot(path, location, places, packages, geometry, hulls=hulls)
        self._names.append(robot.name)
        self._only_meshes = False
        self._begin("robot", path, ROBOT_UNITS)
        self._issues += [*issues, *bare_links(robot)]
        parts = parts_of(robot, places)
        groups = self._groups_of(robot.name, parts)
        bodies = []
        for part in parts:
            own = tuple(groups[group] for group in part.groups)
            place, shape, offset = part.file, None, part.offset
            if isinstance(part.source, Path):
                place = part.source.as_posix()
                file = self._mesh(place, part.source, part.piece)
                offset = self._in_metres(file, offset)
            elif isinstance(part.source, MeshFileError):
                file = part.source
            else:
                shape = part.source
                file = self._files.shape(shape, place)
            id_ = self._add(
                part.id, part.id, place, file, offset, own, part.static, shape, part.piece
            )
            self._entries[id_] = Entry(part.file, line=part.line)
            bodies.append(RobotBody(id_, part.link, offset, part.groups))
        self._robots.append(SceneRobot(robot, tuple(bodies), groups=groups))

    def _mesh(self, path: str, location: Path, piece: str | None) -> MeshFile | MeshFileError:
        """piece: a part of the file; None: the whole."""
        if piece is None:
            return self._files.whole(path, location)
        node = self._part(path, location, piece)
        return node if isinstance(node, MeshFileError) else node.file

    def _part(self, path: str, location: Path, part: str) -> Node | MeshFileError:
        """A part of a file. What blocks a pass about the file is said once, whoever names a part
        of it."""
        node = self._files.part(path, location, part)
        if location not in self._parted:
            self._parted.add(location)
            issues = self._files.issues_of_parts(location)
            self._issues += [each for each in issues if each.code in BLOCKING]
        return node

    def _groups_of(self, robot: str, parts: Sequence[Part]) -> dict[str, str]:
        """Groups of a robot -> their names in the check."""
        groups = dict.fromkeys(group for part in parts for group in part.groups)
        return {group: self._group_names.unique(f"{robot}: {group}") for group in groups}

    def _in_metres(self, file: MeshFile | MeshFileError, offset: Transform) -> Transform:
        return scaled_mesh(offset, self._scale(file, None)) or offset

    def add_srdf(self, path: str, location: Path) -> None:
        from satcheck.scene.robot import read_srdf

        self._srdfs.append(read_srdf(path, location))

    def _begin(self, kind: Kind, path: str, declares: str | None) -> None:
        """Starts an input. The bodies that follow belong to it."""
        self._inputs.append(Input(kind, path, declares, self._given_units))

    def _scale(self, file: MeshFile | MeshFileError, units: str | None) -> float:
        """The factor from the unit of the mesh file to the unit of the input. units: override the
        unit that the file states."""
        own = self._inputs[-1].unit
        if isinstance(file, MeshFileError) or own is None:
            return 1.0
        return ratio(stated_unit(units or file.units) or own, own)

    def _add(
        self,
        wanted: str,
        name: str,
        path: str,
        file: MeshFile | MeshFileError,
        transform: Transform | None,
        groups: tuple[str, ...] = (),
        static: bool = False,
        shape: Shape | None = None,
        node: str | None = None,
        pinned: bool = False,
        units: str | None = None,
        surface_tolerance: float | None = None,
    ) -> str:
        """transform: of coordinates of the file. units: of these; they override what the file
        states."""
        id_ = self._ids.unique(wanted)
        self._order.append(id_)
        self._inputs[-1].ids.append(id_)
        if isinstance(file, MeshFile):
            own = stated_unit(units or file.units) or self._inputs[-1].unit
            if isinstance(shape, HalfSpace):
                static = pinned = True
            body = Body(id_, name, file, transform, groups, static, shape, node, pinned, own)
            self._bodies.append(replace(body, surface_tolerance=surface_tolerance))
        else:
            # A file of shapes has many bodies: the message is about the body, not the file.
            message = str(file) if shape is None else file.message
            reason = issue(file.code, message, body=id_, file=path)
            self._unreadable.append(Unreadable(id_, path, reason, groups, node, static))
        return id_

    def scene(self) -> Scene:
        """Raises SceneFileError if a rule has to be expanded into too many pairs."""
        common = in_one_unit(self._bodies, self._inputs, self._rule_units)
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
        scenes = self._scenes
        issues = [
            *self._issues,
            *_of_lost(self._unreadable),
            *_issues_of_files(self._bodies),
            *common.issues,
        ]
        return Scene(
            name=" ".join(self._names),
            units=common.label,
            bodies=common.bodies,
            unreadable=tuple(self._unreadable),
            order=tuple(self._order),
            ignore_within_groups=frozenset(scenes.ignored if scenes else ()),
            rules=self._rules(common.scales),
            body_rules=self._body_rules(common.scales),
            statics=scenes.statics(common.scales) if scenes else None,
            check_static=scenes is None or scenes.check_static,
            accept=scenes.accepted(alone=len(self._inputs) == 1) if scenes else (),
            motions=scenes.motions(common.scales) if scenes else (),
            entries=self._entries,
            reading=self._reading,
            composed=self._taken_apart or not self._only_meshes,
            issues=(*issues, *_unclear_axes(self._inputs, issues)),
        )

    def _rules(self, scales: Mapping[str, float]) -> tuple[Rule, ...]:
        """Those of documents and of regions first, so that a rule of a scene can override them."""
        everybody: list[Body | Unreadable] = [*self._bodies, *self._unreadable]
        stated = self._scenes.rules(everybody, scales) if self._scenes else ()
        spaces = (rule.permission for rule in self._body_rules(scales) if rule.region)
        return (*self._document_rules, *spaces, *stated)

    def _body_rules(self, scales: Mapping[str, float]) -> tuple[BodyRule, ...]:
        if self._scenes is None:
            return ()
        return self._scenes.body_rules([*self._bodies, *self._unreadable], scales)


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
