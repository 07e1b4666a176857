"""Mesh files that stay in memory from one scene to the next, for a process that checks many."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock

from msgspec import Struct

from satcheck.scene.bodies import MeshFile
from satcheck.scene.files_read import FilesRead, files_read
from satcheck.scene.loading.nodes import Nodes


class _Known(Struct, frozen=True):
    """read: what was made of these files."""

    read: Nodes
    files: FilesRead
    triangles: int


class KnownMeshes:
    """The files that were used last, of this many triangles together. A file that has changed is
    read again."""

    def __init__(self, triangles: int) -> None:
        self._most = triangles
        self._held = 0
        self._known: OrderedDict[Hashable, _Known] = OrderedDict()
        self._lock = Lock()

    def recall(self, key: Hashable, load: Callable[[], Nodes]) -> Nodes:
        """The result of `load`, or of an earlier one with this key. Raises what it raises."""
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


def _triangles(read: Nodes) -> int:
    """Each mesh counts for a little more than its triangles."""
    files = (node.file for node in read.nodes.values())
    return sum(100 + file.mesh.triangle_count for file in files if isinstance(file, MeshFile))
