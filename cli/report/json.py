"""Documents as JSON text: two-space indentation, every number as it reads back, no sign of zero."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

from msgspec import json as msgspec_json
from msgspec import msgpack, to_builtins

from satcheck.report.report import Report, without_timings

INDENT = 2
_INDENTATION = re.compile("\n *")
# How MessagePack marks a float64, and the bits of a NaN or an infinity. Other bytes may look so.
_NOT_FINITE = re.compile(rb"\xcb[\x7f\xff][\xf0-\xff]")


def render(report: Report, *, timings: bool) -> list[str]:
    """The document in pieces, final newline included; without timings the same bytes every time.

    Not as one text: the report of a scene can be larger than the scene in memory.
    """
    pieces = []
    for number, key in enumerate(report.__struct_fields__):
        pieces.append(f'{"," if number else "{"}\n  "{key}": ')
        pieces += _member(getattr(report, key), timings)
    return [*pieces, "\n}\n"]


def document(values: Any) -> str:
    """Any JSON values or structs in that form, and a final newline.

    Raises ValueError, as `render` does, for a number that is not finite.
    """
    return _text(values) + "\n"


def line(values: Any) -> str:
    """JSON values on one line, for JSON Lines. Raises ValueError as `document` does."""
    return _INDENTATION.sub("", document(values)) + "\n"


def _member(value: Any, timings: bool) -> Iterable[str]:
    """A value of the outermost object; a list of structs in a piece for each."""
    if not isinstance(value, tuple) or not value:
        yield _text(value, depth=1)
        return
    written = value if timings else (without_timings(to_builtins(element)) for element in value)
    for number, element in enumerate(written):
        yield f"{',' if number else '['}\n    {_text(element, depth=2)}"
    yield "\n  ]"


def _text(value: Any, depth: int = 0) -> str:
    try:
        _require_finite(value)
        text = msgspec_json.format(msgspec_json.encode(value), indent=INDENT).decode()
    except UnicodeEncodeError:  # bytes of a file name that are not UTF-8
        text = json.dumps(to_builtins(value), indent=INDENT, allow_nan=False)
    # No string has a line end in it, so these are numbers.
    text = f"{text}\n".replace("-0.0\n", "0.0\n").replace("-0.0,\n", "0.0,\n")[:-1]
    return text.replace("\n", "\n" + " " * (INDENT * depth))


def _require_finite(value: Any) -> None:
    """JSON has no NaN and no infinity, and msgspec would write null. MessagePack holds the numbers
    themselves, so a search of its bytes clears most values, and json decides the others."""
    if _NOT_FINITE.search(msgpack.encode(value)):
        json.dumps(value, default=to_builtins, allow_nan=False)
