"""Paths -> Scene: every path contributes bodies; what cannot be read is said, not dropped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.scene.bodies import Body, MeshFile, Scene, Unreadable
from satcheck.scene.errors import MeshFileError
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading import load_mesh_file
from satcheck.scene.plain_ids import plain_ids

if TYPE_CHECKING:
    from satcheck.scene.primitives import Primitive
    from satcheck.scene.robot import SceneRobot, Srdf

SCENE_SUFFIX = ".json"
ROBOT_SUFFIXES = frozenset((".urdf", ".xacro"))
SRDF_SUFFIX = ".srdf"
ROBOT_UNITS = "m"  # of every URDF
DEFAULT_SECONDS_PER_FILE = 60.0
DEFAULT_MEGABYTES_PER_FILE = 2048


def load_scene(
    paths: Sequence[str | Path],
    *,
    seconds_per_file: float = DEFAULT_SECONDS_PER_FILE,
    megabytes_per_file: int = DEFAULT_MEGABYTES_PER_FILE,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
) -> Scene:
    """All bodies of the given mesh files, scene files and robots, in that order.

    A mesh file is one body: the whole file, flattened (nodes, instances and build items applied),
    without unit or up-axis conversion. A `.json` file is a scene of the form satcheck-scene-1.
    A `.urdf` file is a robot at rest, a body for each <collision>; a `.srdf` file says which of its
    links may touch. packages: where the packages lie that a URDF names, see `robot.MeshPlaces`.
    Ids are those of the scene file or of the links, or of `plain_ids`, with -2, -3, ... where they
    occur again. allow_outside: a robot's meshes may lie outside of its folder.
    seconds_per_file, megabytes_per_file: limits for reading one mesh file.

    A mesh file that cannot be used becomes an Unreadable with an error issue and the rest still
    loads. Raises SceneFileError for a scene file or a robot that is wrong in itself.
    """
    loader = _Loader(seconds_per_file, megabytes_per_file)
    given = [path.as_posix() if isinstance(path, Path) else path for path in paths]
    ids = iter(plain_ids([path for path in given if _is_mesh(path)]))
    for path in given:
        suffix = _suffix(path)
        if suffix == SCENE_SUFFIX:
            loader.add_scene(path, Path(path))
        elif suffix in ROBOT_SUFFIXES:
            loader.add_robot(path, Path(path), packages, allow_outside)
        elif suffix == SRDF_SUFFIX:
            loader.add_srdf(path, Path(path))
        else:
            loader.add_mesh(next(ids), path, Path(path))
    return loader.scene()


def _suffix(path: str) -> str:
    return Path(path).suffix.lower()


def _is_mesh(path: str) -> bool:
    return _suffix(path) not in (SCENE_SUFFIX, SRDF_SUFFIX, *ROBOT_SUFFIXES)


class _Loader:
    def __init__(self, seconds: float, megabytes: int) -> None:
        self._seconds = seconds
        self._megabytes = megabytes
        self._files: dict[Path, MeshFile | MeshFileError] = {}
        self._ids: dict[str, None] = {}  # in the order given
        self._names: list[str] = []
        self._units: list[str] = []
        self._bodies: list[Body] = []
        self._unreadable: list[Unreadable] = []
        self._ignored_groups: set[str] = set()
        self._allowed: dict[frozenset[str], str] = {}
        self._robots: list[SceneRobot] = []
        self._srdfs: list[Srdf] = []
        self._issues: list[Issue] = []

    def add_mesh(self, id_: str, path: str, location: Path) -> None:
        name = location.stem or path
        self._names.append(name)
        self._add_body(id_, name, path, location, None, (), False)

    def add_scene(self, path: str, location: Path) -> None:
        from satcheck.scene.scene_file import read_scene_file

        scene = read_scene_file(path, location)
        self._names.append(scene.name)
        if scene.units:
            self._units.append(scene.units)
        ids = {
            entry.id: self._add_body(
                entry.id,
                entry.id,
                entry.mesh,
                entry.location,
                entry.transform,
                entry.groups,
                entry.static,
            )
            for entry in scene.bodies
        }
        self._ignored_groups |= scene.ignore_within_groups
        for pair, reason in scene.allowed_pairs.items():
            self._allowed[frozenset(ids[id_] for id_ in pair)] = reason
        self._issues.extend(scene.issues)

    def _add_body(
        self,
        wanted: str,
        name: str,
        path: str,
        location: Path,
        transform: tuple[float, ...] | None,
        groups: tuple[str, ...],
        static: bool,
    ) -> str:
        return self._add(wanted, name, path, self._file(path, location), transform, groups, static)

    def add_robot(
        self,
        path: str,
        location: Path,
        packages: Mapping[str, str | Path] | None,
        allow_outside: bool,
    ) -> None:
        from satcheck.scene.robot import (
            MeshPlaces,
            RobotBody,
            SceneRobot,
            bare_links,
            parts_of,
            read_urdf,
        )

        robot, issues = read_urdf(path, location)
        self._names.append(robot.name)
        self._units.append(ROBOT_UNITS)
        self._issues += [*issues, *bare_links(robot)]
        bodies = []
        for part in parts_of(robot, MeshPlaces(path, packages, allow_outside=allow_outside)):
            if isinstance(part.source, Path):
                place = part.source.as_posix()
                id_ = self._add_body(part.id, part.id, place, part.source, part.offset, (), False)
            elif isinstance(part.source, MeshFileError):
                id_ = self._add(part.id, part.id, path, part.source, part.offset)
            else:
                file = self._shape(part.source, path)
                id_ = self._add(part.id, part.id, path, file, part.offset, shape=part.source)
            bodies.append(RobotBody(id_, part.link, part.offset))
        self._robots.append(SceneRobot(robot, tuple(bodies)))

    def add_srdf(self, path: str, location: Path) -> None:
        from satcheck.scene.robot import read_srdf

        self._srdfs.append(read_srdf(path, location))

    def _add(
        self,
        wanted: str,
        name: str,
        path: str,
        file: MeshFile | MeshFileError,
        transform: tuple[float, ...] | None,
        groups: tuple[str, ...] = (),
        static: bool = False,
        shape: Primitive | None = None,
    ) -> str:
        id_ = self._unique(wanted)
        if isinstance(file, MeshFile):
            self._bodies.append(Body(id_, name, file, transform, groups, static, shape))
        else:
            reason = issue(file.code, str(file), body=id_, file=path)
            self._unreadable.append(Unreadable(id_, path, reason, groups))
        return id_

    def _unique(self, name: str) -> str:
        id_, number = name, 2
        while id_ in self._ids:
            id_, number = f"{name}-{number}", number + 1
        self._ids[id_] = None
        return id_

    def _file(self, path: str, location: Path) -> MeshFile | MeshFileError:
        """Loaded once however many bodies use it, by whatever path."""
        key = Path(location).absolute()
        if key not in self._files:
            try:
                self._files[key] = load_mesh_file(
                    path, location, seconds=self._seconds, megabytes=self._megabytes
                )
            except MeshFileError as error:
                self._files[key] = error
        return self._files[key]

    def _shape(self, shape: Primitive, path: str) -> MeshFile | MeshFileError:
        from satcheck.scene.shape_file import shape_file

        try:
            return shape_file(shape, path)
        except MeshFileError as error:
            return error

    def scene(self) -> Scene:
        scene = self._bodies_and_files()
        if not self._robots and not self._srdfs:
            return scene
        from satcheck.scene.robot import permissions, posed, with_srdfs

        robots = with_srdfs(self._robots, self._srdfs)
        allowed, issues = dict(scene.allowed_pairs), list(scene.issues)
        for robot in robots:
            permitted, found = permissions(robot)
            allowed |= permitted
            issues += found
        scene = replace(scene, robots=tuple(robots), allowed_pairs=allowed, issues=tuple(issues))
        return posed(scene, {})

    def _bodies_and_files(self) -> Scene:
        units = set(self._units)
        return Scene(
            name=" ".join(self._names),
            units=units.pop() if len(units) == 1 else None,
            bodies=tuple(self._bodies),
            unreadable=tuple(self._unreadable),
            order=tuple(self._ids),
            ignore_within_groups=frozenset(self._ignored_groups),
            allowed_pairs=self._allowed,
            issues=(
                *self._issues,
                *(lost.issue for lost in self._unreadable),
                *self._file_issues(),
            ),
        )

    def _file_issues(self) -> list[Issue]:
        """Each file's warnings once: with the body's id where only one body uses the file."""
        users: dict[str, list[Body]] = {}
        for body in self._bodies:
            users.setdefault(body.file.path, []).append(body)
        return [
            Issue(
                found.code,
                found.severity,
                bodies[0].id if len(bodies) == 1 else None,
                found.file,
                found.message,
            )
            for bodies in users.values()
            for found in bodies[0].file.issues
        ]
