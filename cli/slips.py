"""Typical slips on the command line, and what to type instead.

The commands are made from the words of this call, so that they work when they are copied.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from satcheck.cli.commands import COMMANDS, DEFAULT_COMMAND, command_named, is_command
from satcheck.core.errors import SatcheckError
from satcheck.scene.asset_files import asset_files
from satcheck.scene.files.readers import mesh_reader, options
from satcheck.scene.loader import is_mesh
from satcheck.scene.opening import exists, is_file, is_folder
from satcheck.scene.units import MICROMETRES

if TYPE_CHECKING:
    from satcheck.scene import Scene
    from satcheck.scene.bodies import Body

# From so many mesh files on they may be assets, and not parts.
FEWEST_ASSETS = 4
# More files than this make no line that anybody copies.
MOST_FILES = 8
# An option of more commands does not tell which is meant.
MOST_OWNERS = 2
_PATTERN = frozenset("*?[")
_STORED = re.compile(rb'\s*{\s*"schema": ?"satcheck\.(report|assets|samples|result)/')
# Options about the document, not about the answer. Limits differ by command.
_DELIVERY = frozenset(("form", "output", "outputs", "quiet", "top", "color", "exit_zero", "limit"))
# Options of other programs, and what they are here. The names of our formats are among them, and
# those that stand before the name of a file to write.
_WRITERS = ("picture", "image", "save", "report")
_ALIASES = {
    "html": "-o report.html",
    "picture": "-o picture.png",
    "image": "-o picture.png",
    "out": "-o",
    "output-format": "--format",
    "verbose": "--explain",
    "v": "--explain",
    "threads": "--jobs",
    "distance": "--clearance",
    "interference": "--max-thickness",
    "max-interference": "--max-thickness",
    "max-overlap": "--max-thickness",
    "overlap": "--max-thickness",
}
# Words of other programs, and of earlier versions, for a command; "": for none.
_WORDS = {"check": "", "help": "--help", "each": "batch", "report": "view"}


class Advice(NamedTuple):
    """What a command is for, and the command, if there is one to type."""

    purpose: str
    command: str = ""

    def __str__(self) -> str:
        said = f"satcheck: {self.purpose}"
        return f"{said}:\n  {self.command}" if self.command else said


class _Pattern(str):
    """A word that the shell has to expand: it is not quoted."""


def about_first_word(word: str) -> Advice | None:
    """Return what to type in place of a word that names neither a file nor a command."""
    rest = [each for each in sys.argv[1:] if each != word]
    if exists(word) or word not in sys.argv[1:]:
        return None
    is_word = word in _WORDS or (_is_check() and "." not in word and _nearest(word) is None)
    named = _close(word, [*COMMANDS, *_WORDS], 0.6) if is_word else None
    if named is None:
        return None
    meant = _WORDS.get(named, named)
    if not meant:
        return Advice(f"a check has no name: leave out the word {word}", _line(rest))
    if meant == "--help":
        return Advice("this shows the help", _line([*filter(COMMANDS.__contains__, rest), meant]))
    return Advice(f"did you mean the command {meant}", _line([meant, *rest]))


def about_option(error: click.NoSuchOption) -> Advice | None:
    """Return what to type in place of an option that the command does not have."""
    words, wrong = sys.argv[1:], error.option_name
    known = _names(error.ctx.command) if error.ctx else []
    place = next((k for k, word in enumerate(words) if word.partition("=")[0] == wrong), None)
    if place is None:
        return None
    _, equals, value = words[place].partition("=")
    before, after, name = words[:place], words[place + 1 :], wrong.lstrip("-")
    if words[0] == "baseline" and wrong in ("-o", "--output") and after:
        line = _line([*words[:2], after[0], *words[2:place], *after[1:]])
        return Advice("the baseline comes before the reports", line)
    following = value if equals else "".join(after[:1])
    option = options().get(name.replace("-", "_")) if "--read" in known else None
    if option is not None:
        is_switch = option[0].type is bool and not equals
        after = after if equals or is_switch else after[1:]
        right = ["--read", f"{name}={'true' if is_switch else following}"]
    elif advice := _of_others(wrong, words):
        return advice
    elif right := _meant(name, following, known):
        right += [value] if equals else []
    return Advice("did you mean", _line([*before, *right, *after])) if right else None


def _of_others(option: str, words: Sequence[str]) -> Advice | None:
    """Return the commands that have this option, and the call of the first if it is one of a few.
    words: of this call."""
    commands = {name: command_named(name) for name in (DEFAULT_COMMAND, *COMMANDS)}
    owners = [name for name, command in commands.items() if command and option in _names(command)]
    if not owners:
        return None
    named = ("satcheck A B" if name == DEFAULT_COMMAND else f"satcheck {name}" for name in owners)
    said = f"{option} is an option of {', '.join(named)}"
    if DEFAULT_COMMAND in owners or len(owners) > MOST_OWNERS:
        return Advice(said)
    rest = words[1:] if is_command(words[0]) else words
    return Advice(said, _line([owners[0], *rest]))


def _names(command: click.Command) -> list[str]:
    """Return how its options are spelled."""
    return [name for each in command.params for name in (*each.opts, *each.secondary_opts)]


def _meant(wrong: str, following: str, known: Sequence[str]) -> list[str]:
    """Return the option that is meant; nothing if none is near. following: the word after it, or
    its value."""
    from satcheck.cli.formats.registry import ALL, REPORTS, formats

    ending = Path(following).suffix.removeprefix(".")
    if ending in formats(ALL) and wrong in (*_WRITERS, ending) and "-o" in known:
        return ["-o"]
    alias = f"--format {wrong}" if wrong in formats(REPORTS) else _ALIASES.get(wrong, "")
    if alias and alias.split()[0] in known:
        return alias.split()
    near = _close(f"--{wrong}", known, 0.75)
    return [near] if near else []


def about_paths(paths: Sequence[str]) -> Iterator[Advice]:
    """Yield what to type in place of folders, patterns, and files that do not exist or are given
    twice."""
    bad = [path for path in paths if not is_file(path)]
    words = sys.argv[1:]
    for k, (value, unit) in enumerate(pairwise(words)):
        is_length = re.fullmatch(r"(--[a-z-]+=)?[0-9.]+", value) is not None
        if is_length and unit in bad and unit.lower() in MICROMETRES:
            line = _line([*words[:k], f"{value}{unit}", *words[k + 2 :]])
            yield Advice("a length has no space", line)
            return
    if near := {path: [other] for path in bad if (other := _nearest(path)) is not None}:
        yield Advice("did you mean", _line(_replaced(near)))
    yield from _about_folders([path for path in bad if is_folder(path)], paths)
    patterns = (path for path in bad if not is_folder(path) and _PATTERN.intersection(path))
    for path in patterns:
        yield from _about_pattern(path)
    files = Counter(os.path.realpath(path) for path in paths if is_file(path))
    twice = next((path for path in paths if files[os.path.realpath(path)] > 1), None)
    if twice is not None and mesh_reader(Path(twice).suffix) is not None:
        purpose = f"{twice} is given twice, so its bodies coincide. To check its pieces"
        yield Advice(purpose, _line(["--split", "components", twice]))


def about_stored(paths: Sequence[str]) -> Advice | None:
    """Return the command that shows a stored report among the inputs."""
    for path in filter(is_file, paths):
        with Path(path).open("rb") as file:
            if _STORED.match(file.read(100)):
                return Advice(f"{path} is a stored report. To show it", _line(["view", path]))
    return None


def about_assets(paths: Sequence[str], scene: Scene) -> list[Advice]:
    """Return the batch of mesh files most of which hold the origin, as files of assets do. Parts of
    one assembly stand beside each other."""
    if len(paths) < FEWEST_ASSETS or not all(map(is_mesh, paths)):
        return []
    around: dict[str, bool] = {}
    for body in scene.bodies:
        around[body.file.path] = around.get(body.file.path, False) or _holds_origin(body)
    if 2 * sum(around.values()) <= len(around):
        return []
    purpose = f"{sum(around.values()):,} of {len(around):,} files lie around the origin. "
    line = _line(["batch", *(_one_folder(paths) or sys.argv[1:])])
    return [Advice(f"{purpose}If each file is an asset of its own", line)]


def _holds_origin(body: Body) -> bool:
    """Return whether the box of the body holds the origin, or misses it by a tenth of its size, as
    that of a thing that stands on the ground may."""
    try:
        low, high = body.world_mesh().bounds
    except (OverflowError, ValueError):  # the check says so
        return False
    reach = max(b - a for a, b in zip(low, high, strict=True)) / 10
    return all(a - reach <= 0.0 <= b + reach for a, b in zip(low, high, strict=True))


def about_one_body(path: str, components: int) -> Iterator[Advice]:
    """Yield what to do with a mesh file that is alone. components: connected, of its mesh."""
    yield Advice(f"to check the mesh of {path} alone", _line(["batch", path]))
    others = (file for file in _meshes(Path(path).parent) if file.name != Path(path).name)
    if (other := next(others, None)) is not None:
        yield Advice("to check it against another mesh", _line([*sys.argv[1:], str(other)]))
    if components > 1:
        words = [*sys.argv[1:], "--split", "components"]  # the last one counts
        yield Advice("to check its connected pieces", _line(words))


def call_of(name: str, paths: Sequence[str], more: Sequence[str] = ()) -> str:
    """Return a call of another command on these paths, with the options of this call that it has
    and that change the answer. more: words at the end."""
    ctx = click.get_current_context()
    command = command_named(name)
    assert command is not None
    known = {option.name for option in command.params} - _DELIVERY
    values, _, order = ctx.command.make_parser(ctx).parse_args(sys.argv[1:])
    kept: list[str] = []
    for option in dict.fromkeys(order):
        if option.param_type_name == "option" and option.name in known:
            value = values[option.name]
            is_of_file = option.name == "reading" and len(paths) == 1
            kept += _as_given(option, _counting(value, paths[0]) if is_of_file else value)
    return _line([*([] if name == DEFAULT_COMMAND else [name]), *paths, *kept, *more])


def _counting(texts: Sequence[str], file: str) -> list[str]:
    """Return the options of readers that this mesh has: a plain check refuses others. A scene or a
    robot may place any mesh."""
    reader = mesh_reader(Path(file).suffix)
    named = None if reader is None else {option.spelling for option in reader.options}
    return [text for text in texts if named is None or text.partition("=")[0] in named]


def _as_given(option: click.Parameter, value: Any) -> list[str]:
    """Return the words of an option with the value that the parser has read."""
    if getattr(option, "is_flag", False):
        names = option.opts if value else option.secondary_opts
        return names[-1:]
    values = value if option.multiple else [value]
    words = [each if isinstance(each, tuple) else (each,) for each in values]
    return [word for each in words for word in (option.opts[-1], *map(str, each))]


def _about_folders(folders: Sequence[str], given: Sequence[str]) -> Iterator[Advice]:
    """Yield a line for all of them, as a line for one of several would fail at the next."""
    files = {folder: _all(Path(folder)) for folder in folders if _meshes(Path(folder))}
    own = {each: () for each in given if is_file(each) and Path(each).parent in map(Path, folders)}
    if folders and _is_check():
        is_expanded = len(folders) > 1 and len(given) > MOST_FILES  # a shell did so with `props/*`
        words = (_one_folder(given) if is_expanded else []) or _replaced(own)
        where = folders[0] if len(folders) == 1 else "the folders"
        yield Advice(f"to check each file in {where} by itself", _line(["batch", *words]))
    if folders and len(files) == len(folders) and (len(files) == 1 or not _is_check()):
        yield Advice(
            "to check the files in it against each other", _line(_replaced({**own, **files}))
        )


def _about_pattern(path: str) -> Iterator[Advice]:
    """Yield what a pattern means: a shell passes it on if it is quoted or matches nothing; on
    Windows always."""
    matches = _matches(path)
    if 0 < len(matches) <= MOST_FILES:
        purpose = f"to check the files of {path} against each other"
        yield Advice(purpose, _line(_replaced({path: matches})))
    if matches and _is_check():
        yield Advice("to check each of them by itself", _line(["batch", *sys.argv[1:]]))
    if not matches and _meshes(Path(path).parent):
        purpose = f"no file matches {path}. To check the files there"
        yield Advice(purpose, _line(_replaced({path: _all(Path(path).parent)})))


def _matches(pattern: str) -> list[str]:
    try:
        return asset_files([pattern]).files
    except SatcheckError:  # there is none
        return []


def _all(folder: Path) -> list[str]:
    """Return `parts/*.obj` for each ending of the meshes there, for the shell to expand."""
    inside = "" if folder == Path() else f"{_quoted(str(folder))}/"
    endings = sorted({file.suffix for file in _meshes(folder)})
    return [_Pattern(f"{inside}*{ending}") for ending in endings]


def _one_folder(paths: Sequence[str]) -> list[str]:
    """Return the folder that all paths lie in; nothing if there are several."""
    folders = {os.path.dirname(path) or "." for path in paths}  # noqa: PTH120  as it was given
    return [*folders] if len(folders) == 1 else []


def _nearest(path: str) -> str | None:
    """Return a file of the same folder with nearly the same name."""
    wanted = Path(path)
    if is_folder(path) or _PATTERN.intersection(path):
        return None
    names = {file.name.lower(): file.name for file in _listed(wanted.parent) if file.is_file()}
    same = (name for name in names if Path(name).stem == wanted.stem.lower())
    close = next(same, None) or _close(wanted.name.lower(), names, 0.75)
    return str(wanted.parent / names[close]) if close else None


def _close(word: str, known: Sequence[str] | Mapping[str, str], cutoff: float) -> str | None:
    return next(iter(get_close_matches(word, known, n=1, cutoff=cutoff)), None)


def _meshes(folder: Path) -> list[Path]:
    return [file for file in _listed(folder) if mesh_reader(file.suffix) is not None]


def _listed(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


def _is_check() -> bool:
    return sys.argv[1:2] != [] and not is_command(sys.argv[1])


def _replaced(others: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the words of this call with others in the place of some."""
    return [new for word in sys.argv[1:] for new in others.get(word, [word])]


def _line(words: Sequence[str]) -> str:
    return " ".join(
        ["satcheck", *(word if isinstance(word, _Pattern) else _quoted(word) for word in words)]
    )


def _quoted(word: str) -> str:
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)
