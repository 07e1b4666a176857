"""Where the values of a TOML document are written. Only for text that `tomllib` has accepted."""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_right
from functools import cached_property

from satcheck.scene.format.positions import Key, Keys, Place

_BLANK = re.compile(r"(?:[ \t\r\n]+|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_STRING = re.compile(
    r'"""(?:[^"\\]|\\.|"{1,2}(?!"))*"{3,5}'
    r"|'''(?:[^']|'{1,2}(?!'))*'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'",
    re.DOTALL,
)
# Most of the lines of a large scene at one go: a bare key, and a value without any nesting.
_FLAT_LIST = re.compile(r"""\[[^][{}"'#\n]*\]""")
_LINE = re.compile(
    r"([A-Za-z0-9_-]+)[ \t]*=[ \t]*"
    rf"""("[^"\\\n]*"(?!")|{_FLAT_LIST.pattern}|[^][{{}}"'#\r\n]*[^][{{}}"'#\r\n \t])"""
    r"[ \t]*(?:#[^\n]*|\r?(?=\n)|\Z)"
)
_SCALAR = re.compile(r"[^,\]}#\r\n]*[^,\]}# \t\r\n]")


class TomlPositions:
    """One pass over the text finds all its values."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._elements: dict[Keys, int] = {}  # of each array of tables, how many there are so far

    @cached_property
    def _places(self) -> dict[Keys, Place]:
        return self._scan()

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(match.end() for match in re.finditer("\n", self._text))]

    def line(self, keys: Keys) -> int:
        while keys and keys not in self._places:
            keys = keys[:-1]
        at = self._places[keys].key if keys else 0
        return bisect_right(self._line_starts, at)

    def place(self, keys: Keys) -> Place:
        if keys not in self._places and keys[:-1] in self._places:
            self._items(self._places[keys[:-1]].start, keys[:-1], self._places)
        return self._places[keys]

    def _scan(self) -> dict[Keys, Place]:
        places: dict[Keys, Place] = {}
        text, table, at = self._text, (), self._blank(0)
        owner: Keys = table
        while at < len(text):
            line = _LINE.match(text, at)
            if line is not None:
                places[*owner, line[1]] = Place(at, *line.span(2))
                end = line.end()
            elif text[at] == "[":
                owner, end = self._header(at)
                for length in range(1, len(owner) + 1):  # [a.b] stands for [a], too
                    places.setdefault(owner[:length], Place(at, end, end))
            else:
                end = self._pair(at, owner, places)
            at = self._blank(end)
        return places

    def _header(self, at: int) -> tuple[Keys, int]:
        """(the table that `[a.b]` or `[[a.b]]` opens, the end of the header)."""
        brackets = 2 if self._text.startswith("[[", at) else 1
        names, end = self._dotted_key(at + brackets)
        keys: Keys = ()
        for name in names[:-1]:
            keys = self._element((*keys, name))
        keys = (*keys, names[-1])
        if brackets == 2:
            self._elements[keys] = self._elements.get(keys, 0) + 1
            keys = self._element(keys)
        return keys, end + brackets

    def _element(self, keys: Keys) -> Keys:
        """The last one, where these are the keys of an array of tables."""
        return (*keys, self._elements[keys] - 1) if keys in self._elements else keys

    def _pair(self, at: int, owner: Keys, places: dict[Keys, Place]) -> int:
        """`key = value`; returns its end."""
        names, end = self._dotted_key(at)
        keys: Keys = (*owner, *names)
        start = self._space(end + 1)
        end = self._value(start, keys, places)
        places[keys] = Place(at, start, end)
        return end

    def _value(self, at: int, keys: Keys, places: dict[Keys, Place]) -> int:
        text = self._text
        if text[at] == "{":
            at = self._blank(at + 1)
            while text[at] != "}":
                at = self._after_comma(self._pair(at, keys, places))
            return at + 1
        if text[at] == "[":
            flat = _FLAT_LIST.match(text, at)
            return self._items(at, keys, places) if flat is None else flat.end()
        match = _STRING.match(text, at) or _SCALAR.match(text, at)
        return at if match is None else match.end()

    def _items(self, at: int, keys: Keys, places: dict[Keys, Place]) -> int:
        """Those of a list. A list without any nesting waits until somebody asks for an item."""
        if not self._text.startswith("[", at):
            return at
        at, number = self._blank(at + 1), 0
        while self._text[at] != "]":
            end = self._value(at, (*keys, number), places)
            places[*keys, number] = Place(at, at, end)
            at, number = self._after_comma(end), number + 1
        return at + 1

    def _dotted_key(self, at: int) -> tuple[list[Key], int]:
        """(its parts, where the bracket or the equals sign after it stands)."""
        text = self._text
        names: list[Key] = []
        while True:
            at = self._space(at)
            match = _BARE_KEY.match(text, at)
            if match is not None:
                names.append(match[0])
            else:
                match = _STRING.match(text, at)
                if match is None:  # no TOML
                    return names, at
                names += tomllib.loads(f"{match[0]} = 0")
            at = self._space(match.end())
            if text[at] != ".":
                return names, at
            at += 1

    def _after_comma(self, at: int) -> int:
        at = self._blank(at)
        return self._blank(at + 1) if self._text[at] == "," else at

    def _blank(self, at: int) -> int:
        return _BLANK.match(self._text, at).end()  # type: ignore[union-attr]  # matches nothing too

    def _space(self, at: int) -> int:
        return _SPACE.match(self._text, at).end()  # type: ignore[union-attr]  # matches nothing too
