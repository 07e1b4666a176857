"""Paths -> Scene: every path contributes bodies; what cannot be read is said, not dropped."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.core.errors import SatcheckError
from satcheck.scene.bodies import Scene
from satcheck.scene.input_kind import kind_of
from satcheck.scene.mesh_files import (
    DEFAULT_MEGABYTES_PER_FILE,
    DEFAULT_SECONDS_PER_FILE,
    MeshFiles,
)
from satcheck.scene.plain_ids import plain_ids
from satcheck.scene.scene_builder import SceneBuilder, Split
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from satcheck.scene.format.entries import SceneFile


def load_scene(
    paths: Sequence[str | Path],
    *,
    split: Split | None = None,
    seconds_per_file: float = DEFAULT_SECONDS_PER_FILE,
    megabytes_per_file: int = DEFAULT_MEGABYTES_PER_FILE,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
    hashed: bool = True,
    units: str | None = None,
    meanwhile: Callable[[], object] | None = None,
) -> Scene:
    """All bodies of the given mesh files, scene files and robots, in that order.

    Inputs that state different units of length are converted into one (`common_units`); bodies of
    which none is known have `units` None, and pairs of them with others are not decided. units: of
    the inputs that state none. Up-axes are not converted. split: which bodies a mesh file is.
    "none": one, the whole file, flattened (nodes, instances and build items applied). "nodes": one
    for each node of a GLB or glTF file with a mesh, and for each way from the build of a 3MF file,
    or the root of a 3DXML file, to an object with a mesh; other formats have no nodes.
    "components": these taken apart into pieces that share no edge. None: "nodes" for one file
    alone, otherwise "none". Files without bodies of their own, of rules or SRDF, count as no file
    here: they change no body and no id.
    A `.toml` file is a scene of the form satcheck.scene/1, a `.json` file one of this form or of
    satcheck-scene-1; its groups are its own, and get -2, -3, ... where several scenes have them;
    its rules are about its own bodies, mesh files and robots, without own bodies about all.
    A `.urdf` file, or one of another ending that is XML with <robot> around it, is a robot at rest,
    a body for each <collision>; a `.srdf` file says which of its links may touch. packages: where
    the packages lie that a URDF names, see `robot.MeshPlaces`.
    Ids are those of the scene file or of the links, or of `plain_ids`, or the paths of nodes (after
    the id of their file where there are several), with -2, -3, ... where they occur again.
    allow_outside: the files that a scene, a robot or a glTF file names may lie outside of its
    folder. hashed: whether the SHA-256 of each file is taken, which some reports state. meanwhile:
    what this thread may do while others read large files; called at most once.
    seconds_per_file, megabytes_per_file: limits for reading one mesh file.

    A mesh file, or a node of one, that cannot be used becomes an Unreadable with an error issue and
    the rest still loads. Raises SceneFileError for a scene file or a robot that is wrong in itself.
    """
    if isinstance(paths, str | Path):
        raise SatcheckError("bad-argument", f"paths: a list of paths, not one: [{str(paths)!r}]")
    files = MeshFiles(
        seconds_per_file, megabytes_per_file, allow_outside=allow_outside, hashed=hashed
    )
    builder = SceneBuilder(files, None if units is None else _unit(units))
    given = [path.as_posix() if isinstance(path, Path) else path for path in paths]
    scenes = _read_scenes(given, allow_outside)
    ids = iter(plain_ids([path for path in given if is_mesh(path)]))
    alone = sum(_has_bodies(path, scenes) for path in given) == 1
    if split is None:
        split = "nodes" if alone else "none"
    if split == "none":
        files.read_ahead(((path, Path(path)) for path in given if is_mesh(path)), meanwhile)
    for path in given:
        kind = kind_of(path)
        if kind == "scene":
            builder.add_scene(scenes[path])
        elif kind == "robot":
            builder.add_robot(path, Path(path), packages, allow_outside)
        elif kind == "srdf":
            builder.add_srdf(path, Path(path))
        elif split == "none":
            builder.add_mesh(next(ids), path, Path(path))
        else:
            builder.add_nodes(next(ids), path, Path(path), split, alone)
    return builder.scene()


def _unit(name: str) -> str:
    found = unit_of(name)
    if found is None:
        known = ", ".join(MICROMETRES)
        raise SatcheckError("bad-argument", f"units: one of {known}, not {name!r}")
    return found


def _read_scenes(given: Sequence[str], allow_outside: bool) -> dict[str, SceneFile]:
    """The scene files among the inputs, by their paths. Raises SceneFileError."""
    paths = [path for path in given if kind_of(path) == "scene"]
    if not paths:
        return {}
    from satcheck.scene.format.reading import read_scene_file

    return {path: read_scene_file(path, Path(path), allow_outside=allow_outside) for path in paths}


def is_rules(path: str) -> bool:
    """Whether it is a scene file without bodies: rules about those of others. Raises
    SceneFileError."""
    scene = _read_scenes([path], allow_outside=True).get(path)
    return scene is not None and not scene.bodies


def _has_bodies(path: str, scenes: Mapping[str, SceneFile]) -> bool:
    return bool(scenes[path].bodies) if path in scenes else kind_of(path) != "srdf"


def is_mesh(path: str) -> bool:
    """Whether it is to be read as a mesh file, and not as a scene or a robot."""
    return kind_of(path) == "mesh"
