"""The files that an MJCF file includes or attaches, checked before MuJoCo opens them.

MuJoCo looks for an included file in the folder of the model, then in that of the including file.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from itertools import product
from pathlib import Path

from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.reading import read_tree

ROOTS = ("mujoco", "mujocoinclude")
_MOST_FILES = 10_000
# Elements that <replicate> and <attach> add. MuJoCo takes four times as long for twice as many.
MOST_COPIES = 10_000
_MOST_DIGITS = 9
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
        self._elements: Counter[str] = Counter()  # of each model, with all copies
        self._attached: Counter[str] = Counter()  # the <attach> among them
        self._below: defaultdict[str, list[str]] = defaultdict(list)  # what a model attaches
        self._written = 0
        self._copier: Element | None = None
        self._model(path)
        if self._copier and self._elements[path] - self._written > MOST_COPIES:
            message = f"copies make more than {MOST_COPIES} elements: copy fewer"
            self._copier.refuse(message, "too-large")
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
            self._file(path, path, 1)
            most = max((self._elements[model] for model in self._below[path]), default=0)
            self._elements[path] += most * self._attached[path]

    def _file(self, path: str, model: str, times: int) -> None:
        """model: the file whose XML it becomes a part of, so many times."""
        if (path, model) in self._read:
            return
        self._read.add((path, model))
        root = read_tree(path, self._places.permitted, *ROOTS, "robot")
        if len(self._read) > _MOST_FILES:
            root.refuse(f"more than {_MOST_FILES} files", "too-large")
        for element, copies in _with_copies(root, times):
            tag, file = element.tag.lower(), element.attributes.get("file")
            self._written += 1
            self._elements[model] += copies
            self._attached[model] += copies if tag == "attach" else 0
            if tag in ("attach", "replicate"):
                self._copier = element
            if tag == "compiler":
                self._folders += [element.attributes.get(name, "") for name in _FOLDERS]
            if not file:
                continue
            if tag == "include":
                self._file(self._place(element, file, model), model, copies)
            elif tag == "model":
                place = self._place(element, file, model)
                if Path(place).suffix.lower() == ".xml":
                    self._below[model].append(place)
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


def _with_copies(root: Element, times: int) -> Iterator[tuple[Element, int]]:
    """Yield the elements inside, in the order of the file, and how many copies each has. times: the
    copies of the outermost one."""
    waiting = [(child, times) for child in reversed(root.children)]
    while waiting:
        element, copies = waiting.pop()
        yield element, copies
        if element.tag.lower() == "replicate":
            copies *= _count_of(element)
        waiting += [(child, copies) for child in reversed(element.children)]


def _count_of(replicate: Element) -> int:
    """Return the number of copies; MuJoCo refuses what is none."""
    word = replicate.attributes.get("count", "").strip().removeprefix("+")
    if not word.isdecimal():
        return 1
    return int(word) if len(word) <= _MOST_DIGITS else 10**_MOST_DIGITS
