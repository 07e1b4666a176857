"""Where pairs come from: pair files, the index of the samples, folders of meshes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

from bench.accuracy.case import Case, Stated

PAIR_FILE, SAMPLE_INDEX = "pairs.json", "index.json"
# Words of both kinds of file; what touches may be called either.
OVERLAPPING = ("overlap", "contained", "penetrating", "contains", "inside", "coincident")
APART = "separated"


@dataclass(frozen=True, slots=True)
class Corpus:
    name: str
    cases: tuple[Case, ...]


def read(path: Path) -> Corpus:
    """path: a pair file, an index of samples, or a folder with one of them; of any other folder,
    every two of its mesh files. Raises ValueError where there is no pair."""
    source = path.resolve()
    if source.is_dir():
        files = [source / name for name in (PAIR_FILE, SAMPLE_INDEX)]
        source = next((file for file in files if file.is_file()), source)
    folder = source if source.is_dir() else source.parent
    if source.is_dir():
        cases = tuple(_of_folder(folder))
    else:
        content = json.loads(source.read_text(encoding="utf-8"))
        made = _of_samples if "meshes" in content else _of_pairs
        cases = tuple(made(content["pairs"], folder))
    if not cases:
        raise ValueError(f"{path}: no pair of meshes")
    return Corpus(folder.name, cases)


def given(meshes: tuple[Path, Path]) -> Case:
    """Two files that the caller names."""
    return _as_they_stand(meshes)


def _of_pairs(entries: list[dict[str, Any]], folder: Path) -> Iterator[Case]:
    for entry in entries:
        meshes = (str(folder / entry["a"]["mesh"]), str(folder / entry["b"]["mesh"]))
        transforms = (entry["a"]["transform"], entry["b"]["transform"])
        said = entry.get("truth", {})
        stated = Stated(
            overlap=_overlap(said.get("verdict")),
            way_out=said.get("best_known_length"),
            distance=said.get("distance"),
        )
        yield Case(f"{folder.name}/{entry['id']}", meshes, transforms, stated)


def _of_samples(entries: list[dict[str, Any]], folder: Path) -> Iterator[Case]:
    """Without the options that ask the same two meshes for more."""
    seen: set[tuple[str, ...]] = set()
    for entry in entries:
        names = tuple(entry["inputs"])
        if names in seen:
            continue
        seen.add(names)
        a, b = (str(folder / name) for name in names)
        # Exit code 3: the relation is not decided.
        known = entry["exit"] != 3
        stated = Stated(
            overlap=_overlap(entry["relation"]) if known else None, depth=entry["depth"]
        )
        yield Case(f"{folder.name}/{entry['name']}", (a, b), None, stated)


def _of_folder(folder: Path) -> Iterator[Case]:
    from satcheck.scene.files.readers import mesh_reader  # not before it is needed: see case.py

    files = sorted(path for path in folder.iterdir() if mesh_reader(path.suffix) is not None)
    yield from (_as_they_stand(two) for two in combinations(files, 2))


def _as_they_stand(meshes: tuple[Path, Path]) -> Case:
    a, b = (path.resolve() for path in meshes)
    return Case(f"{a.parent.name}/{a.stem}-{b.stem}", (str(a), str(b)))


def _overlap(verdict: str | None) -> bool | None:
    if verdict in OVERLAPPING:
        return True
    return False if verdict == APART else None
