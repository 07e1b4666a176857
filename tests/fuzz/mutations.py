"""Damaged copies of a file, each made from a random number generator alone."""

from __future__ import annotations

import io
import json
import random
import re
import zipfile
from collections.abc import Callable
from typing import Any

Change = Callable[[bytes, random.Random], bytes]

_NUMBER = re.compile(rb"-?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?")
_WORD = re.compile(rb"[A-Za-z_][A-Za-z0-9_:.#/-]*")
_NUMBERS = (
    *(b"0", b"-1", b"1e308", b"-1e-320", b"nan", b"inf", b"1e999", b"0x10", b"1_000"),
    *(b"%d" % (1 << bits) for bits in (16, 31, 32, 53, 63, 64)),
    *(b"9" * 5000, "\N{ARABIC-INDIC DIGIT THREE}".encode(), b""),
)
_BYTES = (b"\0", b"\xff", b"\n", b"<", b">", b'"', b"[", b"{", b"&", b"\x1b[2J", b"\xed\xa0\x80")
# What a JSON value is replaced with.
_VALUES: tuple[Any, ...] = (
    *(None, True, 0, -1, 1.5, 1 << 31, 1 << 63, 1 << 64, 1e308, float("nan"), float("inf")),
    *("", "a", "../../x", "\ud800", "\0", "a\nb", "A" * 300, [], {}, [[]], [0], {"a": 0}, 10**400),
)


def damaged(data: bytes, rng: random.Random) -> bytes:
    """A copy with one to four changes; of an archive often inside of its parts."""
    change = _whole
    if data.startswith(b"PK") and rng.random() < 0.7:
        change = _in_archive
    elif data.startswith(b"glTF") and rng.random() < 0.7:
        change = _in_glb
    for _ in range(rng.randint(1, 4)):
        data = change(data, rng)
    return data


def _whole(data: bytes, rng: random.Random) -> bytes:
    if data[:1] in (b"{", b"[") and rng.random() < 0.9:
        return _in_json(data, rng)
    return rng.choice(_CHANGES)(data, rng)


def _flip(data: bytes, rng: random.Random) -> bytes:
    if not data:
        return data
    at = rng.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1 :]


def _insert(data: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(data))
    return data[:at] + rng.choice(_BYTES) + data[at:]


def _cut(data: bytes, rng: random.Random) -> bytes:
    return data[: rng.randint(0, len(data))]


def _drop(data: bytes, rng: random.Random) -> bytes:
    start, end = _range(data, rng)
    return data[:start] + data[end:]


def _repeat(data: bytes, rng: random.Random) -> bytes:
    start, end = _range(data, rng)
    return data[:end] + data[start:end] * rng.choice((1, 2, 50)) + data[end:]


def _move(data: bytes, rng: random.Random) -> bytes:
    start, end = _range(data, rng)
    rest = data[:start] + data[end:]
    at = rng.randint(0, len(rest))
    return rest[:at] + data[start:end] + rest[at:]


def _other_number(data: bytes, rng: random.Random) -> bytes:
    return _replace(_NUMBER, data, rng, lambda _: rng.choice(_NUMBERS))


def _other_word(data: bytes, rng: random.Random) -> bytes:
    words = _WORD.findall(data[:20_000]) or [b"x"]
    return _replace(_WORD, data, rng, lambda _: rng.choice(words))


def _no_word(data: bytes, rng: random.Random) -> bytes:
    return _replace(_WORD, data, rng, lambda _: rng.choice((b"", b"\xff", b"a" * 300)))


_CHANGES: tuple[Change, ...] = (
    *(_flip, _insert, _cut, _drop, _repeat, _move),
    *(_other_number,) * 6,
    *(_other_word,) * 6,
    _no_word,
)


def _range(data: bytes, rng: random.Random) -> tuple[int, int]:
    """Of at most a few hundred bytes."""
    start = rng.randint(0, len(data))
    return start, min(len(data), start + rng.choice((1, 4, 16, 64, 400)))


def _replace(
    pattern: re.Pattern[bytes], data: bytes, rng: random.Random, new: Callable[[bytes], bytes]
) -> bytes:
    places = list(pattern.finditer(data[:200_000]))
    if not places:
        return data
    at = rng.choice(places)
    return data[: at.start()] + new(at[0]) + data[at.end() :]


def _in_json(data: bytes, rng: random.Random) -> bytes:
    """Another value, key or order somewhere in the document."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):
        return rng.choice(_CHANGES)(data, rng)
    _change_value(document, rng)
    return json.dumps(document).encode()


def _change_value(document: Any, rng: random.Random) -> None:
    places = [*_places(document)]
    if not places:
        return
    owner, key = rng.choice(places)
    what = rng.random()
    if what < 0.15:
        del owner[key]
    elif what < 0.3:
        other, its_key = rng.choice(places)
        owner[key] = json.loads(json.dumps(other[its_key]))
    elif what < 0.4 and isinstance(owner, dict):
        owner[rng.choice(["", "\ud800", "x" * 300, *owner])] = owner.pop(key)
    else:
        owner[key] = rng.choice(_VALUES)


def _places(value: Any) -> list[tuple[Any, Any]]:
    """(a list or an object, a key of it), of all values in the document."""
    found: list[tuple[Any, Any]] = []
    waiting = [value]
    while waiting:
        owner = waiting.pop()
        pairs = owner.items() if isinstance(owner, dict) else enumerate(owner)
        for key, member in pairs:
            found.append((owner, key))
            if isinstance(member, dict | list):
                waiting.append(member)
    return found


def _in_archive(data: bytes, rng: random.Random) -> bytes:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = {name: archive.read(name) for name in archive.namelist()}
    except (zipfile.BadZipFile, OSError, ValueError, RuntimeError, NotImplementedError, EOFError):
        return rng.choice(_CHANGES)(data, rng)
    name = rng.choice([*parts])
    parts[name] = _whole(parts[name], rng)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, content in parts.items():
            archive.writestr(each, content)
    return stream.getvalue()


def _in_glb(data: bytes, rng: random.Random) -> bytes:
    """In the JSON chunk, which is the first one."""
    size = int.from_bytes(data[12:16], "little")
    text, rest = data[20 : 20 + size], data[20 + size :]
    text = _in_json(text, rng)
    text += b" " * (-len(text) % 4)
    whole = len(text).to_bytes(4, "little") + b"JSON" + text + rest
    return b"glTF" + (2).to_bytes(4, "little") + (12 + len(whole)).to_bytes(4, "little") + whole
