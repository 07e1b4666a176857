"""Finds plug-ins: the packages in satcheck/plugins, and entry points of other packages.

Both register in the same way. A package in satcheck/plugins has modules `readers`, `formats` or
`commands` with a tuple `READERS`, `FORMATS` or `COMMANDS`; another package names each object of
such a tuple by an entry point of the group `satcheck.readers`, `satcheck.formats` or
`satcheck.commands`.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal, get_args

from msgspec import Struct, convert
from msgspec.structs import asdict

_PACKAGE = "satcheck.plugins"
Group = Literal["readers", "formats", "commands"]


class Failure(Struct, frozen=True):
    """An entry point that cannot be loaded."""

    name: str
    reason: str


def own(group: Group) -> Iterator[Any]:
    """What the plug-ins of this package register. None of them imports its library for that."""
    for name in _having(group):
        yield from getattr(import_module(f"{_PACKAGE}.{name}.{group}"), group.upper())


def others(group: Group, kinds: tuple[type[Any], ...]) -> tuple[Any, ...]:
    """Return what other packages register, objects of these kinds. One that fails is left out, and
    `failures` names it."""
    return tuple(found for found in _others(group, kinds) if not isinstance(found, Failure))


def failures(group: Group, kinds: tuple[type[Any], ...]) -> str:
    """Return a text to be put after an error about an unknown name: which plug-ins have failed."""
    failed = [found for found in _others(group, kinds) if isinstance(found, Failure)]
    return "".join(f"; the plug-in {each.name} cannot be loaded: {each.reason}" for each in failed)


@cache
def function_at(place: str) -> Any:
    """The function at "module:name"."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


@cache
def versions() -> tuple[str, ...]:
    """Return what answers depend on beside satcheck: the installed packages that it names, with
    their versions, and those that register plug-ins. Of these the modules count too, by size and
    time: who writes a plug-in changes it more often than its version."""
    packages = _packages()
    about = _stated(packages["satcheck"], "METADATA") if "satcheck" in packages else ""
    needs = re.findall(r"^Requires-Dist: *([\w.-]+)", about, re.MULTILINE)
    found = {_called(packages[name]) for name in map(_spelt, needs) if name in packages}
    if any("[satcheck." in _stated(each, "entry_points.txt") for each in packages.values()):
        from importlib.metadata import entry_points

        points = entry_points()
        for group in get_args(Group):
            for point in points.select(group=f"satcheck.{group}"):
                version = point.dist and point.dist.version
                found.add(f"{point.value} {version} {_state(point.module)}")
    return tuple(sorted(found))


def _packages() -> dict[str, Path]:
    """Return the folders that state what is installed, by the names of the packages. Each process
    of a batch asks for them, and importlib.metadata takes a third of its start."""
    found: dict[str, Path] = {}
    for folder in sys.path:
        with suppress(OSError):
            for name in os.listdir(folder or os.curdir):  # noqa: PTH208  Path takes longer
                if name.endswith((".dist-info", ".egg-info")):
                    found.setdefault(_spelt(Path(name).stem.partition("-")[0]), Path(folder, name))
    return found


def _called(folder: Path) -> str:
    """Return the name and the version; the folder beside a working tree is called by the name."""
    if "-" in folder.stem:
        return folder.stem
    version = re.search(r"^Version: *(\S+)", _stated(folder, "PKG-INFO"), re.MULTILINE)
    return f"{folder.stem}-{version[1] if version else ''}"


def _spelt(name: str) -> str:
    return re.sub(r"[-_.]+", "_", name).lower()


def _stated(folder: Path, file: str) -> str:
    """Return what a file of such a folder says; "": nothing."""
    with suppress(OSError):
        return (folder / file).read_text(encoding="utf-8", errors="replace")
    return ""


def _state(module: str) -> str:
    """Return the names, sizes and times of the modules of the package that this one is in."""
    with suppress(ImportError, OSError, ValueError):  # it is said where it is loaded
        spec = find_spec(module.partition(".")[0])
        folders = [] if spec is None else spec.submodule_search_locations or []
        files = [file for folder in folders for file in sorted(Path(folder).rglob("*.py"))]
        if not files and spec is not None and spec.origin is not None:
            files = [Path(spec.origin)]
        states = ((file, file.stat()) for file in files)
        return " ".join(f"{file} {each.st_size} {each.st_mtime_ns}" for file, each in states)
    return ""


@cache
def _having(group: Group) -> tuple[str, ...]:
    """The names of the plug-ins of this package that have a module of this name."""
    try:
        package = import_module(_PACKAGE)
    except ModuleNotFoundError:
        return ()  # they are taken away
    places = (Path(folder).glob(f"*/{group}.py") for folder in package.__path__)
    return tuple(sorted(place.parent.name for found in places for place in found))


@cache
def _others(group: Group, kinds: tuple[type[Any], ...]) -> tuple[Any, ...]:
    from importlib.metadata import entry_points  # takes as long as a small check

    return tuple(_loaded(point, kinds) for point in entry_points(group=f"satcheck.{group}"))


def _loaded(point: Any, kinds: tuple[type[Any], ...]) -> Any:
    try:
        found = point.load()
        if not isinstance(found, kinds):
            raise TypeError(f"{type(found).__name__} is not what registers there")
        if isinstance(found, Struct):
            convert(asdict(found), type(found))  # the types of its fields
        return found
    except Exception as error:  # noqa: BLE001  a package of others: anything may happen
        return Failure(point.value, f"{type(error).__name__}: {error}")
