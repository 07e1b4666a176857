"""The scenes of a batch: as a file names them, and in shards that know nothing of each other."""

from __future__ import annotations

import codecs
import hashlib
import json
import os
import re
from collections.abc import Iterator
from pathlib import Path

import msgspec
from msgspec import Struct

from satcheck.audit.batch.options import World
from satcheck.audit.batch.remote import at, is_url
from satcheck.core.errors import SatcheckError

_JSON_LIST = "["


_FORM = re.compile(r"([0-9]{1,9})/([0-9]{1,9})")


def read_manifest(name: str) -> Iterator[World]:
    """A scene for each line: the name of a file, relative to the working directory, or a JSON list
    of files that are one scene together. Empty lines are skipped. name: a path or a URL.

    Raises SatcheckError: `unreadable-file`, `bad-manifest`, and those of `batch.remote`.
    """
    for number, line in enumerate(_lines(name), 1):
        text = os.fsdecode(line.removeprefix(codecs.BOM_UTF8) if number == 1 else line)
        if text.strip():
            yield _world(text.rstrip("\r\n"), f"{name}:{number}")


def _lines(name: str) -> Iterator[bytes]:
    if is_url(name):
        with at(name) as (system, file), system.open(file, "rb") as lines:
            yield from lines
        return
    try:
        with Path(name).open("rb") as lines:
            yield from lines
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise SatcheckError("unreadable-file", reason, file=name) from None


def _world(line: str, place: str) -> World:
    if not line.startswith(_JSON_LIST):
        return (line,)
    try:
        world = msgspec.convert(json.loads(line), World)  # names may not be UTF-8
    except (ValueError, RecursionError, msgspec.ValidationError) as error:
        reason = f'no list of files: {error}; a name that begins with [ is written ["[..."]'
        raise SatcheckError("bad-manifest", reason, file=place) from None
    if not world:
        raise SatcheckError("bad-manifest", "the list of files is empty", file=place)
    return world


class Shard(Struct, frozen=True):
    """Number `number` of `count`, from 1. The names of its files alone decide in which shard a
    world is: adding worlds to a batch moves none to another shard."""

    number: int
    count: int

    def has(self, world: World) -> bool:
        return _hash(world) % self.count == self.number - 1


def parse_shard(text: str) -> Shard:
    """`I/N`. Raises ValueError."""
    given = _FORM.fullmatch(text)
    if given is None or not 1 <= int(given[1]) <= int(given[2]):
        raise ValueError(f"{text} is not I/N, with I from 1 to N")
    return Shard(int(given[1]), int(given[2]))


def _hash(world: World) -> int:
    names = b"\0".join(map(os.fsencode, world))
    return int.from_bytes(hashlib.sha256(names).digest()[:8], "big")
