"""`satcheck cache info|clear`."""

from __future__ import annotations

import click

from satcheck.cli.commands.options import HELP_NAMES, Group


@click.group("cache", cls=Group, context_settings=HELP_NAMES)
def command() -> None:
    """The cache of convex parts: info, clear.

    Only --accuracy parts makes such parts. The cache lies in the user's cache folder, or where
    SATCHECK_CACHE_DIR says.
    """


@command.command()
def info() -> None:
    """Show where the cache is and how much it holds."""
    from satcheck.cli.caching import describe
    from satcheck.cli.output import Document

    Document().write(f"{describe()}\n")


@command.command()
def clear() -> None:
    """Delete everything in the cache."""
    from satcheck.cli.caching import clear as clear_cache
    from satcheck.cli.output import Document

    Document().write(f"{clear_cache()}\n")
