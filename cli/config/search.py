"""The config file that counts in a folder. Every check looks for it, so this imports little."""

from __future__ import annotations

import re
from pathlib import Path

CONFIG = "satcheck.toml"
PROJECT = "pyproject.toml"
# What every usual spelling of [tool.satcheck] contains: other files are not parsed.
_MAY_HAVE_TABLE = re.compile(
    rb"""tool["'\s]*\.["'\s]*satcheck|^[ \t]*\[\s*["']?tool["']?\s*\]|^[ \t]*["']?tool["']?\s*=""",
    re.MULTILINE,
)


def nearest_config(folder: Path) -> Path | None:
    """In this folder or above it: the nearest satcheck.toml or pyproject.toml with [tool.satcheck].
    In one folder satcheck.toml comes first. Raises SatcheckError: `bad-config`."""
    for place in (folder, *folder.parents):
        if _is_there(place / CONFIG):
            return place / CONFIG
        if _is_there(place / PROJECT) and _has_table(place / PROJECT):
            return place / PROJECT
    return None


def _is_there(path: Path) -> bool:
    """A link that leads nowhere counts: its options are not passed over, reading it fails."""
    return path.is_file() or path.is_symlink()


def _has_table(path: Path) -> bool:
    from satcheck.cli.config.file import has_table, text_of

    text = text_of(path)
    return _MAY_HAVE_TABLE.search(text) is not None and has_table(path, text)
