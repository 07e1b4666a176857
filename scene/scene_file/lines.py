"""The lines of keys and entries in a text that `json` or `tomllib` accepts.

One scan of texts, brackets and keys: no value is read, and only the lines of wanted keys are kept.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any

Key = str | int
Keys = tuple[Key, ...]

_TEXT = r'"[^"\\\n]*+(?:\\.[^"\\\n]*+)*+"'
_MARK = r"""\[[^][{}"'#]*+\]|[][{},]"""  # a list of numbers is one token
_JSON = re.compile(rf"(?P<key>{_TEXT})\s*+:|{_TEXT}|{_MARK}")
_PART = rf"(?:[\w-]++|{_TEXT}|'[^'\n]*+')"
_NAME = rf"{_PART}(?:[ \t]*+\.[ \t]*+{_PART})*+"
_TOML = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+"{3,5}'
    rf"|'''(?:[^']|'(?!''))*+'{{3,5}}|#[^\n]*+"
    rf"|^[ \t]*+\[\[[ \t]*+(?P<item>{_NAME})[ \t]*+\]\]"
    rf"|^[ \t]*+\[[ \t]*+(?P<table>{_NAME})[ \t]*+\]"
    rf"|(?P<key>{_NAME})[ \t]*+=|{_TEXT}|'[^'\n]*+'|[\w.:+-]++|{_MARK}",
    re.MULTILINE | re.DOTALL,
)


def lines_of(text: str, wanted: Iterable[Keys], *, toml: bool) -> Mapping[Keys, int]:
    """The lines, from 1, of these keys and of all around them, as far as the text states them.

    Raises ValueError or IndexError for a text that is no such document.
    """
    around = {keys[:count] for keys in wanted for count in range(len(keys) + 1)}
    lines: dict[Keys, int] = {(): 1}
    line, counted = 1, 0
    for keys, at in _places(text, toml):
        if keys in around and not (toml and keys in lines):  # in JSON the last of equal keys counts
            line, counted = line + text.count("\n", counted, at), at
            lines[keys] = line
    return lines


def innermost(lines: Mapping[Keys, int], keys: Keys) -> int:
    """The line of the keys, or of the innermost table or list around them that has one."""
    return next(lines[keys[:n]] for n in range(len(keys), -1, -1) if keys[:n] in lines)


def repeated_keys(text: str) -> Iterator[Keys]:
    """The keys that occur twice in an object of a JSON text, without those in their values."""
    seen: set[Keys] = set()
    last: Keys | None = None
    for keys, _ in _places(text, toml=False):
        if keys in seen and (last is None or keys[: len(last)] != last):
            last = keys
            yield keys
        seen.add(keys)


def _places(text: str, toml: bool) -> Iterator[tuple[Keys, int]]:
    """(keys, offset) of each key, header, and table in a list, in the order of the text."""
    table: Keys = ()  # of the last header
    value: Keys = ()  # of the last key
    open_: list[Keys] = []  # the lists and tables around
    number: dict[Keys, int] = {}  # of the current item of a list
    for token in (_TOML if toml else _JSON).finditer(text):
        owner = open_[-1] if open_ else table
        kind, mark = token.lastgroup, token[0]
        if kind == "key":
            value = owner
            for name in _names(token["key"], toml):
                value = (*value, name)
                yield value, token.start()
        elif kind and not open_:  # within a list it is a list of one value, and no header
            table = ()
            for name in _names(token[kind], toml):
                table = (*table, number[table], name) if table in number else (*table, name)
                if table not in number:
                    yield table, token.start()
            if kind == "item":
                number[table] = number.get(table, -1) + 1
                table = (*table, number[table])
                yield table, token.start()
        elif mark in "[{":
            if owner in number:
                value = (*owner, number[owner])
                yield value, token.start()
            if mark == "[":
                number[value] = 0
            open_.append(value)
        elif mark == "," and owner in number:
            number[owner] += 1
        elif mark in "]}":
            number.pop(open_.pop(), None)


@lru_cache
def _names(key: str, toml: bool) -> Keys:
    """The parts of a dotted key."""
    names: list[str] = []
    value: Any = tomllib.loads(f"{key} = 0") if toml else {json.loads(key): 0}
    while isinstance(value, dict):
        ((name, value),) = value.items()
        names.append(name)
    return (*names,)
