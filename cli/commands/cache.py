"""`satcheck cache info|clear`."""

from __future__ import annotations

import click

from satcheck.cli.click_classes import HELP_NAMES, Group
from satcheck.cli.formats.words import counted
from satcheck.cli.output import Document
from satcheck.decompose import Cache


@click.group("cache", cls=Group, context_settings=HELP_NAMES)
def command() -> None:
    """The cache of convex parts: info, clear.

    --accuracy parts, decompose and tradeoff make such parts. The cache is in the user's cache
    folder, or in the folder that SATCHECK_CACHE_DIR names.
    """


@command.command()
def info() -> None:
    """Show where the cache is and how much it holds."""
    content = Cache().info()
    entries = counted(content.entries, "entry", "entries")
    Document().write(f"{content.path}\n{entries}, {_size(content.bytes)}\n")


@command.command()
def clear() -> None:
    """Delete everything in the cache."""
    Document().write(f"deleted {counted(Cache().clear(), 'entry', 'entries')}\n")


def _size(count: int) -> str:
    size = float(count)
    for unit in ("bytes", "KiB", "MiB"):
        if size < 1024:
            return f"{size:.4g} {unit}"
        size /= 1024
    return f"{size:.4g} GiB"
