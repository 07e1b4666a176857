"""Phrases for messages about inputs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

_SHOWN = 5  # of a long list


def meant(word: str, known: Iterable[str], form: str = " (did you mean {}?)") -> str:
    """A hint with the known word that resembles `word` most; empty if none does."""
    close = _closest(word, frozenset(known))
    return form.format(repr(close)) if close else ""


@lru_cache(maxsize=64)  # a key that is misspelt in one body is often misspelt in all
def _closest(word: str, known: frozenset[str]) -> str | None:
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, sorted(known), n=1)), None)


def listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(names[:_SHOWN]) + more
