"""Which files of a folder are assets: meshes, scenes and robots, each to be checked on its own."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

from satcheck.core.errors import SatcheckError
from satcheck.scene.input_kind import ROBOT_SUFFIXES, SCENE_SUFFIXES, SDF_SUFFIXES, is_model
from satcheck.scene.loading.formats import FORMATS
from satcheck.scene.loading.regular_file import size_of
from satcheck.scene.path_kind import exists, is_folder

_ENDINGS = ROBOT_SUFFIXES.union(FORMATS)
# Most files with these endings are something else, unless they hold one of these texts.
_SCENE_MARKS = (b"satcheck.scene/1", b"satcheck-scene-1")
_SDF_MARKS = (b"<sdf", b"<gazebo")
_XML = ".xml"
_MARKS = {
    **dict.fromkeys(SCENE_SUFFIXES, _SCENE_MARKS),
    **dict.fromkeys(SDF_SUFFIXES, _SDF_MARKS),
}
_PATTERN = frozenset("*?[")
_DEEP = "**"


class Assets(NamedTuple):
    """folders: those that were given, and those that the ** of a pattern stands in."""

    files: list[str]
    folders: list[str]


NO_ASSETS = Assets([], [])


def asset_files(given: Iterable[str]) -> Assets:
    """Expands the given names into asset files, each once. A file stands for itself. A folder
    stands for all assets at any depth, sorted by name. A pattern (`*`, `**`, `?`, `[...]`) stands
    for its matches.

    In folders, names that begin with a dot are left out, and links to folders are followed. A
    folder that cannot be listed stays in the list, and its reader reports why. Raises
    SatcheckError: `no-assets` if a folder or a pattern has no asset, `bad-pattern`.
    """
    files: dict[str, None] = {}
    folders: dict[str, None] = {}
    for name in given:
        files |= dict.fromkeys(_meant_by(name))
        if is_folder(name):
            folders[name] = None
        elif _is_pattern(name) and _DEEP in Path(name).parts:
            folders[str(Path(*takewhile(_DEEP.__ne__, Path(name).parts)))] = None
    return Assets(list(files), list(folders))


def content_of(path: Path) -> bytes | None:
    """None if the file cannot be read or is not a regular file. Its reader reports why."""
    try:
        size_of(path)
        return path.read_bytes()
    except (SatcheckError, OSError):
        return None


def _meant_by(name: str) -> list[str]:
    if is_folder(name):
        assets = sorted(_below(name))
    elif _is_pattern(name):
        _refuse_pattern(name)
        root = Path(name).anchor
        matches = Path(root).glob(str(Path(name).relative_to(root)))
        assets = sorted(path.as_posix() for path in matches if path.is_file())
        if not assets:
            raise _no_match(name)
    else:
        return [name]
    if not assets:
        raise SatcheckError("no-assets", f"{name}: it has no mesh, scene or robot")
    return assets


def _is_pattern(name: str) -> bool:
    return bool(_PATTERN.intersection(name)) and not exists(name)


def _no_match(pattern: str) -> SatcheckError:
    """To be raised."""
    deeper = (Path(pattern).parent / "**" / Path(pattern).name).as_posix()
    hint = "" if "**" in pattern else f": {deeper} searches sub-folders too"
    return SatcheckError("no-assets", f"{pattern}: the pattern matches no file here{hint}")


def _refuse_pattern(name: str) -> None:
    for part in Path(name).parts:
        if _DEEP in part and part != _DEEP:
            better = name.replace(part, part.replace("**", "**/*", 1), 1)
            raise SatcheckError(
                "bad-pattern", f"{name}: ** stands for folders, between slashes: write {better}"
            )


def _below(folder: str) -> Iterator[str]:
    """Each folder once, even if links form a cycle."""
    unlisted: list[str] = []
    visited = set()
    walk = os.walk(folder, onerror=lambda error: unlisted.append(error.filename), followlinks=True)
    for parent, folders, names in walk:
        status = Path(parent).stat()
        place = status.st_dev, status.st_ino
        folders[:] = sorted(n for n in folders if place not in visited and not n.startswith("."))
        if place not in visited:
            visited.add(place)
            paths = (Path(parent) / name for name in names if not name.startswith("."))
            yield from (path.as_posix() for path in paths if _is_asset(path))
    yield from (Path(name).as_posix() for name in unlisted)


def _is_asset(path: Path) -> bool:
    ending = path.suffix.lower()
    if ending == _XML:  # reports of tests and much else
        return is_model(path)
    if ending not in _MARKS:
        return ending in _ENDINGS
    content = content_of(path)
    # JSON may write a slash with a backslash.
    plain = None if content is None else content.replace(b"\\/", b"/")
    return plain is None or any(mark in plain for mark in _MARKS[ending])
