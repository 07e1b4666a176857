"""The inputs of a command: the options that choose files, and the scene made from them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import Any, Self

import click
from click.core import ParameterSource

from satcheck.audit.words import counted
from satcheck.cli.option import STANDARD_OUTPUT, origin_of
from satcheck.cli.output import cannot_write, talk, tell_issues
from satcheck.cli.progress import Bar
from satcheck.core import keep_freed_memory
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene, Selector
from satcheck.scene.access import Permitted
from satcheck.scene.files.readers import ReadLimits, ReadOptions, kind_of
from satcheck.scene.loader import LoadOptions, is_mesh, is_rules
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.opening import exists, is_folder

# Issues about what has no body.
_OF_NO_BODY = frozenset(
    ("not-a-body", "left-out", "no-shape", "ignored-geometry", "no-collision-geometry")
) | {"no-surface", "unknown-element", "unread"}


class Inputs(LoadOptions, frozen=True, kw_only=True):
    """The values of options, each under the name of its option. folders: among the paths, or meant
    by them."""

    paths: tuple[str, ...]
    exclude: tuple[str, ...] = ()
    pose: tuple[str, ...] = ()
    state: tuple[str, ...] = ()
    sample: int | None = None
    seed: int | None = None
    joint_path: str | None = None
    merge: bool = False
    limit: Mapping[str, float] = {}

    @classmethod
    def taken_from(cls, options: dict[str, Any]) -> Self:
        """Removes its own options from `options` and leaves the others, with the limits of reading
        a file, which a report states."""
        values = {name: options.pop(name) for name in cls.__struct_fields__ if name in options}
        if limit := values.get("limit"):
            per_file = {f"{name}_per_file": limit[name] for name in ("seconds", "megabytes")}
            values |= per_file
            options |= per_file
        return cls(**values)

    def mesh_files(self, reading: ReadOptions) -> MeshFiles:
        """To read the mesh files of a scene once more, with the options that it has read them
        with."""
        limits = ReadLimits(self.seconds_per_file, self.permitted, hashed=False, options=reading)
        return MeshFiles(limits)

    @property
    def permitted(self) -> Permitted:
        """Return the limit of files that are read before or after a check."""
        return Permitted(anywhere=True, megabytes=self.megabytes_per_file)

    @property
    def has_poses(self) -> bool:
        given = self.pose or self.state or self.joint_path or self.sample
        return bool(given or self.seed is not None)

    @property
    def random_seed(self) -> int | None:
        """The seed of the random poses, if there are any."""
        return (self.seed or 0) if self.sample else None


def refuse_early(
    inputs: Inputs, outputs: Iterable[Path | None] = (), baseline: Path | None = None
) -> None:
    """Refuse what can be seen to fail before any work is done: no file may overwrite an input or
    another output. outputs: None, like -, is standard output."""
    if not inputs.paths:
        raise click.UsageError("give two or more mesh files, or a scene file")
    _refuse_first_word(inputs.paths[0])
    known = () if baseline is None else (str(baseline),)
    swept = () if inputs.joint_path is None else (inputs.joint_path,)
    read = (*inputs.paths, *inputs.pose, *swept, *inputs.rules, *known)
    places: list[Path] = []
    for output in (each for each in outputs if each is not None and each != STANDARD_OUTPUT):
        if not is_folder(output.absolute().parent):
            raise cannot_write(str(output), "its folder does not exist")
        if _is_among(output, read):
            raise click.UsageError(f"{output} would overwrite an input")
        if output.absolute() in places or _is_among(output, places):
            raise click.UsageError(f"{output} is given twice")
        places.append(output.absolute())


def _is_among(output: Path, files: Iterable[str | Path]) -> bool:
    """Return whether the file exists, and is one of these."""
    try:
        same = output.stat()
    except (OSError, ValueError):
        return False
    for path in files:
        with suppress(OSError, ValueError):  # it does not exist
            if os.path.samestat(same, os.stat(path)):  # noqa: PTH116  there may be thousands
                return True
    return False


def load(inputs: Inputs, hashed: bool = True, least: int = 2, *, tell_all: bool = False) -> Scene:
    """The bodies; inputs that cannot be used are told on stderr.

    hashed: whether the document states the SHA-256 of files. least: how many bodies are needed.
    tell_all: warnings and notes, too, as no document has them.
    UsageError for fewer, for several worlds, and for a split of what says itself what its bodies
    are; ClickException where no input is left.
    """
    if least > 1 and len(worlds := worlds_of(inputs)) > 1:
        named = " and ".join(world[0] for world in worlds[:2])
        raise click.UsageError(
            f"{named} are scenes, each a world of its own: give one of them, or --merge"
        )
    paths = inputs.paths
    if inputs.merge and _is_typed("merge") and sum(kind_of(each) == "scene" for each in paths) < 2:
        talk("satcheck: note: --merge has no effect: it is about several scene files")
    if inputs.split and not any(map(is_mesh, paths)):
        raise click.UsageError("--split is about mesh files: a scene says what its bodies are")
    keep_freed_memory()
    with Bar("files", f"reading {counted(len(paths), 'file')}"):
        try:
            must_count = typed(inputs.reading)
            scene = inputs.load(paths, hashed=hashed, must_count=must_count)
        except SatcheckError as error:
            raise _with_view(error, paths) from None
    _refuse_unknown(inputs.between, scene)
    if inputs.units and _is_typed("units") and _is_stated(paths, scene):
        instead = f'units = "{inputs.units}" of a body in a scene file overrides it'
        talk(f"satcheck: note: --units has no effect: each file states its unit; {instead}")
    told = (issue for issue in scene.issues if tell_all or issue.severity == "error")
    tell_issues(dict.fromkeys(told))
    advice = _advice(paths, scene)
    if scene.asks_for_support or scene.asks_for_regions:
        least = 1
    if len(scene.bodies) + len(scene.unreadable) < least:
        if scene.unreadable:
            said = "an input could not be used: there is no pair to check"
            raise click.ClickException("\n".join([said, *advice]))
        tell_issues(issue for issue in scene.issues if issue.code in _OF_NO_BODY)
        if not scene.bodies:
            raise click.UsageError(f"there is no body: {_more(inputs)}")
        raise _one_body(inputs, scene)
    for line in advice:
        talk(line)
    return scene


def _with_view(error: SatcheckError, paths: Sequence[str]) -> Exception:
    """Return the error, with the command for a stored report that is given as an input."""
    from satcheck.cli.slips import about_stored

    advice = about_stored(paths)
    return click.ClickException(f"{error} [{error.code}]\n{advice}") if advice else error


def _refuse_unknown(between: Sequence[tuple[str, str]], scene: Scene) -> None:
    """Refuse a name of --between that selects nothing, unless an input cannot be read."""
    for name in () if scene.unreadable else chain.from_iterable(between):
        selector = Selector(name)
        if not selector.select(scene.bodies):
            raise click.UsageError(f"{origin_of('between')}: {selector.unmatched(scene.bodies)}")


def _is_stated(paths: Sequence[str], scene: Scene) -> bool:
    """Return whether all inputs are mesh files that state their unit."""
    read = [body.file for body in scene.bodies]
    return bool(read) and all(map(is_mesh, paths)) and all(file.units for file in read)


def typed(read: ReadOptions) -> ReadOptions:
    """Return the options of readers if the call gives them, and not a config file, which is about
    other files, too."""
    return read if _is_typed("reading") else {}


def _is_typed(name: str) -> bool:
    ctx = click.get_current_context(silent=True)
    return bool(ctx and ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE)


def worlds_of(inputs: Inputs) -> list[tuple[str, ...]]:
    """The files of each world: with several scene files each of them is one, and the other files
    are in all of them. The scene comes first. With `merge` all files are one world."""
    scenes = [path for path in inputs.paths if kind_of(path) == "scene"]
    if inputs.merge or len(scenes) < 2:
        return [inputs.paths]
    scenes = [path for path in scenes if _has_bodies(path, inputs.permitted)]
    if len(scenes) < 2:
        return [inputs.paths]
    others = [path for path in inputs.paths if path not in scenes]
    return [(scene, *others) for scene in scenes]


def _has_bodies(scene: str, permitted: Permitted) -> bool:
    """A scene file that is wrong counts: the check of its world says why."""
    try:
        return not is_rules(scene, permitted)
    except SatcheckError:
        return True


def _more(inputs: Inputs) -> str:
    mesh = next(filter(is_mesh, inputs.paths), None)
    if mesh is None:
        return f"give mesh files beside {inputs.paths[0]}, or a scene of two bodies"
    return "give two or more mesh files, or a scene file"


def _one_body(inputs: Inputs, scene: Scene) -> click.ClickException:
    """To be raised."""
    alone = next(iter(scene.bodies))
    if inputs.split == "components":
        return click.ClickException(
            f"one body alone cannot collide: {alone.file.path} is one piece"
        )
    if len(inputs.paths) > 1 or not is_mesh(inputs.paths[0]):
        return click.UsageError(f"one body alone cannot collide: {_more(inputs)}")
    from satcheck.cli.slips import about_one_body

    advice = about_one_body(inputs.paths[0], alone.file.health.components)
    return click.ClickException("\n".join(["one body alone cannot collide", *map(str, advice)]))


def _refuse_first_word(word: str) -> None:
    if exists(word):
        return
    from satcheck.cli.slips import about_first_word

    if advice := about_first_word(word):
        raise click.ClickException(f"there is no command {word}\n{advice}")


def _advice(paths: Sequence[str], scene: Scene) -> list[str]:
    """Lines about paths that look like slips."""
    if scene.unreadable:
        from satcheck.cli.slips import about_stored

        if stored := about_stored(paths):
            return [str(stored)]
    if all(map(os.path.isfile, paths)) and len(set(paths)) == len(paths):
        return []
    from satcheck.cli.slips import about_paths

    return [str(advice) for advice in about_paths(paths)]
