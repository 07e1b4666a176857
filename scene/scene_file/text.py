"""Reads and parses a scene file: TOML if its suffix says so, else JSON."""

from __future__ import annotations

import json
import math
import re
import tomllib
from codecs import BOM_UTF8
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from msgspec import Struct

from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import MAX_DEPTH
from satcheck.scene.opening import read_whole
from satcheck.scene.scene_file.lines import Keys, innermost, lines_of
from satcheck.scene.words import why_unreadable

TOML_SUFFIX = ".toml"

_MAX_BYTES = 512 << 20  # a million bodies, each with a matrix
_TOML_PLACE = r"(?s)(.*) \(at (?:line (\d+), column \d+|end of document)\)"


_PART = r"""(?:(?<![\w-])[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?:{_PART}[ \t]*+\.[ \t]*+){{{MAX_DEPTH}}}")


class Parsed(Struct, frozen=True):
    """path: for messages. has_repeated_keys: a JSON object has a key twice."""

    path: str
    location: Path
    text: str
    document: Any
    has_repeated_keys: bool

    def lines(self, wanted: Sequence[Keys]) -> list[int]:
        """The line of each of these keys, or of the innermost table or list around it."""
        lines = lines_of(self.text, wanted, toml=is_toml(self.location))
        return [innermost(lines, keys) for keys in wanted]


def is_toml(location: Path) -> bool:
    return location.suffix.lower() == TOML_SUFFIX


def read_text(path: str, location: Path) -> str:
    """Raises Refused. path: for messages."""
    data = read_whole(path, location, _MAX_BYTES)
    try:
        return data.removeprefix(BOM_UTF8).decode()  # line ends as they are
    except UnicodeDecodeError:
        raise Refused("bad-encoding", "the scene file is not UTF-8", file=path) from None


def parse(path: str, location: Path) -> Parsed:
    """Raises Refused if the file is not well-formed TOML or JSON."""
    text = read_text(path, location)
    if is_toml(location):
        return Parsed(path, location, text, _toml(path, text), False)
    return Parsed(path, location, text, *_json(path, text))


def parse_toml(text: str) -> dict[str, Any]:
    """Raises ValueError for text that is not TOML, and for a key of many parts: the parser takes
    time and memory by the square of their number."""
    if text.count(".") > MAX_DEPTH and _LONG_KEY.search(text):
        raise ValueError(f"a key has more than {MAX_DEPTH} parts")
    return tomllib.loads(text)


def _toml(path: str, text: str) -> Any:
    try:
        return parse_toml(text)
    except tomllib.TOMLDecodeError as error:
        match = re.fullmatch(_TOML_PLACE, str(error))
        reason, line = match.groups() if match else (str(error), None)
        line = int(line or len(text.splitlines()))
        message = f"not well-formed TOML: {reason}"
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
        return math.nan  # reported later, with the name of the body

    try:
        document = json.loads(text, parse_constant=refuse, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        message = f"not well-formed JSON: {error.msg}"
        raise Refused("bad-scene", message, file=path, line=error.lineno) from None
    except (RecursionError, ValueError) as error:
        message = f"not readable JSON: {why_unreadable(error)}"
        raise Refused("bad-scene", message, file=path) from None
    return document, repeated
