"""Which files of a folder are assets: meshes, scenes and robots, each to be checked on its own."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

from satcheck.core.errors import SatcheckError
from satcheck.scene.access import NOTHING_ELSE, Permitted
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import SCENE_SUFFIXES, mesh_reader, reader_of_robot, robots_of
from satcheck.scene.foreign_formats import is_foreign
from satcheck.scene.opening import exists, is_folder, read_whole

# Most JSON and TOML is something else, unless it holds one of these texts, which begin the names of
# schemas of any version.
_SCENE_MARKS = (b"satcheck.scen", b"satcheck-scen")
_SHAPES = frozenset(("mesh", "shape"))  # keys of a body
_PATTERN = frozenset("*?[")
_DEEP = "**"


class Assets(NamedTuple):
    """folders: those that were given, and those that the ** of a pattern stands in. foreign: folder
    -> its files with geometry that no reader knows. excluded: their number."""

    files: list[str]
    folders: list[str]
    foreign: dict[str, list[str]]
    excluded: int = 0


NO_ASSETS = Assets([], [], {})


def asset_files(
    given: Iterable[str], exclude: Sequence[str] = (), permitted: Permitted = NOTHING_ELSE
) -> Assets:
    """Expands the given names into asset files, each once. A file stands for itself. A folder
    stands for all assets at any depth, sorted by name. A pattern (`*`, `**`, `?`, `[...]`) stands
    for its matches. exclude: patterns of names, or of paths from a folder, that are left out of
    folders and matches. permitted: how large a file may be; a larger one counts.

    In folders, names that begin with a dot are left out, and links to folders are followed. A
    folder that cannot be listed stays in the list, and its reader reports why. Raises
    SatcheckError: `no-assets` if a folder or a pattern has no asset, `bad-pattern`.
    """
    files: dict[str, None] = {}
    folders: dict[str, None] = {}
    foreign: dict[str, list[str]] = {}
    left_out = _LeftOut(exclude)
    for name in given:
        if is_folder(name):
            folders[name] = None
            unlisted: list[str] = []
            below = list(left_out.others(_below(name, unlisted), name))
            readable = (path for path in below if _is_asset(Path(path), permitted))
            assets = sorted([*unlisted, *readable])
            unread = sorted(filter(is_foreign, below))
            if not assets:
                raise _no_asset(name, unread, left_out.count)
            if unread:
                foreign[name] = unread
        elif _is_pattern(name):
            if _DEEP in Path(name).parts:
                folders[str(Path(*takewhile(_DEEP.__ne__, Path(name).parts)))] = None
            assets = sorted(left_out.others(_matches(name), ""))
            if not assets:
                raise _no_match(name)
        else:
            assets = [name]
        files |= dict.fromkeys(assets)
    return Assets(list(files), list(folders), foreign, left_out.count)


class _LeftOut:
    """Leaves out the files that match a pattern, or lie in a folder that does, and counts them."""

    def __init__(self, patterns: Sequence[str]) -> None:
        if not all(patterns):
            raise SatcheckError("bad-pattern", "--exclude: an empty pattern")
        self._patterns = patterns
        self.count = 0

    def others(self, paths: Iterable[str], folder: str) -> Iterator[str]:
        """folder: where paths start; "": they are as they are."""
        for path in paths:
            inner = Path(path).relative_to(folder) if folder else Path(path)
            if self._patterns and self._has(inner):
                self.count += 1
            else:
                yield path

    def _has(self, path: Path) -> bool:
        names = {name for each in (path, *path.parents) for name in (each.name, each.as_posix())}
        return any(fnmatchcase(name, pattern) for pattern in self._patterns for name in names)


def content_of(path: Path, permitted: Permitted) -> bytes | None:
    """None if the file cannot be read. Its reader reports why."""
    try:
        return read_whole(path, permitted.most)
    except Refused:
        return None


def _matches(pattern: str) -> Iterator[str]:
    _refuse_pattern(pattern)
    root = Path(pattern).anchor
    matches = Path(root).glob(str(Path(pattern).relative_to(root)))
    return (path.as_posix() for path in matches if path.is_file())


def _no_asset(folder: str, foreign: Sequence[str], excluded: int) -> SatcheckError:
    """To be raised."""
    others = f", but {len(foreign):,} that no reader knows, as {foreign[0]}" if foreign else ""
    others += f", beside {excluded:,} that --exclude leaves out" if excluded else ""
    return SatcheckError("no-assets", f"{folder}: it has no mesh, scene or robot{others}")


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


def _below(folder: str, unlisted: list[str]) -> Iterator[str]:
    """All files. Each folder counts once, even if links form a cycle. Those that cannot be listed
    are added to `unlisted`."""
    visited = set()

    def add(error: OSError) -> None:
        unlisted.append(Path(error.filename).as_posix())

    walk = os.walk(folder, onerror=add, followlinks=True)
    for parent, folders, names in walk:
        status = Path(parent).stat()
        place = status.st_dev, status.st_ino
        folders[:] = sorted(n for n in folders if place not in visited and not n.startswith("."))
        if place not in visited:
            visited.add(place)
            paths = (Path(parent) / name for name in names if not name.startswith("."))
            yield from (path.as_posix() for path in paths)


def _is_asset(path: Path, permitted: Permitted) -> bool:
    ending = path.suffix.lower()
    if ending in SCENE_SUFFIXES:
        return _holds(path, _SCENE_MARKS, permitted) or _lacks_schema(path, permitted)
    if robots := robots_of(ending):
        texts = [each.texts for each in robots]
        if None in texts or reader_of_robot(path) is not None:
            return True
        return any(_holds(path, each, permitted) for each in texts if each)
    return mesh_reader(ending) is not None


def _lacks_schema(path: Path, permitted: Permitted) -> bool:
    """Return whether a file has bodies as a scene does, whose reader then asks for the schema."""
    if b"bodies" not in (content_of(path, permitted) or b""):
        return False
    from satcheck.scene.scene_file.text import SceneText

    try:
        tree = SceneText(str(path), permitted.most).document
    except Refused:
        return False
    if not isinstance(tree, dict) or str(tree.get("schema")).startswith("satcheck."):
        return False  # of another kind, as a report
    bodies = tree.get("bodies")
    return isinstance(bodies, list) and any(
        isinstance(body, dict) and "id" in body and body.keys() & _SHAPES for body in bodies
    )


def _holds(path: Path, marks: tuple[bytes, ...], permitted: Permitted) -> bool:
    """Return whether a file holds one of these texts, or cannot be read, or is blank: its content
    may be lost."""
    content = content_of(path, permitted)
    if content is None or any(mark in content for mark in marks):
        return True
    return not content.strip(b"\0 \t\r\n")
