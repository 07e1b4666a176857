"""Reads each mesh file once, whole or split into nodes, and makes the mesh of each shape once.
For a process that checks many scenes, what is read stays in memory."""

from __future__ import annotations

import math
import os
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from functools import cached_property, partial
from pathlib import Path
from threading import Lock, Thread
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.plugins import function_at
from satcheck.core.steps import LeftOut, is_careful, risky_step
from satcheck.scene.access import FilesRead, StrPath, files_read, note, note_lost_reader
from satcheck.scene.bodies import MeshFile
from satcheck.scene.document import COMPONENT_MARK, HULL_MARK, Document, FilePart, Item
from satcheck.scene.errors import Refused
from satcheck.scene.files.nodes import Split, flattened, inspected
from satcheck.scene.files.readers import (
    GEOMETRY,
    File,
    GeometryKind,
    NeedsChild,
    Reader,
    ReadLimits,
    reader_of,
    required_reader,
)
from satcheck.scene.files.reading_children import ReadingChildren, read_in_child
from satcheck.scene.inspect import errors_of, mesh_file, remeshed, shape_file
from satcheck.scene.issue import Issue
from satcheck.scene.opening import LARGE_FILE_BYTES, open_file, suffix_of
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.planar.outline import Shape

# Files that are remembered by name: so many scenes may lie between two that share one.
_MOST_SEEN = 100_000


def bodies_of(file: File, read: Document, split: Split) -> Document:
    """Return the bodies of a file, with each distinct mesh inspected once. read: by its reader.
    Raises Refused if nothing can be used."""
    if split != "none":
        return inspected(file, read, apart=split == "components")
    mesh = mesh_file(file, read.only_mesh or flattened(read))
    return Document(items=(Item(mesh),), units=mesh.units)


class MeshFiles:
    """Reads each file once, even if several paths lead to it and many bodies use it. known: files
    that earlier scenes have read.

    Formats that need large parsers are read in child processes, which `close` ends, unless they are
    those of `known`.
    """

    def __init__(
        self,
        allowed: ReadLimits = ReadLimits(),  # noqa: B008  it is frozen
        known: KnownMeshes | None = None,
    ) -> None:
        self.allowed = allowed
        self._terms = allowed.key
        self._known = known
        self._made: dict[Hashable, Any] = {}
        self._folder = os.getcwd()  # noqa: PTH109  the process stays there for this scene

    @cached_property
    def _children(self) -> ReadingChildren:
        make = ReadingChildren if self._known is None else self._known.children
        return make(self.allowed.permitted.megabytes)

    def close(self) -> None:
        # An error that is kept holds this object in a cycle, which may live for long.
        if self._known is None and "_children" in vars(self):
            self._children.close()

    def document(self, path: str, location: StrPath, split: Split) -> Document | Refused:
        """Return the bodies of a file. path: its name in messages; location: on disk."""
        key = self._place(location), split
        load = partial(self._load, path, location, split)
        if self._known is not None:
            load = partial(self._known.recall, (path, key, *self._terms), load)
        made: Document | Refused = self._once(key, load)
        return made

    def _place(self, location: StrPath) -> str:
        return os.path.join(self._folder, location)  # noqa: PTH118  many bodies share a path

    def _once(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return what `make` returns, or the Refused that it raises; both once."""
        if key not in self._made:
            try:
                self._made[key] = make()
            except Refused as error:
                self._made[key] = error
        return self._made[key]

    def _load(self, path: str, location: StrPath, split: Split) -> Document:
        with _reading(path, location), errors_of(path):
            whole = split == "none"
            reader, file = open_file(path, location, required_reader, self.allowed, whole=whole)
            return bodies_of(file, self._read(reader, file, Document), split)

    def _read(self, reader: Reader, file: File, kind: type[Document]) -> Document:
        """In this process, or in the child process, as its reader says. kind: of its documents."""
        if reader.here and len(file.data) <= reader.here:
            try:
                return reader.checked(function_at(reader.read)(file))
            except NeedsChild:
                pass
        if reader.by_name:
            file = replace(file, data=b"")
        made = read_in_child(file, reader.read, kind, self._children, self.allowed)
        return reader.checked(made)

    def item(self, named: FilePart) -> Item:
        """Return one body of a file. A part may end in "#" and the number of a component, or in the
        mark of a convex hull, which may also stand alone."""
        path, location, part = named.path, named.location, named.part
        if part is not None and part.endswith(HULL_MARK):
            hull: Item = self._once((self._place(location), part), partial(self._hull, named))
            return hull
        split: Split = (
            "none" if part is None else "components" if COMPONENT_MARK in part else "nodes"
        )
        loaded = self.document(path, location, split)
        if isinstance(loaded, Refused):
            return Item(loaded, part)
        if part is None:
            return loaded.items[0]
        by_path: dict[str, Item] = self._once(
            (self._place(location), "by path", split),
            lambda: {item.path or "": item for item in loaded.items},
        )
        if part in by_path:
            return by_path[part]
        hint = meant(part, filter(None, by_path))
        message = f"there is no part {part!r} in the file{hint}"
        reader = reader_of(suffix_of(location))
        if reader is not None and GEOMETRY in reader.options:
            message += "; --geometry, --read and `reading` of a scene choose its parts"
        return Item(Refused("unknown-part", message, file=path), part)

    def mesh(self, named: FilePart) -> MeshFile | Refused:
        """Return the mesh of a file, or of a part of it."""
        shape = self.item(named).shape
        assert not isinstance(shape, FilePart | int)  # a file names parts of others, or has its own
        return shape if isinstance(shape, MeshFile | Refused) else self.shape(shape, named.path)

    def _hull(self, named: FilePart) -> Item:
        """Return an item with the convex hull of its mesh."""
        part = named.part or ""
        item = self.item(replace(named, part=part.removesuffix(HULL_MARK) or None))
        if not isinstance(item.shape, MeshFile):
            return item
        try:
            hull = item.shape.mesh.convex_hull().to_mesh()
            return replace(item, path=part, shape=replace(remeshed(item.shape, hull), part=part))
        except (Refused, ValueError) as error:
            code = error.code if isinstance(error, Refused) else "flat"
            return replace(item, shape=Refused(code, f"convex hull: {error}", file=named.path))

    def issues_of_parts(self, location: StrPath) -> tuple[Issue, ...]:
        """Return the issues that concern no single part of a file whose parts are read."""
        place = self._place(location)
        made = [self._made.get((place, split)) for split in ("nodes", "components")]
        return next((each.issues for each in made if isinstance(each, Document)), ())

    def options(self) -> set[str]:
        """Return the names of the options that count for the files that are read."""
        keys = (key for key in self._made if isinstance(key, tuple))
        suffixes = {suffix_of(place) for place, *_ in keys if isinstance(place, str)}
        readers = filter(None, map(reader_of, suffixes))
        return {option.name for reader in readers for option in reader.options}

    def read_ahead(self, given: Iterable[tuple[str, StrPath]]) -> None:
        """Reads the large ones of these files in parallel, as a whole.

        given: (name in messages, location). Only formats whose reader runs in this process and
        releases the GIL.
        """
        waiting = {
            self._place(location): (path, location)
            for path, location in given
            if _is_read_here(location) and _is_large(location)
        }
        if len(waiting) < 2 or is_careful():
            return
        files = iter(waiting.values())

        def read() -> None:
            for path, location in files:
                with suppress(Exception):  # it is raised again when the file is used
                    self.document(path, location, "none")

        threads = [Thread(target=read) for _ in range(min(len(waiting), os.cpu_count() or 1))]
        with suppress(RuntimeError):  # no further thread: the other files are read when used
            for thread in threads:
                thread.start()
        for thread in threads:
            if thread.ident is not None:
                thread.join()

    def robot(
        self,
        path: str,
        packages: Mapping[str, str | Path],
        geometry: GeometryKind,
    ) -> Document:
        """Return the robot that a file describes, and the bodies of its links. No mesh is read.
        Raises Refused, also if reading it has ended the process before."""
        from satcheck.scene.robot.assembly import document_of_robot
        from satcheck.scene.robot.model import RobotDocument
        from satcheck.scene.robot.reading import required_robot_reader

        with _reading(path, path):
            reader = required_robot_reader(path, self.allowed.permitted)
            folder, name = os.path.split(path)
            file = File(
                reader.name,
                folder or os.curdir,
                name,
                b"",
                {**reader.values(self.allowed.options), GEOMETRY.name: geometry},
                permitted=self.allowed.permitted,
                path=path,
                packages=packages,
            )
            return document_of_robot(self._read(reader, file, RobotDocument), file)

    def shape(self, shape: Shape, path: str) -> MeshFile | Refused:
        """path: the file that states it."""
        made: MeshFile | Refused = self._once((shape, path), partial(shape_file, shape, path))
        return made


class _Known(Struct, frozen=True):
    """read: what was made of these files."""

    read: Document
    files: FilesRead
    triangles: int


class KnownMeshes:
    """The files that were used last, of this many triangles together. A file that has changed is
    read again. The child processes that read files stay, too: one reads those of many scenes."""

    def __init__(self, triangles: int) -> None:
        self._most = triangles
        self._held = 0
        self._known: OrderedDict[Hashable, _Known] = OrderedDict()
        self._seen: set[int] = set()
        self._children: dict[int, ReadingChildren] = {}
        self._lock = Lock()

    def children(self, megabytes: int) -> ReadingChildren:
        """Return the child processes with this limit."""
        with self._lock:
            if megabytes not in self._children:
                self._children[megabytes] = ReadingChildren(megabytes)
            return self._children[megabytes]

    def recall(self, key: Hashable, load: Callable[[], Document]) -> Document:
        """The result of `load`, or of an earlier one with this key. Raises what it raises. What is
        asked for only once is not kept, as few files are in many scenes."""
        if hash(key) not in self._seen:
            if len(self._seen) >= _MOST_SEEN:
                self._seen.clear()
            self._seen.add(hash(key))
            return load()
        known = self._take(key)
        if known is not None and known.files.are_certain():
            known.files.note_again()
            self._put(key, known)
            return known.read
        with files_read() as files:
            read = load()
        if files.are_settled():
            self._put(key, _Known(read, files, _triangles(read)))
        return read

    def _take(self, key: Hashable) -> _Known | None:
        with self._lock:
            known = self._known.pop(key, None)
            self._held -= known.triangles if known else 0
            return known

    def _put(self, key: Hashable, known: _Known) -> None:
        """The files of the longest ago make room."""
        with self._lock:
            self._known[key] = known
            self._held += known.triangles
            while self._held > self._most:
                _, oldest = self._known.popitem(last=False)
                self._held -= oldest.triangles


def _triangles(read: Document) -> int:
    """Each mesh counts for a little more than its triangles."""
    shapes = (item.shape for item in read.items)
    return sum(100 + shape.mesh.triangle_count for shape in shapes if isinstance(shape, MeshFile))


def _reading(path: str, location: StrPath) -> AbstractContextManager[None]:
    """Raises Refused if reading this file has ended the process before."""
    return _reading_again(path, location) if is_careful() else nullcontext()


@contextmanager
def _reading_again(path: str, location: StrPath) -> Iterator[None]:
    try:
        with risky_step(f"reading {path}"):
            yield
    except LeftOut as error:
        note(os.fspath(location))
        if not _is_read_here(location):  # it may name further files
            note_lost_reader()
        reason = f"the process that read it {error.message}"
        raise Refused(error.code, reason, file=path) from None


def _is_read_here(location: StrPath) -> bool:
    """Return whether its reader always runs in this process, and releases the GIL."""
    reader = reader_of(suffix_of(location))
    return reader is not None and reader.here == math.inf


def _is_large(location: StrPath) -> bool:
    try:
        return os.path.getsize(location) >= LARGE_FILE_BYTES  # noqa: PTH202
    except (OSError, ValueError):  # reported when the file is used
        return False
