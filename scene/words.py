"""Phrases for messages about inputs."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from functools import lru_cache

_SHOWN = 5  # of a long list
_LONGEST_PATH = 200  # characters in a message


def meant(word: str, known: Iterable[str], form: str = " (did you mean {}?)") -> str:
    """A hint with the known word that resembles `word` most; empty if none does."""
    close = _closest(word, frozenset(known))
    return form.format(repr(close)) if close else ""


@lru_cache(maxsize=64)  # a key that is misspelt in one body is often misspelt in all
def _closest(word: str, known: frozenset[str]) -> str | None:
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, sorted(known), n=1)), None)


def told_apart(a: float, b: float) -> tuple[str, str]:
    """Both numbers, with three digits or as many as they differ in."""
    for digits in range(3, 18):
        texts = f"{a:.{digits}g}", f"{b:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def why_unreadable(error: Exception) -> str:
    """Of a document that is too deep, or has an integer of thousands of digits: then Python says
    how a program may read it, which is no advice for a user."""
    long = "int_max_str_digits" in str(error)
    return f"a number of more than {sys.get_int_max_str_digits()} digits" if long else str(error)


def quoted(text: str, most: int = _LONGEST_PATH) -> str:
    """Return the text between quotes, with at most so many of its characters."""
    return repr(text if len(text) <= most else text[:most] + "...")


def listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(names[:_SHOWN]) + more


def with_closed_brackets(glob: str) -> str:
    """Return a glob that matches the same texts, with `[[]` for each `[` that nothing closes.

    `fnmatch` looks through the rest of the text for the end of each of these, one character at a
    time: that takes minutes for a few ten thousand of them.
    """
    parts: list[str] = []
    at, last = 0, glob.rfind("]")
    while at < len(glob):
        end = at
        if glob[at] == "[":
            first = at + 1 + glob.startswith("!", at + 1)
            first += glob.startswith("]", first)  # it does not close the bracket
            end = glob.find("]", first) if first <= last else -1
        parts.append("[[]" if end < 0 else glob[at : end + 1])
        at = max(at, end) + 1
    return "".join(parts)
