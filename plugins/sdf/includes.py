"""Finds and reads the files that an SDFormat file includes.

Only files beside it, in its package, in the folders that the user named and in those of environment
variables are read. Nothing is fetched.
"""

from __future__ import annotations

from pathlib import Path

from satcheck.plugins.sdf.readers import ROOTS
from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.opening import is_file, is_folder
from satcheck.scene.robot.packages import MODEL_MANIFESTS, FilePlaces
from satcheck.scene.robot.reading import read_tree

_Version = tuple[int, ...]
_MOST_DIGITS = 9


class Includes:
    """Reads each file once."""

    def __init__(self, places: FilePlaces) -> None:
        self._places = places
        self._documents: dict[str, Element] = {}

    def document(self, uri: str, file: str) -> Element:
        """The root of the file that `file` includes. Raises Refused."""
        place = self._places.of(file).locate(uri, models=True)
        try:
            path = (self._model_file(place) if is_folder(place) else place).as_posix()
            if path not in self._documents:
                self._documents[path] = read_tree(path, self._places.permitted, *ROOTS)
        except Refused as error:
            raise Refused(error.code, str(error)) from None
        return self._documents[path]

    def _model_file(self, folder: Path) -> Path:
        """The file of the highest version that the manifest of a model names."""
        manifests = [folder / manifest for manifest in MODEL_MANIFESTS]
        manifest = manifests[0] if is_file(manifests[0]) else manifests[1]
        root = read_tree(manifest.as_posix(), self._places.permitted, "model")
        files = root.all("sdf") or [root.need("sdf")]
        newest = max(files, key=lambda element: version_of(element, (0,)))
        name = newest.text or newest.refuse("is empty")
        return self._places.of(manifest.as_posix()).locate(name)


def version_of(element: Element, default: _Version | None = None) -> _Version:
    """The attribute `version`, such as (1, 6). Without a default it is required."""
    if default is not None and not element.attributes.get("version"):
        return default
    text = element.attribute("version")
    words = text.split(".")
    if not all(word.isdecimal() and len(word) < _MOST_DIGITS for word in words):
        element.refuse(f"version {text!r} is no version")
    return tuple(map(int, words))


def name_in(uri: str) -> str:
    """A name for a model that cannot be read: the last part of its URI that is no file."""
    scheme, _, path = uri.rpartition("://")
    parts = [part for part in path.split("/") if part]
    if not parts:
        return uri
    folders = [part for part in parts if "." not in part]
    return parts[0] if scheme in ("model", "package") else (folders or parts)[-1]
