"""Names of files from standard input."""

from __future__ import annotations

import os
import sys

import click


def standard_input() -> list[str]:
    """A name for each line, or with a NUL behind each. click.UsageError if it is closed."""
    if sys.stdin is None:
        raise click.UsageError("standard input is closed: give a folder or files")
    text = os.fsdecode(sys.stdin.buffer.read()).replace(os.linesep, "\n")
    return text.split("\0" if "\0" in text else "\n")
