"""Which files of a folder are assets: meshes, scenes and robots, each to be checked on its own."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from urllib.parse import quote

from satcheck.core.errors import SatcheckError
from satcheck.scene.input_kind import SCENE_SUFFIXES
from satcheck.scene.loading.source import FORMATS

_ALWAYS = frozenset((*FORMATS, ".urdf"))
# Other JSON and TOML files lie in most folders.
_SCENE_MARKS = (b"satcheck.scene/1", b"satcheck-scene-1")
_PATTERN = frozenset("*?[")


def asset_files(given: Iterable[str], *, drawings: Iterable[str] = ()) -> list[str]:
    """The files that these names mean, each once: files as given, the assets of folders and what
    lies below them in the order of names, what patterns (`*`, `**`, `?`, `[...]`) match.

    drawings: endings of further files that are assets. In folders, names that begin with a dot are
    left out. Raises SatcheckError (`no-assets`) where a folder or a pattern has none.
    """
    endings = _ALWAYS.union(drawings)
    files: dict[str, None] = {}
    for name in given:
        files |= dict.fromkeys(_meant_by(name, endings))
    return list(files)


def _meant_by(name: str, endings: frozenset[str]) -> list[str]:
    if Path(name).is_dir():
        assets = sorted(path for path in _below(name) if _is_asset(path, endings))
    elif _PATTERN.intersection(name) and not Path(name).exists():
        root = Path(name).anchor
        matches = Path(root).glob(str(Path(name).relative_to(root)))
        assets = sorted(path.as_posix() for path in matches if path.is_file())
    else:
        return [name]
    if not assets:
        raise SatcheckError("no-assets", f"{name}: no mesh, scene or robot is there")
    return assets


def _below(folder: str) -> Iterator[str]:
    for parent, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        for name in names:
            if not name.startswith("."):
                yield (Path(parent) / name).as_posix()


def _is_asset(path: str, endings: frozenset[str]) -> bool:
    ending = Path(path).suffix.lower()
    if ending in SCENE_SUFFIXES:
        return any(mark in _bytes(path) for mark in _SCENE_MARKS)
    return ending in endings


def changed_since(revision: str, assets: Iterable[str]) -> list[str]:
    """The assets that changed since a revision of the git repositories that they lie in, or that
    name a changed file: a mesh of a scene, a buffer of a glTF file, and so on.

    Files that git does not track yet have changed. Raises SatcheckError (`git`).
    """
    listed = list(assets)
    changed = _changed_files(revision, {Path(path).resolve().parent for path in listed})
    names = {path.name for path in changed}
    chosen = {path for path in listed if Path(path).resolve() in changed}
    size = -1
    while size != len(chosen):  # an asset may name an asset that names a changed file
        size = len(chosen)
        marks = [mark for name in names for mark in (os.fsencode(name), quote(name).encode())]
        others = [path for path in listed if path not in chosen]
        naming = {path for path in others if any(mark in _bytes(path) for mark in marks)}
        chosen |= naming
        names = {Path(path).name for path in naming}
    return [path for path in listed if path in chosen]


def _changed_files(revision: str, folders: set[Path]) -> set[Path]:
    tops = {Path(_git(folder, "rev-parse", "--show-toplevel").rstrip("\n")) for folder in folders}
    changed: set[Path] = set()
    for top in tops:
        commit = _git(top, "rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
        tracked = _git(top, "diff", "--name-only", "-z", commit.strip(), "--")
        new = _git(top, "ls-files", "--others", "--exclude-standard", "-z")
        changed |= {(top / name).resolve() for name in f"{tracked}\0{new}".split("\0") if name}
    return changed


def _git(folder: Path, *arguments: str) -> str:
    command = ("git", "-C", str(folder), *arguments)
    try:
        ran = subprocess.run(command, capture_output=True, text=True, errors="surrogateescape")
    except OSError as error:
        raise SatcheckError("git", f"git cannot be run: {error.strerror}") from None
    if ran.returncode:
        raise SatcheckError(
            "git", f"{folder}: git {arguments[0]} {arguments[-1]}: {ran.stderr.strip()}"
        )
    return ran.stdout


def _bytes(path: str) -> bytes:
    """Nothing of a file that cannot be read: whoever reads it next says why."""
    try:
        return Path(path).read_bytes()
    except OSError:
        return b""
