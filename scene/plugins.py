"""Finds plug-ins: the packages in satcheck/plugins, and entry points of other packages.

Both register in the same way. A package in satcheck/plugins has modules `readers`, `formats` or
`commands` with a tuple `READERS`, `FORMATS` or `COMMANDS`; another package names each object of
such a tuple by an entry point of the group `satcheck.readers`, `satcheck.formats` or
`satcheck.commands`.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

from satcheck.core.errors import SatcheckError

_PACKAGE = "satcheck.plugins"
Group = Literal["readers", "formats", "commands"]


def own(group: Group) -> Iterator[Any]:
    """What the plug-ins of this package register. None of them imports its library for that."""
    for name in _having(group):
        yield from getattr(import_module(f"{_PACKAGE}.{name}.{group}"), group.upper())


@cache
def others(group: Group) -> tuple[Any, ...]:
    """What other packages register. Raises SatcheckError `bad-plugin`."""
    from importlib.metadata import entry_points  # takes as long as a small check

    return tuple(_loaded(point) for point in entry_points(group=f"satcheck.{group}"))


def function_at(place: str) -> Any:
    """The function at "module:name"."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


@cache
def _having(group: Group) -> tuple[str, ...]:
    """The names of the plug-ins of this package that have a module of this name."""
    try:
        package = import_module(_PACKAGE)
    except ModuleNotFoundError:
        return ()  # they are taken away
    places = (Path(folder).glob(f"*/{group}.py") for folder in package.__path__)
    return tuple(sorted(place.parent.name for found in places for place in found))


def _loaded(point: Any) -> Any:
    try:
        return point.load()
    except Exception as error:
        message = f"the plug-in {point.value} cannot be loaded: {type(error).__name__}: {error}"
        raise SatcheckError("bad-plugin", message) from error
