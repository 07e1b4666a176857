"""The text of a report, read so that it means one thing only."""

from __future__ import annotations

import json
import math
from collections import Counter
from typing import Any

from satcheck.verify.exact import Rejected


def parse(text: str) -> Any:
    """JSON values. Rejected: not JSON, a key that an object has twice, a number that no float64 is.

    JSON leaves open which of two equal keys counts, so two readers of such a report may see two
    reports.
    """
    try:
        return json.loads(
            text, object_pairs_hook=_object, parse_constant=_refuse, parse_float=_finite
        )
    except (ValueError, RecursionError) as error:
        raise Rejected(f"not JSON: {error}") from None


def _object(members: list[tuple[str, Any]]) -> dict[str, Any]:
    made = dict(members)
    if len(made) < len(members):
        keys = [key for key, _ in members]
        twice = next(key for key, times in Counter(keys).items() if times > 1)
        raise Rejected(f"the key {twice!r} stands twice in one object")
    return made


def _finite(text: str) -> float:
    number = float(text)
    if math.isinf(number):
        raise Rejected(f"the number {text[:40]} is out of range")
    return number


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is no number")
