"""A config file as a table of values, each with its line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct

from satcheck.cli.config.search import PROJECT
from satcheck.core.errors import SatcheckError

MOST_BYTES = 1 << 20
_TABLE = ("tool", "satcheck")


class ConfigFile(Struct, frozen=True):
    """path: relative to the current folder if it lies in it or above it. keys: to the table."""

    path: str
    text: str
    keys: tuple[str, ...]
    values: Mapping[str, Any]

    @property
    def folder(self) -> Path:
        return Path(self.path).parent

    def where(self, key: str) -> str:
        """`satcheck.toml:3`."""
        from satcheck.scene.format.lines import innermost, lines_of

        keys = (*self.keys, key)
        return f"{self.path}:{innermost(lines_of(self.text, [keys], toml=True), keys)}"

    def refused(self, key: str, reason: str) -> SatcheckError:
        """To be raised."""
        return bad_config(f"{self.where(key)}: {key}: {reason}")


def read_config(path: Path) -> ConfigFile:
    """Raises SatcheckError: `bad-config`."""
    data = text_of(path)
    document = _parsed(path, data)
    keys = _TABLE if path.name == PROJECT else ()
    table: Any = document
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    if not isinstance(table, dict):
        raise bad_config(f"{path}: there is no table [tool.satcheck]")
    return ConfigFile(path.as_posix(), data.decode(), keys, table)


def has_table(path: Path, data: bytes) -> bool:
    """Return whether it has [tool.satcheck]. Raises as `read_config`."""
    tools = _parsed(path, data).get("tool")
    return isinstance(tools, dict) and "satcheck" in tools


def text_of(path: Path) -> bytes:
    """Raises as `read_config`."""
    from satcheck.scene.opening import read_whole

    try:
        return read_whole(str(path), path, MOST_BYTES)
    except SatcheckError as error:
        raise bad_config(str(error)) from None


def bad_config(message: str) -> SatcheckError:
    """To be raised."""
    return SatcheckError("bad-config", f"{message} (--no-config ignores config files)")


def _parsed(path: Path, data: bytes) -> dict[str, Any]:
    from satcheck.scene.format.text import parse_toml
    from satcheck.scene.words import why_unreadable

    try:
        return parse_toml(data.decode())
    except (ValueError, RecursionError) as error:
        raise bad_config(f"{path}: not readable TOML: {why_unreadable(error)}") from None
