"""Paths -> Scene. What cannot be read becomes an `Unreadable` body; ids are made unique."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import HalfSpace
from satcheck.scene.bodies import IDENTITY, Body, Entry, MeshFile, Scene, Unreadable
from satcheck.scene.document import (
    COMPONENT_MARK,
    Document,
    FilePart,
    Item,
    Kind,
    UniqueNames,
    plain_ids,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files.nodes import Split
from satcheck.scene.files.placing import multiply
from satcheck.scene.files.readers import (
    GEOMETRY,
    GeometryKind,
    InputKind,
    OptionValue,
    ReadLimits,
    ReadOptions,
    kind_of,
    mesh_reader,
    option_named,
    reader_of_robot,
)
from satcheck.scene.issue import BLOCKING, UNUSED_OPTION, Issue, issue
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.opening import DEFAULT_SECONDS_PER_FILE, name_of, read_whole, suffix_of
from satcheck.scene.permitted import DEFAULT_MEGABYTES_PER_FILE, NOTHING_ELSE, Permitted
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.units import (
    MICROMETRES,
    RESCALED,
    InOneUnit,
    Input,
    in_one_unit,
    ratio,
    scaled_mesh,
    scaled_world,
    stated_unit,
    unit_of,
)

# The header of a body in TOML, or the first body of a list in JSON.
_BODY = re.compile(rb'^\s*\[\[\s*bodies\s*\]\]|"bodies"\s*:\s*\[\s*\{', re.MULTILINE)

if TYPE_CHECKING:
    from satcheck.scene.mesh_files import KnownMeshes
    from satcheck.scene.planar.outline import Shape
    from satcheck.scene.robot import SceneRobot, Srdf
    from satcheck.scene.scene_file.joined import SceneFile


class LoadOptions(Struct, frozen=True, kw_only=True):
    """How the inputs of a check are read.

    split: how a mesh file is split into bodies. "none": the whole file is one body. "nodes": each
    node with a mesh in a GLB, glTF, 3MF or STEP file is a body, and so are several nodes of DAE and
    objects (`o`) of OBJ; other formats have none. "components": each edge-connected component of
    these is a body. None: "nodes" for a single file, else "none".
    packages: folders of the packages and models that a robot names, see `robot.FilePlaces`.
    folders: files in them may name other files in them, and not only in their own folder.
    allow_outside: a scene, a robot, a USD or glTF file may name files outside of these folders.
    units: of the inputs that state none. Inputs of different units are converted into one
    (`common_units`); a body of unknown unit beside them has `units` None. Axes are not converted.
    rules: files of rules, about all bodies. They count after those of the scenes.
    between: pairs of selectors. Only pairs of bodies with one in each are checked, unless a rule
    says otherwise. SatcheckError `bad-rule` for an empty one.
    geometry: which elements of the links of robots are bodies, "collision" or "visual"; of USD the
    colliders of a simulation, or what is drawn. None: collision of robots, visual of USD.
    seconds_per_file, megabytes_per_file: limits for reading one mesh file.
    reading: values of options that readers declare, by name, such as the time of a USD file. A
    scene may state those that are not given here.
    """

    split: Split | None = None
    packages: Mapping[str, str] | None = None
    geometry: GeometryKind | None = None
    folders: tuple[str, ...] = ()
    allow_outside: bool = False
    units: str | None = None
    rules: tuple[str, ...] = ()
    between: tuple[tuple[str, str], ...] = ()
    reading: ReadOptions = {}
    seconds_per_file: float = DEFAULT_SECONDS_PER_FILE
    megabytes_per_file: int = DEFAULT_MEGABYTES_PER_FILE

    def load(
        self,
        paths: Sequence[str | Path],
        *,
        hashed: bool = True,
        known: KnownMeshes | None = None,
        must_count: Collection[str] = (),
    ) -> Scene:
        """Return all bodies of the given mesh files, scene files and robots, in that order.

        hashed: compute the SHA-256 of each file, which some reports contain. known: mesh files that
        stay in memory from scene to scene. must_count: names in `reading` that have to be options
        of a reader of these files; of others a note says that they have no effect.

        - `.toml` and `.json` files are scenes: satcheck.scene/1, JSON also satcheck-scene-1. Rules
          of a scene apply to its own bodies, mesh files and robots. Rules of a scene without bodies
          apply to all bodies.
        - A `.urdf` file, or other XML with <robot> as its root, is a robot at rest with a body for
          each <collision>. A `.srdf` file says which of its links may touch.
        - A USD or IFC file has a body for each prim or element, and rules of its own.
        - A `.sdf` or `.world` file, or other XML with <sdf> as its root, is read as a robot too.
        - Files of rules and SRDFs have no bodies. They change no body and no id.
        Ids come from the scene file, the links, `plain_ids`, or the paths of nodes (after the id of
        their file if there are several files). Repeated ids get the suffix -2, -3, ...

        A mesh file or node that cannot be used becomes an Unreadable with an error issue, and the
        rest is loaded. Raises Refused for an invalid scene file or robot, and SatcheckError for an
        option of readers that cannot be.
        """
        given = [(path, kind_of(path)) for path in _as_texts(paths)]
        names = [path for path, _ in given]
        permitted = Permitted.around(
            names, self.folders, anywhere=self.allow_outside, megabytes=self.megabytes_per_file
        )
        scenes = {path: _scene(path, permitted) for path, kind in given if kind == "scene"}
        reading = {**_stated_reading(scenes.values()), **self._given_reading()}
        allowed = ReadLimits(self.seconds_per_file, permitted, hashed, reading)
        with closing(MeshFiles(allowed, known)) as files:
            builder = SceneBuilder(files, None if self.units is None else _unit(self.units))
            self._add(given, scenes, files, builder)
            for path in _as_texts(self.rules):
                builder.add(read_rules(path, permitted))
            scene = builder.scene()
            unused = _unused(reading, files, [path for path, kind in given if kind == "robot"])
        if wrong := [name for name in unused if name in must_count]:
            raise SatcheckError(UNUSED_OPTION, unused[wrong[0]])
        if not unused and not self.between:
            return scene
        issues = (*scene.issues, *(issue(UNUSED_OPTION, said) for said in unused.values()))
        return replace(scene, issues=issues, rules=(*_only(self.between), *scene.rules))

    def _add(
        self,
        given: Sequence[tuple[str, InputKind]],
        scenes: Mapping[str, SceneFile],
        files: MeshFiles,
        builder: SceneBuilder,
    ) -> None:
        """Reads the inputs, and adds their documents in this order. given: (path, kind). Raises
        Refused."""
        have_bodies = (
            bool(scenes[path].items) if kind == "scene" else kind != "srdf" for path, kind in given
        )
        alone = sum(have_bodies) == 1
        # Colliders are exact shapes, which no mesh of a whole file holds.
        apart = alone or files.allowed.options.get("geometry") == "collision"
        split: Split = self.split or ("nodes" if apart else "none")
        kinds: tuple[InputKind, ...] = ("mesh", "document")
        of_kind = {kind: [path for path, own in given if own == kind] for kind in kinds}
        ids = {kind: iter(plain_ids(paths)) for kind, paths in of_kind.items()}
        if split == "none":
            files.read_ahead((path, path) for path in of_kind["mesh"])
        for path, kind in given:
            match kind:
                case "scene":
                    builder.add(scenes[path])
                case "robot":
                    geometry = self.geometry or "collision"
                    builder.add(files.robot(path, path, self.packages or {}, geometry))
                case "srdf":
                    from satcheck.scene.robot import read_srdf

                    builder.add_srdf(read_srdf(path, Path(path), files.allowed.permitted))
                case _:
                    found = files.document(path, path, split if kind == "mesh" else "nodes")
                    builder.add(_with_ids(found, path, kind, next(ids[kind]), alone))

    def _given_reading(self) -> dict[str, OptionValue]:
        """The options of readers that are given. Raises SatcheckError for one that none has, and
        for a value that it does not take."""
        given = dict(self.reading)
        if self.geometry is not None:
            given[GEOMETRY.name] = self.geometry
        options = [(option_named(name), value) for name, value in given.items()]
        return {option.name: option.converted(value) for option, value in options}


def _unused(reading: ReadOptions, files: MeshFiles, robots: Iterable[str]) -> dict[str, str]:
    """The options that count for none of the files: name -> what is said about it."""
    if not reading:
        return {}
    counting = files.options()
    for path in robots:
        reader = reader_of_robot(path)
        counting |= {GEOMETRY.name, *(each.name for each in (reader.options if reader else ()))}
    spelled = sorted(name.replace("_", "-") for name in counting)
    theirs = f"they have {', '.join(spelled)}" if spelled else "they have none"
    return {
        name: f"no reader of these files has the option {name.replace('_', '-')}: {theirs}"
        for name in reading
        if name not in counting
    }


def load_scene(paths: Sequence[str | Path], *, hashed: bool = True, **options: Any) -> Scene:
    """Return the scene of these files.

    paths: mesh files, robots and scene files in any mix. options: of `LoadOptions`, such as
    `units="mm"` or `split="nodes"`; its `load` says what each kind of file gives, and what is
    raised. hashed: as there.
    """
    return LoadOptions(**options).load(paths, hashed=hashed)


def _only(between: Sequence[tuple[str, str]]) -> Iterator[Rule]:
    """Rules that allow all pairs but these. They stand before all others, which can change that."""
    if not between:
        return
    everything = Selector("*")
    reason = "no pair of --between"
    yield Rule(a=everything, b=everything, allowed=True, reason=reason, where="--between")
    for a, b in between:
        yield Rule(a=Selector(a), b=Selector(b), allowed=False, where=f"--between {a} {b}")


def _as_texts(paths: Sequence[str | Path]) -> list[str]:
    if isinstance(paths, str | Path):
        raise SatcheckError("bad-argument", f"paths: a list of paths, not one: [{str(paths)!r}]")
    for path in paths:
        if not isinstance(path, str | Path):
            hint = "check_meshes takes two meshes, scene_of_meshes any number, by name"
            message = f"paths: a list of paths, got one of {type(path).__name__}: satcheck.{hint}"
            raise SatcheckError("bad-argument", message)
    return [path.as_posix() if isinstance(path, Path) else path for path in paths]


def _unit(name: str) -> str:
    unit = unit_of(name)
    if unit is None:
        known = ", ".join(MICROMETRES)
        raise SatcheckError("bad-argument", f"units: one of {known}, not {name!r}")
    return unit


def _scene(path: str, permitted: Permitted) -> SceneFile:
    """Raises Refused."""
    from satcheck.scene.scene_file.reading import read_scene_file

    return read_scene_file(path, Path(path), permitted)


def _with_ids(
    found: Document | Refused, path: str, kind: InputKind, file_id: str, alone: bool
) -> Document:
    """A mesh file or a document as an input, with the ids that its bodies should have. alone: the
    paths of nodes are ids, without the id of the file before them."""
    if isinstance(found, Refused):
        name = name_of(path)[0] or path
        of: Kind = "mesh" if kind == "mesh" else "scene"
        found = Document(path=path, name=name, kind=of, items=(Item(found),))
    items = []
    for item in found.items:
        id_ = _node_id(item.path, file_id, alone)
        items.append(replace(item, id=id_, title=item.title or (id_ if item.path else found.name)))
    return replace(found, path=path, items=tuple(items))


def _node_id(path: str | None, file_id: str, alone: bool) -> str:
    if path is None:
        return file_id
    if path.startswith(COMPONENT_MARK):  # of a file without nodes
        return file_id + path
    return path if alone else f"{file_id}/{path.removeprefix('/')}"


def _stated_reading(scenes: Iterable[SceneFile]) -> dict[str, Any]:
    """The options that scenes state. Raises Refused if two of them differ."""
    stated: dict[str, Any] = {}
    for scene in scenes:
        for name, value in scene.reading.items():
            if stated.setdefault(name, value) != value:
                message = f"reading.{name} differs from that of another scene"
                raise Refused("bad-scene", message, file=scene.path)
    return stated


def read_rules(path: str, permitted: Permitted = NOTHING_ELSE) -> SceneFile:
    """A file of rules. permitted: how large it may be. Raises Refused."""
    from satcheck.scene.scene_file.reading import read_rules_file

    return read_rules_file(path, Path(path), permitted)


def is_rules(path: str, permitted: Permitted) -> bool:
    """Return whether the input is a scene file without bodies, whose rules apply to all bodies.
    Raises Refused."""
    return kind_of(path) == "scene" and not _scene(path, permitted).items


def has_only_rules(path: str, permitted: Permitted) -> bool:
    """Return whether the input is a scene file that states rules, if only an empty list, and no
    bodies. Raises Refused."""
    if kind_of(path) != "scene":
        return False
    data = read_whole(path, path, permitted.most)
    if _BODY.search(data):
        return False
    scene = _scene(path, permitted)
    return not scene.items and bool(scene.rules or scene.body_rules or b"rules" in data)


def is_mesh(path: str) -> bool:
    """Return whether the input is read as a mesh file, and not as a scene or a robot."""
    return kind_of(path) == "mesh"


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
        given = None if document.kind == "rules" else self._given_units
        unit = stated_unit(document.units) or given
        own = Input(document, unit, self._groups_of(document))
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
        scene_file = _scene_file(document)
        if scene_file is not None:
            named |= dict.fromkeys(sorted(scene_file.ignore_within_groups))
        if not named:
            return {}
        own = {group for rule in document.pairs if rule.of_groups for group in (rule.a, rule.b)}
        prefix = f"{document.name}: " if document.robot else ""
        if prefix or scene_file is not None:
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
        id_ = self._ids.unique(item.id)
        path = own.document.path
        if item.entry is not None:
            self._entries[id_] = item.entry
            path = item.entry.file
        if isinstance(item.shape, FilePart):
            path, item = item.shape.path, self._in_other_file(item, item.shape, own.unit)
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
        groups_here = tuple(map(own.groups.__getitem__, item.groups))
        if isinstance(file, Refused):
            # A file of shapes has many bodies: the message is about the body, not the file.
            message = str(file) if exact is None else file.message
            reason = issue(file.code, message, body=id_, file=path)
            lost = Unreadable(id_, path, reason, groups_here, node, item.static)
            own.bodies.append(lost)
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
            stated_unit(item.units or file.units) or own.unit,
            surface_tolerance=item.surface_tolerance,
        )
        own.bodies.append(body)
        own.readable.append(body)
        return id_

    def _in_other_file(self, item: Item, named: FilePart, own: str | None) -> Item:
        """The item with the mesh that it names, where both files together place it. own: the unit
        of its document. What blocks a pass about a file is said once, whoever names a part of
        it."""
        found = self._files.item(named)
        if named.part is not None and named.location not in self._parted:
            self._parted.add(named.location)
            issues = self._files.issues_of_parts(named.location)
            self._issues += [each for each in issues if each.code in BLOCKING]
        if item.units and isinstance(found.shape, MeshFile) and found.shape.units == RESCALED:
            message = "`units` cannot override the unit of this file: leave it out"
            lost = Refused("unsupported-feature", message, file=named.path)
            return replace(item, path=named.part, shape=lost)
        place = item.transform
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
        robots = [_robot(each) for each in self._inputs if each.document.robot]
        jointed = [
            (each.document, dict(_links(each)))
            for each in self._inputs
            if any(joint.kind != "fixed" for joint in each.document.joints)
        ]
        if not robots and not self._srdfs and not jointed:
            return scene.reaching()
        from satcheck.scene.robot import permissions, posed, with_srdfs

        robots = with_srdfs(robots, self._srdfs)
        allowed, issues = [], list(scene.issues)
        documents: list[SceneRobot] = []
        if jointed:
            from satcheck.scene.robot.trees import robots_of_documents

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
        return posed(scene, {}).reaching()

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
        files = [(each, file) for each in self._inputs if (file := _scene_file(each.document))]
        if not files:
            return scene
        from satcheck.scene.scene_file.joined import Joined, joined

        stated = []
        for each, file in files:
            ids = dict(zip((item.id for item in file.items), each.ids, strict=True))
            stated.append(Joined(file, ids, each.groups, common.scales.get(file.path, 1.0)))
        return joined(scene, stated, alone=len(inputs) == 1)


def _scene_file(document: Document) -> SceneFile | None:
    """The document if it is a scene file; None: another input."""
    if document.kind not in ("scene", "rules"):
        return None
    from satcheck.scene.scene_file.joined import SceneFile

    return document if isinstance(document, SceneFile) else None


def _robot(added: Input) -> SceneRobot:
    from satcheck.scene.robot import RobotBody, SceneRobot

    document = added.document
    assert document.robot is not None
    own, bodies = [], {body.id: body for body in added.readable}
    for item, id_ in zip(document.items, added.ids, strict=True):
        placed = bodies[id_].transform if id_ in bodies else item.transform
        own.append(RobotBody(id_, item.link or "", placed or IDENTITY, item.groups))
    return SceneRobot(document.robot, tuple(own), groups=added.groups)


def _links(added: Input) -> Iterator[tuple[str, str]]:
    """The bodies of rigid bodies: (id, link)."""
    for item, id_ in zip(added.document.items, added.ids, strict=True):
        if item.link:
            yield id_, item.link


def _rules(added: Input) -> Iterator[Rule]:
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
