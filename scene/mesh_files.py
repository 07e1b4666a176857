"""Reads each mesh file once, whole or split into nodes, and makes the mesh of each shape once."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import LeftOut, is_careful, risky_step
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.files_read import note, note_lost_reader
from satcheck.scene.issue import Issue
from satcheck.scene.loading import ReadLimits, load_mesh_file
from satcheck.scene.loading.nodes import Node, Nodes, load_nodes
from satcheck.scene.loading.readers import RobotFile, reader_of
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.regular_file import size_of
from satcheck.scene.loading.source import LARGE_FILE_BYTES
from satcheck.scene.permitted import NOTHING_ELSE, Permitted
from satcheck.scene.plain_ids import COMPONENT_MARK, HULL_MARK
from satcheck.scene.read_options import GeometryKind, ReadOptions
from satcheck.scene.shape_file import remeshed, shape_file
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.known_meshes import KnownMeshes
    from satcheck.scene.planar.outline import Shape
    from satcheck.scene.robot.model import Robot
    from satcheck.scene.robot.packages import FilePlaces

Read = TypeVar("Read", MeshFile, Nodes)
DEFAULT_SECONDS_PER_FILE = 60.0
DEFAULT_MEGABYTES_PER_FILE = 2048


class MeshFiles:
    """Reads each file once, even if several paths lead to it and many bodies use it. known: files
    that earlier scenes have read. options: for formats that leave a choice.

    Formats that need large parsers are read in a child process, which ends with this object.
    """

    def __init__(
        self,
        seconds: float = DEFAULT_SECONDS_PER_FILE,
        megabytes: int = DEFAULT_MEGABYTES_PER_FILE,
        *,
        permitted: Permitted = NOTHING_ELSE,
        hashed: bool = True,
        known: KnownMeshes | None = None,
        options: ReadOptions = ReadOptions(),  # noqa: B008  it is frozen
    ) -> None:
        self._known = known
        self._limits = ReadLimits(seconds, megabytes, permitted, hashed, options)
        self._children = ReadingChildren(megabytes)
        self._places: dict[Path, Path] = {}
        self._wholes: dict[Path, MeshFile | MeshFileError] = {}
        self._nodes: dict[tuple[Path, bool], Nodes | MeshFileError] = {}
        self._by_path: dict[tuple[Path, bool], dict[str | None, Node]] = {}
        self._hulls: dict[tuple[Path, str], Node | MeshFileError] = {}
        self._shapes: dict[tuple[Shape, str], MeshFile | MeshFileError] = {}

    def _absolute(self, location: Path) -> Path:
        """The absolute path; cached, because many bodies may share a path."""
        if location not in self._places:
            self._places[location] = Path(location).absolute()
        return self._places[location]

    def whole(self, path: str, location: Path) -> MeshFile | MeshFileError:
        """The whole file as one mesh. path: its name in messages; location: on disk."""
        key = self._absolute(location)
        if key not in self._wholes:
            try:
                load = partial(self._load_whole, path, location)
                self._wholes[key] = self._recalled(("whole", path, key), load)
            except MeshFileError as error:
                self._wholes[key] = error
        return self._wholes[key]

    def read_ahead(self, given: Iterable[tuple[str, Path]]) -> None:
        """Reads the large ones of these files in parallel and caches them for whole().

        given: (name in messages, location). Only formats whose reader runs in this process and
        releases the GIL.
        """
        waiting = {
            self._absolute(location): (path, location)
            for path, location in given
            if _is_read_here(location) and _is_large(location)
        }
        if len(waiting) < 2 or is_careful():
            return
        from threading import Thread

        queue = list(waiting.values())

        def read() -> None:
            while queue:
                try:
                    self.whole(*queue.pop())
                except Exception:  # noqa: BLE001 reported when the file is used
                    continue

        threads: list[Thread] = []
        try:
            for _ in range(min(len(queue), os.cpu_count() or 1)):
                thread = Thread(target=read)
                thread.start()
                threads.append(thread)
        except RuntimeError:
            pass  # no further threads: the remaining files are read when they are used
        for thread in threads:
            thread.join()

    def _recalled(self, key: tuple[Hashable, ...], load: Callable[[], Read]) -> Read:
        if self._known is None:
            return load()
        return self._known.recall((*key, self._limits), load)

    def _load_whole(self, path: str, location: Path) -> MeshFile:
        with _reading(path, location):
            return load_mesh_file(path, location, self._limits, self._children)

    def nodes(self, path: str, location: Path, *, components: bool) -> Nodes | MeshFileError:
        """The file split into nodes."""
        key = self._absolute(location), components
        if key not in self._nodes:
            try:
                load = partial(self._load_nodes, path, location, components)
                loaded = self._recalled(("nodes", path, *key), load)
                self._nodes[key] = loaded
                self._by_path[key] = {node.path: node for node in loaded.nodes}
            except MeshFileError as error:
                self._nodes[key] = error
        return self._nodes[key]

    def _load_nodes(self, path: str, location: Path, components: bool) -> Nodes:
        with _reading(path, location):
            return load_nodes(path, location, self._limits, self._children, components=components)

    def part(self, path: str, location: Path, part: str) -> Node | MeshFileError:
        """One node of the file by its path, which may end in "#" and the number of a component, or
        in the mark of a convex hull, which may also stand alone."""
        if part.endswith(HULL_MARK):
            return self._hull(path, location, part)
        components = COMPONENT_MARK in part
        loaded = self.nodes(path, location, components=components)
        if isinstance(loaded, MeshFileError):
            return loaded
        by_path = self._by_path[self._absolute(location), components]
        if part in by_path:
            return by_path[part]
        message = f"there is no part {part!r} in the file{meant(part, filter(None, by_path))}"
        reader = reader_of(location.suffix)
        if reader is not None and "geometry" in reader.options:
            message += "; --geometry, --purpose and `reading` of a scene choose its parts"
        return MeshFileError("unknown-part", message, file=path)

    def issues_of_parts(self, location: Path) -> tuple[Issue, ...]:
        """Return the issues that concern no single part of a file whose parts are read."""
        place = self._absolute(location)
        for components in (False, True):
            nodes = self._nodes.get((place, components))
            if isinstance(nodes, Nodes):
                return nodes.issues
        return ()

    def _hull(self, path: str, location: Path, part: str) -> Node | MeshFileError:
        key = self._absolute(location), part
        if key not in self._hulls:
            whole = part == HULL_MARK
            mesh = self.whole(path, location) if whole else None
            node = Node(part, mesh) if mesh else self.part(path, location, part[: -len(HULL_MARK)])
            self._hulls[key] = node if isinstance(node, MeshFileError) else _with_hull(node, part)
        return self._hulls[key]

    def robot(
        self,
        path: str,
        location: Path,
        places: FilePlaces,
        packages: Mapping[str, str | Path] | None = None,
        geometry: GeometryKind = "collision",
        *,
        hulls: bool = False,
    ) -> tuple[Robot, tuple[Issue, ...]]:
        """Return the robot that a file describes, and issues. Raises SceneFileError, and
        MeshFileError if reading it has ended the process before."""
        from satcheck.scene.robot import read_robot

        file = RobotFile(places, packages or {}, geometry, hulls, self._limits, self._children)
        with _reading(path, location):
            return read_robot(path, location, file)

    def shape(self, shape: Shape, path: str) -> MeshFile | MeshFileError:
        """path: the file that states it."""
        key = shape, path
        loaded = self._shapes.get(key)
        if loaded is None:
            try:
                loaded = shape_file(shape, path)
            except MeshFileError as error:
                loaded = error
            self._shapes[key] = loaded
        return loaded


def _with_hull(node: Node, part: str) -> Node:
    """The node with the convex hull of its mesh."""
    if isinstance(node.file, MeshFileError):
        return node
    try:
        hull = node.file.mesh.convex_hull().to_mesh()
        return replace(node, path=part, file=replace(remeshed(node.file, hull), part=part))
    except (MeshFileError, ValueError) as error:
        code = error.code if isinstance(error, MeshFileError) else "flat"
        return replace(node, file=MeshFileError(code, f"convex hull: {error}", file=node.file.path))


@contextmanager
def _reading(path: str, location: Path) -> Iterator[None]:
    """Raises MeshFileError if reading this file has ended the process before."""
    try:
        with risky_step(f"reading {path}"):
            yield
    except LeftOut as error:
        note(location)
        if not _is_read_here(location):  # it may name further files
            note_lost_reader()
        reason = f"the process that read it {error.message}"
        raise MeshFileError(error.code, reason, file=path) from None


def _is_read_here(location: Path) -> bool:
    """Return whether its reader always runs in this process, and releases the GIL."""
    reader = reader_of(location.suffix)
    return reader is not None and reader.here == math.inf


def _is_large(location: Path) -> bool:
    try:
        return size_of(location) >= LARGE_FILE_BYTES
    except SatcheckError:  # reported when the file is used
        return False
