"""The registry of sub-commands. Those of this package are a file each: `command` in the module of
its name is the click command. Plug-ins and other packages register theirs (`core/plugins.py`)."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, cast

from msgspec import Struct

from satcheck.core.plugins import function_at, others, own

if TYPE_CHECKING:
    import click

_WORD = re.compile(r"[a-z][a-z0-9-]*")  # what a name of a command looks like


class Plugin(Struct, frozen=True):
    """A sub-command of a plug-in. about: a line for the help. command: "module:name" of the click
    command."""

    name: str
    about: str
    command: str


DEFAULT_COMMAND = "check"  # its name is never typed
# What each does, for the help of satcheck: that must not import them all. The first sentence of the
# help of each command says the same.
COMMANDS = {
    "axes": "Show why two convex bodies are apart, axis by axis.",
    "baseline": "Known findings that do not fail a check.",
    "batch": "Check each asset of a folder, and thousands of them.",
    "colliders": "Show how faithful the colliders of links are to what is drawn.",
    "config": "The config file: show which options are in effect.",
    "decompose": "Split meshes into convex parts, for physics engines.",
    "resolve": "Move the bodies of a scene apart, by short ways.",
    "schema": "Print the JSON Schema of a kind of document.",
    "suggest": "Suggest which pairs a scene may allow to overlap.",
    "tradeoff": "Show what accuracy costs in time, on one pair.",
    "verify": "Re-check the certificates of a report.",
    "view": "Show a stored report in 3-D, or in any other format.",
}


@cache
def _plugins() -> dict[str, Plugin]:
    return {plugin.name: plugin for plugin in own("commands")}


def is_command(word: str) -> bool:
    """Return whether a word is the name of a command."""
    return word in COMMANDS or _plugin(word) is not None


def command_named(name: str) -> click.Command | None:
    """Return the click command of this name, also the default one; None: there is none."""
    if name in (DEFAULT_COMMAND, *COMMANDS):
        return cast("click.Command", function_at(f"{__name__}.{name}:command"))
    plugin = _plugin(name)
    return None if plugin is None else cast("click.Command", function_at(plugin.command))


def all_commands() -> dict[str, str]:
    """Return what each command does, by name."""
    plugins = (*_plugins().values(), *others("commands", (Plugin,)))
    return {**{plugin.name: plugin.about for plugin in plugins}, **COMMANDS}


def _plugin(word: str) -> Plugin | None:
    """Other packages are asked last, and only for a word that may be a name."""
    found = _plugins().get(word)
    if found is None and _WORD.fullmatch(word):
        found = next((each for each in others("commands", (Plugin,)) if each.name == word), None)
    return found
