"""Ids for bodies: short names for readers, each used once."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import PurePath

from satcheck.scene.paths import name_of

HULL_MARK = "#hull"  # after the path of a node, or alone: the convex hull of the mesh
COMPONENT_MARK = "#"  # between the path of a node and a component number; never in names


class UniqueNames:
    """Makes names unique: repeated names get the suffix -2, -3, ..."""

    def __init__(self) -> None:
        self._given: dict[str, int] = {}

    def unique(self, wanted: str) -> str:
        name = wanted
        while name in self._given:
            self._given[wanted] += 1
            name = f"{wanted}-{self._given[wanted]}"
        self._given[name] = 1
        return name


def plain_ids(paths: Sequence[str]) -> list[str]:
    """One id for each path, in that order. The id is the stem. If different paths share a stem, the
    ids are the shortest ends of the paths that differ ("left/part", "right/part"), with the
    suffixes if only these differ. Paths to the same file get the same id.
    """
    same_stem: dict[str, dict[str, str]] = {}
    places = list(map(os.path.abspath, paths))
    for path, place in zip(paths, places, strict=True):
        same_stem.setdefault(name_of(path)[0] or path, {}).setdefault(place, path)
    ids: dict[str, str] = {}
    for stem, distinct in same_stem.items():
        names = [stem] if len(distinct) == 1 else _shortest_ends(distinct.values())
        ids.update(zip(distinct, names, strict=True))
    return [ids[place] for place in places]


def _shortest_ends(given: Iterable[str]) -> list[str]:
    paths = [PurePath(os.path.normpath(path)) for path in given]
    longest = max(len(path.parts) for path in paths)
    for named in ([path.parent / path.stem for path in paths], paths):
        for length in range(1, longest + 1):
            ends = [PurePath(*path.parts[-length:]).as_posix() for path in named]
            if len(set(ends)) == len(ends):
                return ends
    return [path.as_posix() for path in paths]
