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
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from satcheck.cli.commands import COMMANDS, is_command
from satcheck.core.errors import SatcheckError
from satcheck.scene.asset_files import asset_files
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.readers import mesh_reader, options
from satcheck.scene.loader import is_mesh
from satcheck.scene.opening import exists, is_file, is_folder
from satcheck.scene.units import MICROMETRES

if TYPE_CHECKING:
    import click

    from satcheck.scene import Scene
    from satcheck.scene.bodies import Body

# From so many mesh files on they may be assets, and not parts.
FEWEST_ASSETS = 4
# More files than this make no line that anybody copies.
MOST_FILES = 8
# So many bad paths get advice; the others are errors alone.
MOST_PATHS = 3
_PATTERN = frozenset("*?[")
_STORED = re.compile(rb'\s*{\s*"schema": ?"satcheck\.(report|assets|samples|result)/')
# Options about the document, not about the answer, and about many assets.
_DELIVERY = frozenset(
    (
        *("form", "outputs", "quiet", "top", "color", "exit_zero", "limit"),
        *("resume", "shard", "manifest", "since", "exclude"),
    )
)
# What other programs call our options: a name without dashes, and what it is here.
_ALIASES: Mapping[str, tuple[str, ...]] = {
    "html": ("-o", "report.html"),
    "verbose": ("--explain",),
    "v": ("--explain",),
    "threads": ("--jobs",),
    "distance": ("--clearance",),
    "out": ("-o",),
    "output-format": ("--format",),
    **dict.fromkeys(("picture", "image"), ("-o", "picture.png")),
    **dict.fromkeys(
        ("interference", "max-interference", "max-overlap", "overlap"), ("--max-thickness",)
    ),
}
# Options of other programs before the name of a file to write, beside the names of our formats.
_WRITERS = frozenset(("picture", "image", "save", "report"))


# Words of other programs, and of earlier versions, for a command.
_GONE = {"each": "batch", "report": "view"}


class Advice(NamedTuple):
    """What a command is for, and the command."""

    purpose: str
    command: str

    def __str__(self) -> str:
        return f"satcheck: {self.purpose}:\n  {self.command}"


class _Pattern(str):
    """A word that the shell has to expand: it is not quoted."""


def about_first_word(word: str) -> Advice | None:
    """Of a word that is no file: `check` and `help` are words of other programs."""
    words = sys.argv[1:]
    if exists(word) or word not in words:
        return None
    rest = [each for each in words if each != word]
    if word == "check":
        return Advice("a check has no name: leave out the word check", _line(rest))
    if word in _GONE:
        return Advice("did you mean", _line([_GONE[word], *rest]))
    if word == "help":
        named = [each for each in rest if each in COMMANDS][:1]
        return Advice("this shows the help", _line([*named, "--help"]))
    return None


def about_option(error: click.NoSuchOption) -> Advice | None:
    """Of an option that the command does not have."""
    words, wrong = sys.argv[1:], error.option_name
    known = [] if error.ctx is None else _options(error.ctx.command)
    place = next((k for k, word in enumerate(words) if word.partition("=")[0] == wrong), None)
    if place is None:
        return None
    _, equals, value = words[place].partition("=")
    if (
        words[0] == "baseline"
        and wrong in ("-o", "--output")
        and (file := words[place + 1 : place + 2])
    ):
        rest = [*words[2:place], *words[place + 2 :]]
        return Advice("the baseline comes before the reports", _line([*words[:2], *file, *rest]))
    name = wrong.lstrip("-")
    if "--read" in known and (option := options().get(name.replace("-", "_"))) is not None:
        after = words[place + 1 :]
        if option[0].type is bool and not equals:
            value = "true"
        elif not equals:
            value, after = "".join(after[:1]), after[1:]
        return Advice("did you mean", _line([*words[:place], "--read", f"{name}={value}", *after]))
    following = value if equals else "".join(words[place + 1 : place + 2])
    right = _meant(name, following, known)
    if right is None:
        return None
    words[place : place + 1] = [*right, *([value] if equals else [])]
    return Advice("did you mean", _line(words))


def about_paths(paths: Sequence[str]) -> list[Advice]:
    """Of a misspelt command, folders, patterns, and files that do not exist or are given twice."""
    if command := _about_command(paths[0]):
        return [command]
    bad = [path for path in paths if not is_file(path)]
    if split := _split_length(bad):
        return [split]
    near = {path: [other] for path in bad if (other := _nearest(path)) is not None}
    advice = [Advice("did you mean", _replacing(near))] if near else []
    folders = list(filter(is_folder, bad))
    if len(folders) > 1:
        advice += _about_folders(folders, paths)
        bad = [path for path in bad if path not in folders]
    advice += [each for path in bad[:MOST_PATHS] for each in _about_path(path)]
    files = Counter(os.path.realpath(path) for path in paths if is_file(path))
    twice = next((path for path in paths if files[os.path.realpath(path)] > 1), None)
    if twice is not None and mesh_reader(Path(twice).suffix) is not None:
        pieces = _line(["--split", "components", twice])
        purpose = f"{twice} is given twice, so its bodies coincide. To check its pieces"
        advice.append(Advice(purpose, pieces))
    return advice


def about_stored(paths: Sequence[str]) -> Advice | None:
    """Of a stored report among the inputs."""
    for path in filter(is_file, paths):
        with Path(path).open("rb") as file:
            if _STORED.match(file.read(100)):
                return Advice(f"{path} is a stored report. To show it", _line(["view", path]))
    return None


def _split_length(bad: Sequence[str]) -> Advice | None:
    """Of a length with a space before its unit: `--clearance 2 mm`."""
    words = sys.argv[1:]
    for k, (value, unit) in enumerate(pairwise(words)):
        if unit in bad and unit.lower() in MICROMETRES and _is_number(value.rpartition("=")[2]):
            joined = [*words[:k], f"{value}{unit}", *words[k + 2 :]]
            return Advice("a length has no space", _line(joined))
    return None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def about_assets(paths: Sequence[str], scene: Scene) -> list[Advice]:
    """Of mesh files most of which hold the origin, as files of assets do. Parts of one assembly
    stand beside each other."""
    if len(paths) < FEWEST_ASSETS or not all(map(is_mesh, paths)):
        return []
    around: dict[str, bool] = {}
    for body in scene.bodies:
        around[body.file.path] = around.get(body.file.path, False) or _holds_origin(body)
    if 2 * sum(around.values()) <= len(around):
        return []
    folders = {os.path.dirname(path) or "." for path in paths}  # noqa: PTH120  as it was given
    purpose = f"{sum(around.values()):,} of {len(around):,} files lie around the origin. "
    files = [*folders] if len(folders) == 1 else sys.argv[1:]
    return [Advice(f"{purpose}If each file is an asset of its own", _line(["batch", *files]))]


def _holds_origin(body: Body) -> bool:
    """Return whether the box of the body holds the origin, or misses it by a tenth of its size, as
    that of a thing that stands on the ground may."""
    low, high = body.file.mesh.bounds
    placed = body.transform or IDENTITY
    rows = [placed[at : at + 4] for at in (0, 4, 8)]
    middle = [*((a + b) / 2 for a, b in zip(low, high, strict=True)), 1.0]
    half = [(b - a) / 2 for a, b in zip(low, high, strict=True)]
    centre = [sum(map(mul, row, middle)) for row in rows]
    reach = [
        sum(abs(factor) * size for factor, size in zip(row, half, strict=False)) for row in rows
    ]
    return all(abs(c) <= r + max(reach) / 5 for c, r in zip(centre, reach, strict=True))


def about_one_body(path: str, components: int) -> list[Advice]:
    """Of a mesh file that is alone. components: connected, of its mesh."""
    advice = [Advice(f"to check the mesh of {path} alone", _line(["batch", path]))]
    if other := _sibling(path):
        advice.append(Advice("to check it against another mesh", _line([*sys.argv[1:], other])))
    if components > 1:
        words = [*sys.argv[1:], "--split", "components"]  # the last one counts
        advice.append(Advice("to check its connected pieces", _line(words)))
    return advice


def _about_command(word: str) -> Advice | None:
    """Of the first word, which is a path unless it names a command."""
    if not _is_check() or "." in word or exists(word) or _nearest(word) is not None:
        return None
    near = get_close_matches(word, [*COMMANDS, "check"], n=1)
    rest = [each for each in sys.argv[1:] if each != word]
    if near == ["check"]:
        return Advice("a check has no name: leave out the word", _line(rest))
    return Advice(f"did you mean the command {near[0]}", _line([*near, *rest])) if near else None


def check_of(file: str, ctx: click.Context) -> str:
    """A plain check of a file, with the options of this call that change its answer."""
    words = sys.argv[1:]
    values, _, order = ctx.command.make_parser(ctx).parse_args(words)
    kept: list[str] = []
    for option in dict.fromkeys(order):
        if option.param_type_name == "option" and option.name not in _DELIVERY:
            value = values[option.name]
            kept += _as_given(option, _counting(value, file) if option.name == "read" else value)
    return _line([file, *kept])


def _counting(texts: Sequence[str], file: str) -> list[str]:
    """Of the options of readers, those that this mesh has: a plain check refuses others. A scene or
    a robot may place any mesh."""
    reader = mesh_reader(Path(file).suffix)
    if reader is None:
        return list(texts)
    named = {option.name for option in reader.options}
    return [text for text in texts if text.partition("=")[0].replace("-", "_") in named]


def _as_given(option: click.Parameter, value: Any) -> list[str]:
    """The words of an option with the value that the parser has read."""
    if getattr(option, "is_flag", False):
        names = option.opts if value else option.secondary_opts
        return names[-1:]
    values = value if option.multiple else [value]
    return [word for each in values for word in (option.opts[-1], str(each))]


def _about_path(path: str) -> Iterator[Advice]:
    if is_folder(path):
        yield from _about_folder(path)
    elif _PATTERN.intersection(path):
        yield from _about_pattern(path)


def _about_folder(path: str) -> Iterator[Advice]:
    if _is_check():
        purpose = f"to check each file in {path} by itself"
        yield Advice(purpose, _line(["batch", *sys.argv[1:]]))
    endings = Counter(file.suffix for file in _meshes(Path(path)))
    for ending, count in endings.most_common(1):
        purpose = f"to check its {count} {ending} files against each other"
        if count > 1:
            yield Advice(purpose, _replacing({path: [_all(Path(path), ending)]}))


def _about_folders(paths: Sequence[str], given: Sequence[str]) -> Iterator[Advice]:
    """Of several: a line for all of them, as a line for one of them would fail at the next."""
    if _is_check():
        around = {os.path.dirname(path) or "." for path in given}  # noqa: PTH120  as it was given
        is_expanded = len(around) == 1 and len(given) > MOST_FILES  # a shell did so with `props/*`
        words = [*around] if is_expanded else sys.argv[1:]
        yield Advice("to check each file in the folders by itself", _line(["batch", *words]))
        return
    endings = {path: Counter(file.suffix for file in _meshes(Path(path))) for path in paths}
    if all(endings.values()):
        files = {path: [_all(Path(path), max(e, key=e.__getitem__))] for path, e in endings.items()}
        yield Advice("to name the files in the folders", _replacing(files))


def _about_pattern(path: str) -> Iterator[Advice]:
    """A shell passes a pattern on if it is quoted or matches nothing; on Windows always."""
    matches = _matches(path)
    if matches and len(matches) <= MOST_FILES:
        purpose = f"to check the files of {path} against each other"
        yield Advice(purpose, _replacing({path: matches}))
    if matches and _is_check():
        yield Advice("to check each of them by itself", _line(["batch", *sys.argv[1:]]))
    if not matches:
        folder = Path(path).parent
        endings = Counter(file.suffix for file in _meshes(folder))
        for ending, count in endings.most_common(1):
            purpose = f"no file matches {path}. To check the {count} {ending} files there"
            yield Advice(purpose, _replacing({path: [_all(folder, ending)]}))


def _matches(pattern: str) -> list[str]:
    try:
        return asset_files([pattern]).files
    except SatcheckError:  # there is none
        return []


def _all(folder: Path, ending: str) -> _Pattern:
    """`parts/*.obj`, for the shell to expand."""
    inside = "" if folder == Path() else f"{_quoted(str(folder))}/"
    return _Pattern(f"{inside}*{ending}")


def _nearest(path: str) -> str | None:
    """A file of the same folder with nearly the same name."""
    wanted = Path(path)
    if is_folder(path) or _PATTERN.intersection(path):
        return None
    names = {file.name.lower(): file.name for file in _listed(wanted.parent) if file.is_file()}
    same = [name for name in names if Path(name).stem == wanted.stem.lower()]
    close = same or get_close_matches(wanted.name.lower(), names, n=1, cutoff=0.75)
    return str(wanted.parent / names[close[0]]) if close else None


def _sibling(path: str) -> str | None:
    """Another mesh of the same folder."""
    others = sorted(str(file) for file in _meshes(Path(path).parent))
    return next(
        (other for other in others if os.path.realpath(other) != os.path.realpath(path)), None
    )


def _meshes(folder: Path) -> list[Path]:
    return [file for file in _listed(folder) if mesh_reader(file.suffix) is not None]


def _listed(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


def _meant(wrong: str, following: str, known: Sequence[str]) -> tuple[str, ...] | None:
    """following: the word after it, or its value."""
    from satcheck.cli.formats.registry import ALL, REPORTS, formats

    ending = Path(following).suffix.removeprefix(".")
    if ending in formats(ALL) and wrong in {*_WRITERS, ending} and "-o" in known:
        return ("-o",)
    if wrong in formats(REPORTS) and "--format" in known:
        return ("--format", wrong)
    alias = _ALIASES.get(wrong)
    if alias is not None and alias[0] in known:
        return alias
    near = get_close_matches(f"--{wrong}", known, n=1, cutoff=0.75)
    return tuple(near) if near else None


def _options(command: click.Command) -> list[str]:
    return [name for option in command.params for name in (*option.opts, *option.secondary_opts)]


def _is_check() -> bool:
    return sys.argv[1:2] != [] and not is_command(sys.argv[1])


def _replacing(others: Mapping[str, Sequence[str]]) -> str:
    """This call with other words in the place of some."""
    return _line([new for word in sys.argv[1:] for new in others.get(word, [word])])


def _line(words: Sequence[str]) -> str:
    return " ".join(
        ["satcheck", *(word if isinstance(word, _Pattern) else _quoted(word) for word in words)]
    )


def _quoted(word: str) -> str:
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)
