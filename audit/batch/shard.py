"""Shards: a batch in parts that know nothing of each other, for machines that share no process."""

from __future__ import annotations

import hashlib
import os
import re

from msgspec import Struct

from satcheck.audit.batch.check_options import World

_FORM = re.compile(r"([0-9]{1,9})/([0-9]{1,9})")


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
