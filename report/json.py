"""Documents as JSON text: two-space indentation, every number as it reads back, no sign of zero."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any, TypeVar

from msgspec import UNSET, DecodeError, Struct, convert, msgpack, to_builtins
from msgspec import json as msgspec_json

from satcheck.report.assets import Asset, AssetsReport
from satcheck.report.report import Report, without_timings
from satcheck.report.values import Value

INDENT = 2
_INDENTATION = re.compile("\n *")
# How JSON writes a byte of a file name that is not UTF-8.
_NOT_UTF8 = b"\\udc"
Read = TypeVar("Read")
_IN_A_PIECE = 100  # elements of a list
_ASSETS_IN_A_PIECE = 10
# At the end of a line. No string has a line end in it, so this is a number.
_NEGATIVE_ZERO = re.compile(rb"-0\.0(?=,?$)", re.MULTILINE)
# In compact JSON. A quote in a string has a backslash before it, so this is a member, and the
# first one of no object.
_TIMES = re.compile(rb',"microseconds":[^,}]*')
# Controls, marks that reorder text or end a line, and the second # of a command such as ##[error].
_OBEYED = re.compile("[\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]|(?<=#)#(?=\\w*\\[)")
# In a string it may be text.
_PERHAPS_NEGATIVE_ZERO = re.compile(rb"-0\.0[,}\]]")
# How MessagePack marks a float64, and the bits of a NaN or an infinity. Other bytes may look so.
_NOT_FINITE = re.compile(rb"\xcb[\x7f\xff][\xf0-\xff]")


def render(report: Report, *, timings: bool) -> Iterator[str]:
    """The document in pieces, final newline included; without timings the same bytes every time.

    Each piece is made when it is written: the text of a report is larger than the report in memory.
    Raises ValueError for a number that is not finite, before the first piece.
    """
    for _, value in _members(report):
        for piece in _pieces_of(value):
            _require_finite(piece)
    return _rendered(report, timings)


def _rendered(report: Report, timings: bool) -> Iterator[str]:
    return _object(_member(key, value, timings) for key, value in _members(report))


def _members(report: Report) -> Iterator[tuple[str, Any]]:
    """Those that are set."""
    for key in report.__struct_fields__:
        value = getattr(report, key)
        if value is not UNSET:
            yield key, value


def render_assets(report: AssetsReport, assets: Iterable[Asset], *, timings: bool) -> Iterator[str]:
    """The report with these assets as its own, as `render` writes it; each piece of them is made
    when it is written. Raises ValueError for a number that is not finite."""
    return _object(
        _list(key, _finite(_some(assets)), timings)
        if key == "assets"
        else _member(key, getattr(report, key), timings)
        for key in report.__struct_fields__
    )


def _finite(pieces: Iterable[Any]) -> Iterator[Any]:
    for piece in pieces:
        _require_finite(piece)
        yield piece


def _some(assets: Iterable[Asset]) -> Iterator[tuple[Asset, ...]]:
    left = iter(assets)
    while piece := tuple(islice(left, _ASSETS_IN_A_PIECE)):
        yield piece


def document(values: Any) -> str:
    """Any JSON values or structs in that form, and a final newline.

    Raises ValueError, as `render` does, for a number that is not finite.
    """
    _require_finite(values)
    return _text(values) + "\n"


def line(values: Any) -> str:
    """JSON values on one line, for JSON Lines. Raises ValueError as `document` does."""
    return _INDENTATION.sub("", document(values)) + "\n"


def line_of(value: Value, *, timings: bool = False) -> bytes:
    """A struct as one line of compact JSON, for JSON Lines; without timings the same input makes
    the same bytes. Raises ValueError as `document` does."""
    try:
        _require_finite(value)
        text = msgspec_json.encode(value)
        text = text if timings else _TIMES.sub(b"", text)
    except UnicodeEncodeError:  # bytes of a file name that are not UTF-8
        text = b"-0.0,"
    if _PERHAPS_NEGATIVE_ZERO.search(text):
        values = to_builtins(value)
        return line(values if timings else without_timings(values)).encode()
    return text + b"\n"


def read_line(line: bytes, type: type[Read]) -> Read:
    """Return what `line_of` wrote, or a struct with some of its fields. Raises
    msgspec.DecodeError."""
    if _NOT_UTF8 not in line:
        return msgspec_json.decode(line, type=type)
    try:
        return convert(json.loads(line), type)
    except ValueError as error:
        raise DecodeError(str(error)) from None


def _object(members: Iterable[Iterable[str]]) -> Iterator[str]:
    """members: the pieces of each."""
    before = "{"
    for member in members:
        yield before
        yield from member
        before = ","
    yield "\n}\n"


def _member(key: str, value: Any, timings: bool) -> Iterable[str]:
    """A member of the outermost object; a long list of structs in pieces."""
    if not isinstance(value, tuple):
        if not timings and isinstance(value, Struct):
            value = without_timings(to_builtins(value))
        return (_text({key: value}).removeprefix("{").removesuffix("\n}"),)
    return _list(key, _pieces_of(value), timings)


def _list(key: str, pieces: Iterable[Any], timings: bool) -> Iterator[str]:
    begin, end = f'\n  "{key}": [', "\n  ]"
    before = begin
    for piece in pieces:
        yield before
        written = piece if timings else without_timings(to_builtins(piece))
        yield _text({key: written})[len("{" + begin) : -len(end + "\n}")]
        before = ","
    yield begin + "]" if before == begin else end


def _pieces_of(value: Any) -> Iterator[Any]:
    """The parts of a list; any other value as it is."""
    if not isinstance(value, tuple):
        yield value
        return
    for first in range(0, len(value), _IN_A_PIECE):
        yield value[first : first + _IN_A_PIECE]


def _text(value: Any) -> str:
    try:
        text = msgspec_json.format(msgspec_json.encode(value), indent=INDENT)
    except UnicodeEncodeError:  # bytes of a file name that are not UTF-8
        text = json.dumps(to_builtins(value), indent=INDENT, allow_nan=False).encode()
    return escaped(_NEGATIVE_ZERO.sub(b"0.0", text).decode())


def escaped(text: str) -> str:
    """The same JSON or TOML, without what a terminal or a CI system would obey. Only strings hold
    such characters, and a string may write any character as an escape."""
    is_plain = "#" not in text or "##" not in text  # a search for one character takes less
    if is_plain and text.isascii() and "\x7f" not in text:
        return text
    return _OBEYED.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


def _require_finite(value: Any) -> None:
    """JSON has no NaN and no infinity, and msgspec would write null. MessagePack holds the numbers
    themselves, so a search of its bytes clears most values, and json decides the others."""
    try:
        if not _NOT_FINITE.search(msgpack.encode(value)):
            return
    except UnicodeEncodeError:  # as in _text
        pass
    json.dumps(value, default=to_builtins, allow_nan=False)
