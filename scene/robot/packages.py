"""Finds the files that a URDF or SDFormat file names: package://, model://, file://, and plain
paths.

A robot file is untrusted. Only files in its package, or in a folder that the user named, are
opened. Other files need `Permitted.anywhere`.

The package of a file is the nearest parent folder with a package.xml (or Gazebo's model.config).
Without one it is the parent of the file's folder, because most repositories have robot/urdf and
robot/meshes, or worlds and models.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from urllib.parse import unquote

from msgspec.structs import replace

from satcheck.scene.access import (
    NOTHING_ELSE,
    Context,
    Most,
    Permitted,
    folders_of_environment,
    followed,
    no_file,
    note,
    note_folders_in,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import read_elements
from satcheck.scene.opening import is_file, is_folder, read_whole, size_of

_SCHEME = re.compile(r"([a-zA-Z][a-zA-Z0-9+.-]*)://(.*)", re.DOTALL)
_SUBSTITUTION = re.compile(r"\$[({]")
_PACKAGE_XML = "package.xml"
_MANIFESTS = (_PACKAGE_XML, "model.config")  # mark the root of a package, of a Gazebo model
_PACKAGE_SCHEMES = frozenset(("package", "model"))
_MODELS = "models"  # the usual name of a folder with Gazebo models, each a folder
MODEL_MANIFESTS = ("model.config", "manifest.xml")  # the second is that of old Gazebo models


class FilePlaces:
    """Resolves the URIs of one URDF or SDFormat file, and of the files that it includes (`of`).

    packages: the name of a package or a server, or of a folder in it ("name/meshes") -> its
    location; the longest matching name counts. Other packages are searched in the folders above the
    file, their siblings and the folders `models` among these, then in the folders of environment
    variables. They match by the name of the folder, or else by the <name> in package.xml.
    """

    def __init__(
        self,
        file: str,
        packages: Mapping[str, str | Path] | None = None,
        permitted: Permitted = NOTHING_ELSE,
    ) -> None:
        self._folder = Path(file).parent
        self._packages = {name.strip("/"): Path(place) for name, place in (packages or {}).items()}
        self._root = self._package()
        words = f"{followed(self._root)}, where the package of the file is"
        self._context = Context(self._folder, permitted, self._root, words)
        self.permitted = permitted
        self._places = {file: self}

    def of(self, file: str) -> FilePlaces:
        """The places of an included file, which may open what this one may open."""
        if file not in self._places:
            own = self._context.own, followed(self._folder)
            folders = (*self.permitted.folders, *map(str, own))
            permitted = replace(self.permitted, folders=folders)
            self._places[file] = FilePlaces(file, self._packages, permitted)
        return self._places[file]

    def locate(self, uri: str, *, models: bool = False) -> Path:
        """The path of an existing file, relative if the path of the URDF is relative. models: or of
        the folder of a Gazebo model.

        Raises Refused. Its message names the cause and not the file, so that files with the
        same cause share one message.
        """
        if "\0" in uri:
            raise Refused("bad-record", "the path holds a NUL character")
        if _SUBSTITUTION.search(uri):
            message = "$(...) is a macro that xacro replaces: expand the file first"
            raise Refused("xacro", message)
        match = _SCHEME.fullmatch(uri)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", uri)
        if scheme in _PACKAGE_SCHEMES:
            # Some write package:///
            return self._in_package(rest.replace("\\", "/").lstrip("/"), models)
        is_elsewhere, may_be_model = scheme not in ("", "file"), models and not scheme
        if (is_elsewhere or may_be_model) and (named := self._named(rest, models)):
            return named
        if is_elsewhere:
            hint = f"--package {rest.partition('/')[0]}=DIR says where the files of this server lie"
            raise Refused("unsupported-feature", f"{scheme}:// is not fetched: {hint}")
        place = self._plain(rest, models, quoted=scheme == "file")
        if isinstance(place, Path):
            if not self._may_open(place):
                hint = "--allow-outside, or with a package.xml in the folder that holds both"
                raise self._context.refusal("it", f"allow it with {hint}")
            return place
        if may_be_model and "/" not in rest and place.code == "missing-resource":
            return self._in_package(rest, models)
        raise place

    def locate_small(self, uri: str) -> Path:
        """The same of a file that a library opens by itself, and that is not too large."""
        place = self.locate(uri)
        self.permitted.most.refuse_beyond(size_of(place))
        return place

    def _plain(self, rest: str, models: bool, *, quoted: bool) -> Path | Refused:
        """Beside the file, or else in a folder of the environment, or else, of file://, in a folder
        above the file: many write file://models/NAME, from the root of their repository."""
        above = self._above()[1:] if quoted and not rest.startswith("/") else []
        roots = (self._folder, *folders_of_environment(), *above)
        found = (_existing(root, rest, models, quoted=quoted) for root in roots)
        first = next(found)
        if isinstance(first, Path):
            return first
        return next((place for place in found if isinstance(place, Path)), first)

    def _in_package(self, rest: str, models: bool) -> Path:
        name, _, inner = rest.partition("/")
        if named := self._named(rest, models):
            return named
        outside: list[Path] = []
        missing: list[Refused] = []
        for folder in filter(_is_folder, self._folders_of(name)):
            place = _existing(folder, inner, models, quoted=True)
            if isinstance(place, Refused):
                missing.append(place)
            elif self._may_open(place):
                return place
            else:
                outside.append(folder)
        option = f"--package {name}"
        if outside:
            advice = f"allow it: {option}={outside[0]}"
            raise self._context.refusal(f"package {name!r}", advice)
        if missing:
            message = f"{missing[0].message}: {option}=DIR names another package"
            raise Refused(missing[0].code, message)
        likely = self._context.own if _is_file(self._root / inner) else "DIR"
        message = f"package {name!r} is not found: {option}={likely} says where it lies"
        raise Refused("missing-resource", message)

    def _named(self, rest: str, models: bool) -> Path | None:
        """Resolves by the packages that the user named. Files in their folders are trusted."""
        parts = rest.split("/")
        for length in range(len(parts), 0, -1):
            folder = self._packages.get("/".join(parts[:length]))
            if folder is not None:
                inside = "/".join(parts[length:])
                if not Context(folder, self.permitted).permits(folder / inside):
                    raise Refused("outside-path", f"the path leaves {folder}: refused")
                place = _existing(folder, inside, models, quoted=True)
                if isinstance(place, Refused):
                    raise place
                return place
        return None

    def _folders_of(self, name: str) -> Iterator[Path]:
        """Folders that may be a package of that name, the most likely first: by the name of the
        folder, then by the name in its manifest."""
        absolute = self._folder.absolute()
        for folder, above in zip(self._above(), (absolute, *absolute.parents), strict=True):
            if above.name == name:
                yield folder
            yield folder / name
            yield folder / _MODELS / name
        environment = folders_of_environment()
        for root in environment:
            yield root if root.name == name else root / name
        most = self.permitted.most_of_tree
        for root in (self._root, *environment):
            for folder in (root, *_folders_in(root)):
                if _name_in_manifest(folder, most) == name:
                    yield folder

    def _package(self) -> Path:
        """The nearest folder with a manifest. Without one it is the folder around that of the file,
        but never the root of the file system."""
        above = self._above()
        marked = (folder for folder in above if _holds(folder, _MANIFESTS))
        return next(marked, above[1 if len(above) > 2 else 0])

    def _above(self) -> list[Path]:
        """The folder of the file and those above it, relative if its path is."""
        count = len(self._folder.absolute().parents)
        return [_tidy(self._folder.joinpath(*[".."] * steps)) for steps in range(count + 1)]

    def _may_open(self, place: Path) -> bool:
        return self._context.permits(place) or _is_from_environment(place)


def _name_in_manifest(folder: Path, most: Most) -> str | None:
    """The <name> in the package.xml of a folder; None if there is no readable one. Then the name of
    the folder counts."""
    place = folder / _PACKAGE_XML
    try:
        root = read_elements(read_whole(place, most))
    except Refused:
        return None
    name = root.find("name") if root.tag == "package" else None
    return name.text or None if name else None


def _existing(folder: Path, path: str, models: bool, *, quoted: bool) -> Path | Refused:
    r"""The file at `path` from `folder`, or why there is none. models: or the folder of a model.
    quoted: %20 may stand for a space.

    Tries the path as written first, then with / for \, because some files are written on Windows.
    """
    spellings = [path, unquote(path)] if quoted else [path]
    spellings += [spelling.replace("\\", "/") for spelling in spellings if "\\" in spelling]
    places = [_tidy(folder / spelling) for spelling in spellings]
    for place in places:
        if _is_file(place) or (models and _holds(place, MODEL_MANIFESTS)):
            return place
    if models and any(map(_is_folder, places)):
        return Refused("missing-resource", f"no {MODEL_MANIFESTS[0]} in {places[-1]}")
    if error := next(filter(None, map(no_file, places)), None):
        return error
    above = places[-1].parent
    where = f"{above.as_posix().rstrip('/')}/"
    what = f"no such file in {where}" if _is_folder(above) else f"there is no folder {above}"
    return Refused("missing-resource", what)


def _holds(folder: Path, manifests: Sequence[str]) -> bool:
    return any(_is_file(folder / manifest) for manifest in manifests)


def _folders_in(folder: Path) -> list[Path]:
    note_folders_in(folder)
    try:
        return sorted(entry for entry in folder.iterdir() if entry.is_dir())
    except OSError:  # a variable may name missing folders
        return []


def _is_file(place: Path) -> bool:
    note(place)
    return is_file(place)


def _is_folder(place: Path) -> bool:
    note(place)
    return is_folder(place)


def _is_from_environment(place: Path) -> bool:
    real = followed(place)
    return any(real.is_relative_to(followed(root)) for root in folders_of_environment())


def _tidy(path: Path) -> Path:
    return Path(os.path.normpath(path))
