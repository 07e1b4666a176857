"""Which assets changed since a revision of the git repositories that they lie in."""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

from satcheck.core.errors import SatcheckError
from satcheck.scene.access import Permitted, followed
from satcheck.scene.asset_files import content_of
from satcheck.scene.files.readers import SCENE_SUFFIXES, reader_of, robot_endings

# Files of these endings name no other file with geometry.
_ALONE = frozenset((".obj", ".stl", ".stla", ".stlb", ".ply", ".off"))
# Of scenes and robots.
_PLACING = SCENE_SUFFIXES.union(robot_endings(), (".srdf", ".xacro"))


class _Repository(NamedTuple):
    """tracked: files that git tracks. changed: files that changed, and untracked files."""

    tracked: set[Path]
    changed: set[Path]


def changed_since(revision: str, assets: Iterable[str], permitted: Permitted) -> list[str]:
    """The assets that changed since a revision, that git does not track, or that refer to a changed
    file, directly or through other files (a mesh of a scene, a buffer of a glTF file).

    A file refers to another one if it contains the other's name without the folder. The list may
    therefore include assets that have not changed. permitted: how large a file may be whose content
    is searched. Raises SatcheckError (`git`).
    """
    places = {path: followed(Path(path)) for path in assets}
    tracked: set[Path] = set()
    changed: set[Path] = set()
    for top in {_top_of(folder) for folder in {place.parent for place in places.values()}}:
        repository = _repository(top, revision)
        tracked |= repository.tracked
        changed |= repository.changed
    changed |= {place for place in places.values() if place not in tracked}
    naming = {path for path in tracked if _may_name(path)}
    changed |= _naming(changed, naming, permitted)
    # If a link leads to another folder, git lists the link and not the files behind it.
    return [
        path for path, place in places.items() if not changed.isdisjoint((place, *place.parents))
    ]


def _is_read(path: Path) -> bool:
    ending = path.suffix.lower()
    return ending in _PLACING or ending == ".bin" or reader_of(ending) is not None


def _may_name(path: Path) -> bool:
    ending = path.suffix.lower()
    return ending not in _ALONE and ending != ".bin" and _is_read(path)


def _naming(changed: set[Path], files: set[Path], permitted: Permitted) -> set[Path]:
    """Files that refer to a changed file, directly or through other files, or that cannot be
    read."""
    names = _Names({path.name for path in changed | files})
    named_by: dict[str, set[Path]] = defaultdict(set)
    naming: set[Path] = set()
    for path in files - changed:
        content = content_of(path, permitted)
        if content is None:
            naming.add(path)
            continue
        for name in names.within(content):
            named_by[name].add(path)
    waiting = {path.name for path in changed | naming}
    while waiting:
        more = named_by.pop(waiting.pop(), set()) - naming
        naming |= more
        waiting |= {path.name for path in more}
    return naming


class _Names:
    """Searches the bytes of files for names of files, ignoring case."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names: dict[bytes, set[str]] = defaultdict(set)
        for name in names:
            for spelling in _spellings(name):
                self._names[spelling.lower()].add(name)
        self._lengths = {len(spelling) for spelling in self._names}
        # Many names share few endings. A name without a dot is its own ending.
        ends = {spelling[max(0, spelling.rfind(b".")) :] for spelling in self._names}
        longest_first = sorted(ends, key=lambda end: (-len(end), end))
        self._ends = re.compile(b"|".join(map(re.escape, longest_first)))

    def within(self, content: bytes) -> set[str]:
        text = content.lower()
        named: set[str] = set()
        for match in self._ends.finditer(text):
            end = match.end()
            for length in self._lengths:
                named |= self._names.get(text[max(0, end - length) : end], set())
        return named


def _spellings(name: str) -> set[bytes]:
    """A name as plain text, as a URI, as in JSON and TOML, and as in XML."""
    as_json = (json.dumps(name, ensure_ascii=ascii)[1:-1] for ascii in (True, False))
    as_xml = escape(name, quote=False).replace('"', "&quot;")
    texts = (name, quote(os.fsencode(name)), *as_json, as_xml)
    return {os.fsencode(text) for text in texts}


def _repository(top: Path, revision: str) -> _Repository:
    commit = _commit(top, revision)
    differing = _names(top, "diff", "--no-renames", "--ignore-submodules=none", "--name-only", "-z",
                       commit, "--")  # fmt: skip
    new = _names(top, "ls-files", "--others", "--exclude-standard", "-z")
    ignored = _names(top, "ls-files", "--others", "--ignored", "--exclude-standard", "-z")
    # Build folders hold many ignored files that nothing reads.
    read = {path for path in ignored if _is_read(path)}
    changed = differing | new | read
    resolved = {followed(path) for path in changed}  # a link that changed leads elsewhere now
    return _Repository(_names(top, "ls-files", "-z"), changed | resolved)


def _names(top: Path, *arguments: str) -> set[Path]:
    return {top / name for name in _git(top, *arguments).split("\0") if name}


def _top_of(folder: Path) -> Path:
    if _git(folder, "rev-parse", "--show-superproject-working-tree").strip():
        raise SatcheckError(
            "git",
            f"{folder} lies in a submodule, whose revisions are others: check the submodule by "
            "itself",
        )
    return Path(_git(folder, "rev-parse", "--show-toplevel").rstrip("\n"))


def _commit(top: Path, revision: str) -> str:
    try:
        name = f"{revision}^{{commit}}"
        return _git(top, "rev-parse", "--verify", "--end-of-options", name).strip()
    except SatcheckError:
        shallow = _git(top, "rev-parse", "--is-shallow-repository").strip() == "true"
        advice = (
            "the clone is shallow: git fetch --unshallow gets all revisions"
            if shallow
            else "give a branch, a tag or a commit; git fetch gets those of the server"
        )
        raise SatcheckError("git", f"{top}: no revision {revision}: {advice}") from None


def _git(folder: Path, *arguments: str) -> str:
    command = ("git", "-C", str(folder), *arguments)
    try:
        ran = subprocess.run(command, capture_output=True, text=True, errors="surrogateescape")
    except OSError as error:
        raise SatcheckError(
            "git", f"git cannot be run ({error.strerror}): --changed-since needs it"
        ) from None
    if ran.returncode:
        raise SatcheckError("git", f"{folder}: --changed-since asks git: {ran.stderr.strip()}")
    return ran.stdout
