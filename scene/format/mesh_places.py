"""Which mesh files a scene may name."""

from __future__ import annotations

import os
from pathlib import Path

from satcheck.scene.files_read import note
from satcheck.scene.format.entries import MeshPath
from satcheck.scene.format.form import Wrong, shown
from satcheck.scene.loading.formats import FORMATS
from satcheck.scene.path_kind import followed, is_file


class MeshPlaces:
    """Finds the mesh files of one scene file.

    Each is checked once, even if many bodies use it. path: of the scene file, for messages;
    location: on disk. anywhere: meshes may lie outside of its folder. Links are resolved before
    this is decided.
    """

    def __init__(self, path: str, location: Path, *, anywhere: bool) -> None:
        self._above = Path(path).parent
        self._folder = location.parent
        self._root = None if anywhere else followed(self._folder)
        self._known: dict[str, MeshPath | Wrong] = {}

    def find(self, mesh: str) -> MeshPath:
        """The mesh file that a body names. Raises Wrong if it is missing or may not be opened."""
        if mesh not in self._known:
            try:
                self._known[mesh] = self._judged(mesh)
            except Wrong as wrong:
                self._known[mesh] = wrong
        place = self._known[mesh]
        if isinstance(place, Wrong):
            raise place
        return place

    def _judged(self, mesh: str) -> MeshPath:
        if "\0" in mesh:
            raise Wrong(f"mesh path {shown(mesh)} holds a NUL character", "mesh")
        location = self._folder / mesh
        if location.suffix.lower() not in FORMATS:
            known = ", ".join(sorted(FORMATS))
            message = f"mesh path {shown(mesh)} names no mesh format ({known}): refused"
            raise Wrong(message, "mesh", code="unsupported-format")
        note(location)
        if self._root is not None and not followed(location).is_relative_to(self._root):
            message = (
                f"mesh file {shown(mesh)} lies outside of the scene's folder: refused "
                "(allow it with --allow-outside)"
            )
            raise Wrong(message, "mesh", code="outside-path")
        if not is_file(location):
            raise Wrong(f"mesh file {shown(mesh)} is missing", "mesh", code="missing-resource")
        path = os.path.normpath(self._above / mesh).replace(os.sep, "/")
        return MeshPath(path, location)
