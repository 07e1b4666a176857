"""What messages about inputs have in common."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

_SHOWN = 5  # of a long list


def meant(word: str, known: Iterable[str], form: str = " (did you mean {}?)") -> str:
    """A question for the known word that `word` resembles most, empty when it resembles none."""
    close = _closest(word, frozenset(known))
    return form.format(repr(close)) if close else ""


@lru_cache(maxsize=64)  # who misspells a key of one body misspells it in all of them
def _closest(word: str, known: frozenset[str]) -> str | None:
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, sorted(known), n=1)), None)


def listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(names[:_SHOWN]) + more
