"""The files that an MJCF file includes or attaches, checked before MuJoCo opens them.

MuJoCo looks for an included file in the folder of the model, then in that of the including file.
"""

from __future__ import annotations

from itertools import product
from pathlib import Path

from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.reading import read_tree

ROOTS = ("mujoco", "mujocoinclude")
_MOST_FILES = 10_000
_FOLDERS = ("meshdir", "assetdir")  # attributes of <compiler>


class ModelFiles:
    """All XML files of a model. models: the file itself and the models that it attaches.

    Raises Refused for a file that is missing, may not be opened, is no XML or has entities.
    """

    def __init__(self, path: str, places: FilePlaces) -> None:
        self._places = places
        self._read: set[tuple[str, str]] = set()
        self._folders = [""]
        self._flexes: list[tuple[Element, str, str]] = []
        self.models: list[str] = []
        self._model(path)
        for (element, file, model), folder in product(self._flexes, dict.fromkeys(self._folders)):
            name = str(Path(folder, file))
            try:
                places.of(model).locate_small(name)
            except Refused as error:  # MuJoCo reports one that is missing
                if error.code in ("outside-path", "too-large"):
                    element.refuse(f"{name!r}: {error.message}", error.code)

    def _model(self, path: str) -> None:
        if path not in self.models:
            self.models.append(path)
            self._file(path, path)

    def _file(self, path: str, model: str) -> None:
        """model: the file whose XML it becomes a part of."""
        if (path, model) in self._read:
            return
        self._read.add((path, model))
        root = read_tree(path, self._places.permitted, *ROOTS, "robot")
        if len(self._read) > _MOST_FILES:
            root.refuse(f"more than {_MOST_FILES} files", "too-large")
        for element in root.below():
            tag, file = element.tag.lower(), element.attributes.get("file")
            if tag == "compiler":
                self._folders += [element.attributes.get(name, "") for name in _FOLDERS]
            if not file:
                continue
            if tag == "include":
                self._file(self._place(element, file, model), model)
            elif tag == "model":
                place = self._place(element, file, model)
                if Path(place).suffix.lower() == ".xml":
                    self._model(place)
            elif tag == "flexcomp":
                self._flexes.append((element, file, model))

    def _place(self, element: Element, file: str, model: str) -> str:
        first: Refused | None = None
        for start in dict.fromkeys((model, element.file)):
            try:
                return self._places.of(start).locate(file).as_posix()
            except Refused as error:
                first = first or error
                if error.code == "outside-path":
                    break
        assert first is not None
        return element.refuse(f"{file!r}: {first.message}", first.code)
