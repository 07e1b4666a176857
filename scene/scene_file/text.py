"""Reads a scene file, TOML by its suffix, else JSON, and finds what is wrong in it by its lines.

The lines of keys and entries take one scan of texts, brackets and keys: no value is read, and only
the lines of wanted keys are kept.
"""

from __future__ import annotations

import json
import math
import re
from codecs import BOM_UTF8
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, TypeVar

import tomli

from satcheck.core.errors import SatcheckError
from satcheck.scene.access import OWN_FILE, Most, StrPath
from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import MAX_DEPTH
from satcheck.scene.opening import read_whole, suffix_of
from satcheck.scene.table import Keys, Wrong
from satcheck.scene.words import quoted, why_unreadable

T = TypeVar("T")

MOST = 20  # errors told about one file
LONGEST_KEY = 80  # characters of a key in a message
_BARE_LENGTH = r"""^[^"'#]*=[\s\[]*([-+]?[\d._e+-]+\s?[a-zµ]+)\b"""
_TEXT = r'"[^"\\\n]*+(?:\\.[^"\\\n]*+)*+"'
_NUMBERS = r"""\[[^][{}"'#]*+\]"""
# A list of numbers is one token, and so is a matrix.
_MATRIX = rf"{_NUMBERS}|\[\s*+(?:{_NUMBERS}[\s,]*+)++\]"
_MARK = rf"{_MATRIX}|[][{{}},]"
# A table without tables and other lists in it.
_FLAT = rf"\{{(?:[^][{{}}\"]++|{_TEXT}|{_MATRIX})*+\}}"
_JSON = re.compile(rf"(?P<key>{_TEXT})\s*+:|{_TEXT}|{_MARK}")
_JSON_OUTER = re.compile(rf"(?P<key>{_TEXT})\s*+:|{_TEXT}|{_FLAT}|{_MARK}")
_PART = rf"(?:(?<![\w-])[\w-]++|{_TEXT}|'[^'\n]*+')"
_NAME = rf"{_PART}(?:[ \t]*+\.[ \t]*+{_PART})*+"
_LONG_KEY = re.compile(rf"(?:{_PART}[ \t]*+\.[ \t]*+){{{MAX_DEPTH}}}")
_TOML = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+"{3,5}'
    rf"|'''(?:[^']|'(?!''))*+'{{3,5}}|#[^\n]*+"
    rf"|^[ \t]*+\[\[[ \t]*+(?P<item>{_NAME})[ \t]*+\]\]"
    rf"|^[ \t]*+\[[ \t]*+(?P<table>{_NAME})[ \t]*+\]"
    rf"|(?P<key>{_NAME})[ \t]*+=|{_TEXT}|'[^'\n]*+'|[\w.:+-]++|{_MARK}",
    re.MULTILINE | re.DOTALL,
)


class SceneText:
    """A scene file that is well-formed, and what is wrong in it.

    path: as given. text: as it stands there. document: its values. Raises Refused.
    """

    def __init__(self, path: str, most: Most = OWN_FILE) -> None:
        self.path = path
        self.is_toml = is_toml(path)
        self.text = read_text(path, most)
        self._wrong: list[Wrong] = []
        if self.is_toml:
            self.document: Any = read_toml(path, self.text)
            return
        self.document, has_repeated_keys = _json(path, self.text)
        if has_repeated_keys:
            keys = repeated_keys(self.text)
            self._wrong = [Wrong("a second value for this key", *each) for each in keys]

    @property
    def is_right(self) -> bool:
        return not self._wrong

    def lines(self, wanted: Sequence[Keys]) -> list[int]:
        """The line of each of these keys, or of the innermost table or list around it."""
        if not wanted:
            return []
        lines = lines_of(self.text, wanted, toml=self.is_toml)
        return [innermost(lines, keys) for keys in wanted]

    def nulls(self) -> Iterator[Keys]:
        """The keys whose value is null, which is no value of a scene file."""
        waiting: list[tuple[Keys, Any]] = [((), self.document)] if "null" in self.text else []
        while waiting:
            keys, value = waiting.pop()
            if value is None:
                yield keys
            elif isinstance(value, dict):
                waiting += (((*keys, key), inner) for key, inner in value.items())
            elif isinstance(value, list):
                waiting += (((*keys, key), inner) for key, inner in enumerate(value))

    def keep(self, error: Wrong | SatcheckError, *around: str | int) -> None:
        """Keeps an error for `raise_any`. around: the path to where its own keys begin."""
        keys = error.keys if isinstance(error, Wrong) else ()
        self._wrong.append(Wrong(error.message, *around, *keys, code=error.code))

    @contextmanager
    def at(self, *keys: str | int) -> Iterator[None]:
        """Keeps the error that is raised within. keys: the path to what is read there."""
        try:
            yield
        except (Wrong, SatcheckError) as error:
            self.keep(error, *keys)

    def each(self, key: str, read: Callable[[Any, int], T]) -> list[T]:
        """What `read` makes of the tables in a list, with their numbers. An error in one does not
        hide those of others."""
        found: list[T] = []
        tables = self.document.get(key)
        for number, table in enumerate(tables if isinstance(tables, list) else ()):
            try:
                found.append(read(table, number))
            except (Wrong, SatcheckError) as error:
                self.keep(error, key, number)
        return found

    def raise_any(self) -> None:
        """Raises Refused if there are errors: the first in the file, with the rest as `others`."""
        if not self._wrong:
            return
        shown = self._wrong[:MOST]
        lines = self.lines([wrong.keys for wrong in shown])
        errors = [
            Refused(
                wrong.code,
                f"{dotted(wrong.keys)}: {wrong.message}" if wrong.keys else wrong.message,
                file=self.path,
                line=line,
            )
            for wrong, line in zip(shown, lines, strict=True)
        ]
        errors.sort(key=lambda error: error.line or 0)
        if left := len(self._wrong[MOST:]):
            errors.append(Refused("bad-scene", f"{left} more errors", file=self.path))
        first, *others = errors
        first.others = tuple(others)
        raise first


def dotted(keys: Keys) -> str:
    """`bodies[2].position`, counted from 0."""
    text = ""
    for key in keys:
        if isinstance(key, int):
            text += f"[{key}]"
        else:
            plain = key.replace("_", "").replace("-", "").isalnum() and len(key) <= LONGEST_KEY
            text += f".{key if plain else quoted(key, LONGEST_KEY)}"
    return text.removeprefix(".")


def is_toml(path: StrPath) -> bool:
    return suffix_of(path).lower() == ".toml"


def read_text(path: str, most: Most = OWN_FILE) -> str:
    """Raises Refused."""
    data = read_whole(path, most)
    try:
        return data.removeprefix(BOM_UTF8).decode()  # line ends as they are
    except UnicodeDecodeError:
        raise Refused("bad-encoding", "the scene file is not UTF-8", file=path) from None


def _parsed(text: str) -> dict[str, Any]:
    """Raises ValueError for text that is not TOML, and for a key of many parts: the parser takes
    time and memory by the square of their number."""
    dotted = [line for line in text.split("\n") if line.count(".") >= MAX_DEPTH]
    if any(map(_LONG_KEY.search, dotted)):
        raise ValueError(f"a key has more than {MAX_DEPTH} parts")
    return tomli.loads(text)


def read_toml(path: str, text: str) -> dict[str, Any]:
    """Raises Refused. path: for messages."""
    try:
        return _parsed(text)
    except tomli.TOMLDecodeError as error:
        line = min(error.lineno, len(text.splitlines()))
        message = f"not well-formed TOML: {error.msg}"
        if "\0" in text:
            message += ": it holds NUL bytes, where a part of it may be lost"
        if bare := re.search(_BARE_LENGTH, "".join(text.splitlines()[line - 1 : line])):
            message = f'a length with a unit stands in quotes: "{bare[1]}"'
        raise Refused("bad-scene", message, file=path, line=line) from None
    except (RecursionError, ValueError) as error:
        message = f"not readable TOML: {why_unreadable(error)}"
        raise Refused("bad-scene", message, file=path) from None


def _json(path: str, text: str) -> tuple[Any, bool]:
    """(the document, whether an object of it has a key twice)."""
    repeated = False

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        nonlocal repeated
        members = dict(pairs)
        repeated = repeated or len(members) < len(pairs)
        return members

    def refuse(_: str) -> float:
        return math.nan  # told later, with the name of the body

    try:
        document = json.loads(text, parse_constant=refuse, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        message = f"not well-formed JSON: {error.msg}"
        raise Refused("bad-scene", message, file=path, line=error.lineno) from None
    except (RecursionError, ValueError) as error:
        message = f"not readable JSON: {why_unreadable(error)}"
        raise Refused("bad-scene", message, file=path) from None
    return document, repeated


def lines_of(text: str, wanted: Iterable[Keys], *, toml: bool) -> Mapping[Keys, int]:
    """The lines, from 1, of these keys and of all around them, as far as the text states them.

    Raises ValueError or IndexError for a text of several lines that is no such document.
    """
    around = parents = set(wanted)
    while parents := {keys[:-1] for keys in parents if keys}:
        around |= parents
    if "\n" not in text:  # as programs write large scenes
        return dict.fromkeys(around, 1)
    outer = all(len(keys) < 2 or (len(keys) == 2 and isinstance(keys[1], int)) for keys in around)
    lines: dict[Keys, int] = {(): 1}
    line, counted = 1, 0
    for keys, at in _places(text, toml, outer=outer):
        if keys in around and not (toml and keys in lines):  # in JSON the last of equal keys counts
            line, counted = line + text.count("\n", counted, at), at
            lines[keys] = line
            if toml and len(lines) == len(around):
                break
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


def _places(text: str, toml: bool, *, outer: bool = False) -> Iterator[tuple[Keys, int]]:
    """(keys, offset) of each key, header, and table in a list, in the order of the text. outer: the
    outermost keys and the tables in their lists are enough."""
    table: Keys = ()  # of the last header
    value: Keys = ()  # of the last key
    open_: list[Keys] = []  # the lists and tables around
    number: dict[Keys, int] = {}  # of the current item of a list
    tokens, begin = _TOML if toml else _JSON, 0
    if outer and not toml:
        tokens, begin, open_ = _JSON_OUTER, text.index("{") + 1, [()]
    for token in tokens.finditer(text, begin):
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
        elif mark in "[{" or mark[0] == "{":
            if owner in number:
                value = (*owner, number[owner])
                yield value, token.start()
            if mark == "[":
                number[value] = 0
            if mark in "[{":
                open_.append(value)
        elif mark == "," and owner in number:
            number[owner] += 1
        elif mark in "]}":
            number.pop(open_.pop(), None)


@lru_cache
def _names(key: str, toml: bool) -> Keys:
    """The parts of a dotted key."""
    names: list[str] = []
    value: Any = tomli.loads(f"{key} = 0") if toml else {json.loads(key): 0}
    while isinstance(value, dict):
        ((name, value),) = value.items()
        names.append(name)
    return (*names,)
