"""How a command refuses: click's exceptions, imported when the first one is raised."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import click


def wrong_usage(message: str) -> click.UsageError:
    """Of options that contradict each other or the input. To be raised."""
    import click

    return click.UsageError(message)


def failure(message: str) -> click.ClickException:
    """Of a command that cannot be done. To be raised."""
    import click

    return click.ClickException(message)
