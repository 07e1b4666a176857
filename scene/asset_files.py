"""Which files of a folder are assets: meshes, scenes and robots, each to be checked on its own."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from satcheck.core.errors import SatcheckError
from satcheck.scene.input_kind import SCENE_SUFFIXES, is_robot
from satcheck.scene.loading.readers import mesh_reader, robots
from satcheck.scene.loading.regular_file import size_of
from satcheck.scene.path_kind import exists, is_folder

# Most JSON and TOML is something else, unless it holds one of these texts.
_SCENE_MARKS = (b"satcheck.scene/1", b"satcheck-scene-1")
_PATTERN = frozenset("*?[")


def asset_files(given: Iterable[str]) -> list[str]:
    """Expands the given names into a list of asset files, each once. A file stands for itself. A
    folder stands for all assets at any depth, sorted by name. A pattern (`*`, `**`, `?`, `[...]`)
    stands for its matches.

    In folders, names that begin with a dot are left out, and links to folders are followed. A
    folder that cannot be listed stays in the list, and its reader reports why. Raises
    SatcheckError: `no-assets` if a folder or a pattern has no asset, `bad-pattern`.
    """
    files: dict[str, None] = {}
    for name in given:
        files |= dict.fromkeys(_meant_by(name))
    return list(files)


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
    elif _PATTERN.intersection(name) and not exists(name):
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


def _no_match(pattern: str) -> SatcheckError:
    """To be raised."""
    deeper = (Path(pattern).parent / "**" / Path(pattern).name).as_posix()
    hint = "" if "**" in pattern else f": {deeper} searches sub-folders too"
    return SatcheckError("no-assets", f"{pattern}: the pattern matches no file here{hint}")


def _refuse_pattern(name: str) -> None:
    for part in Path(name).parts:
        if "**" in part and part != "**":
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
    if ending in SCENE_SUFFIXES:
        return _holds(path, _SCENE_MARKS)
    for reader in robots().values():
        if ending in reader.endings:
            marks = reader.marks
            return marks is None or is_robot(path) or (bool(marks) and _holds(path, marks))
    return mesh_reader(ending) is not None


def _holds(path: Path, marks: tuple[bytes, ...]) -> bool:
    """Return whether a file holds one of these texts, or cannot be read."""
    content = content_of(path)
    # JSON may write a slash with a backslash.
    plain = None if content is None else content.replace(b"\\/", b"/")
    return plain is None or any(mark in plain for mark in marks)
