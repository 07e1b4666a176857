"""The options that a config file may set, and values of a file as a command line would give them.

A key is the long name of an option without its dashes. A flag is true or false. An option that may
be repeated takes a list.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

# About one call, not about a check.
_NOT_HERE = frozenset(("help", "version", "debug", "config", "no_config"))
# Of a pose that is given as text, not as a file.
_OPENING = ("{", "[")


def configurable(command: click.Command) -> dict[str, click.Option]:
    """Key -> option."""
    return {
        key_of(option): option
        for option in command.params
        if isinstance(option, click.Option) and option.name not in _NOT_HERE
    }


def key_of(option: click.Option) -> str:
    return max(option.opts, key=len).lstrip("-")


def is_inverted(option: click.Option) -> bool:
    """A flag that turns something off: --no-cache."""
    return option.flag_value is False


def value_of(option: click.Option, raw: Any, folder: Path) -> Any:
    """What click makes the value of, with paths from `folder` on; None: the default stays. Raises
    ValueError for a value of a wrong kind."""
    if option.is_flag:
        if not isinstance(raw, bool):
            raise ValueError("true or false expected")
        if is_inverted(option):
            return False if raw else None
        return raw
    if option.multiple:
        items = raw if isinstance(raw, list) else [raw]
        return tuple(_text(option, item, folder) for item in items)
    return _text(option, raw, folder)


def number_expected(option: click.Option) -> str | None:
    """`must be a whole number, at least 0`; None: not of a number in a range."""
    kind = option.type
    if not isinstance(kind, click.IntRange | click.FloatRange):
        return None
    words = ["must be a whole number" if isinstance(kind, click.IntRange) else "must be a number"]
    if kind.min is not None:
        words.append(f"{'more than' if kind.min_open else 'at least'} {kind.min}")
    if kind.max is not None:
        words.append(f"{'less than' if kind.max_open else 'at most'} {kind.max}")
    return ", ".join(words)


def _text(option: click.Option, raw: Any, folder: Path) -> str:
    if isinstance(raw, bool) or not isinstance(raw, str | int | float):
        raise ValueError("a text or a number expected")
    text = str(raw)
    if option.name == "packages":
        name, equals, place = text.partition("=")
        return f"{name}={folder / place}" if equals and place else text
    is_path = isinstance(option.type, click.Path) and text != "-"
    if is_path or (option.name == "pose" and not text.lstrip().startswith(_OPENING)):
        return str(folder / text)
    return text
