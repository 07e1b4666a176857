"""The lines of the items of a list in a JSON text.

A scene can have a million bodies. `positions` would build the syntax tree of all of them, which
takes six times the memory of the text. Here one item at a time is decoded and dropped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from json import JSONDecoder

_SPACE = re.compile(r"[ \t\n\r]*")
_DECODER = JSONDecoder()


def item_lines(text: str, key: str) -> Iterator[int]:
    """The line, from 1, of each item of the list at `key` of the outermost object. Raises
    ValueError or IndexError if the text has no such list, or breaks off."""
    line, counted = 1, 0
    for start in _item_starts(text, _list_start(text, key)):
        line += text.count("\n", counted, start)
        counted = start
        yield line


def _list_start(text: str, key: str) -> int:
    """The offset of the value of the key."""
    at = _after_space(text, 0)
    while text[at] in "{,":
        name, at = _DECODER.raw_decode(text, _after_space(text, at + 1))
        at = _after_space(text, _after_space(text, at) + 1)
        if name == key:
            return at
        at = _end(text, at)
    raise ValueError(f"no key {key!r}")


def _item_starts(text: str, at: int) -> Iterator[int]:
    """at: offset of the list."""
    at = _after_space(text, at + 1)
    while text[at] != "]":
        yield at
        at = _end(text, at)
        if text[at] == ",":
            at = _after_space(text, at + 1)


def _end(text: str, at: int) -> int:
    """The offset after the value at this offset, and after the space that follows it."""
    return _after_space(text, _DECODER.raw_decode(text, at)[1])


def _after_space(text: str, at: int) -> int:
    match = _SPACE.match(text, at)
    assert match is not None
    return match.end()
