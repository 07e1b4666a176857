"""Paths -> Scene. What cannot be read becomes an `Unreadable` body.

- `.toml` and `.json` files are scenes: satcheck.scene/1, JSON also satcheck-scene-1. Rules of a
  scene apply to its own bodies, mesh files and robots. Rules of a scene without bodies apply to all
  bodies.
- A `.urdf` file, or other XML with <robot> as its root, is a robot at rest with a body for each
  <collision>. A `.srdf` file says which of its links may touch.
- A USD or IFC file has a body for each prim or element, and rules of its own.
- A `.sdf` or `.world` file, or other XML with <sdf> as its root, is read as a robot too.
- Files of rules and SRDFs have no bodies. They change no body and no id.

Ids come from the scene file, the links, `plain_ids`, or the paths of nodes (after the id of their
file if there are several files). Repeated ids get the suffix -2, -3, ...
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.scene.access import DEFAULT_MEGABYTES_PER_FILE, NOTHING_ELSE, Permitted
from satcheck.scene.bodies import Scene
from satcheck.scene.building import SceneBuilder
from satcheck.scene.document import Document, Item, Kind, plain_ids
from satcheck.scene.errors import Refused
from satcheck.scene.files.nodes import Split
from satcheck.scene.files.readers import (
    GEOMETRY,
    GeometryKind,
    InputKind,
    OptionValue,
    ReadLimits,
    ReadOptions,
    kind_of,
    option_named,
    reader_of_robot,
)
from satcheck.scene.issue import UNUSED_OPTION, issue
from satcheck.scene.mesh_files import MeshFiles, bodies_of
from satcheck.scene.opening import DEFAULT_SECONDS_PER_FILE, File, name_of, read_whole
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.units import MICROMETRES, unit_of

# The header of a body in TOML, or the first body of a list in JSON.
_BODY = re.compile(rb'^\s*\[\[\s*bodies\s*\]\]|"bodies"\s*:\s*\[\s*\{', re.MULTILINE)

if TYPE_CHECKING:
    from satcheck.scene.mesh_files import KnownMeshes
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
        """Return all bodies of the given mesh files, scene files and robots, in that order. The
        head of this file says what each kind of file gives.

        hashed: compute the SHA-256 of each file, which some reports contain. known: mesh files that
        stay in memory from scene to scene. must_count: names in `reading` that have to be options
        of a reader of these files; of others a note says that they have no effect.

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
            robots = [path for path, kind in given if kind == "robot"]
            unused = _unused(reading, files, robots) if reading else {}
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
                    builder.add(files.robot(path, self.packages or {}, geometry))
                case "srdf":
                    from satcheck.scene.robot import read_srdf

                    builder.add_srdf(read_srdf(path, files.allowed.permitted))
                case _:
                    found = files.document(path, path, split if kind == "mesh" else "nodes")
                    builder.add(_as_input(found, path, kind), next(ids[kind]), alone=alone)

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
    `units="mm"` or `split="nodes"`; its `load` says what is raised. hashed: as there.
    """
    return LoadOptions(**options).load(paths, hashed=hashed)


def scene_of_document(document: Document, file: File) -> Scene:
    """Return the scene of what a reader has made of a file that places bodies. Raises Refused if no
    body can be used."""
    builder = SceneBuilder(MeshFiles(), None)
    bodies = bodies_of(file, document, "nodes")
    builder.add(_as_input(bodies, file.path, "document"), alone=True)
    return builder.scene()


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

    return read_scene_file(path, permitted)


def _as_input(found: Document | Refused, path: str, kind: InputKind) -> Document:
    """A mesh file or a document under the path that names it here."""
    document = found if isinstance(found, Document) else Document(items=(Item(found),))
    of: Kind = "mesh" if kind == "mesh" else "scene"
    return replace(document, path=path, name=name_of(path)[0] or path, kind=of)


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

    return read_rules_file(path, permitted)


def is_rules(path: str, permitted: Permitted) -> bool:
    """Return whether the input is a scene file without bodies, whose rules apply to all bodies.
    Raises Refused."""
    return kind_of(path) == "scene" and not _scene(path, permitted).items


def has_only_rules(path: str, permitted: Permitted) -> bool:
    """Return whether the input is a scene file that states rules, if only an empty list, and no
    bodies. Raises Refused."""
    if kind_of(path) != "scene":
        return False
    data = read_whole(path, permitted.most)
    if _BODY.search(data):
        return False
    scene = _scene(path, permitted)
    return not scene.items and bool(scene.rules or scene.body_rules or b"rules" in data)


def is_mesh(path: str) -> bool:
    """Return whether the input is read as a mesh file, and not as a scene or a robot."""
    return kind_of(path) == "mesh"
