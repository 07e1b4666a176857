"""The long steps that are under way, by name, for whoever shows progress.

A step that takes seconds names itself here; nothing depends on whether anybody looks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Of all threads, in the order in which the steps began. A list changes in one piece.
_under_way: list[str] = []


@contextmanager
def step(name: str) -> Iterator[None]:
    """`splitting kettle`, while it lasts."""
    _under_way.append(name)
    try:
        yield
    finally:
        _under_way.remove(name)


@contextmanager
def step_in_words() -> Iterator[Callable[[str], None]]:
    """A step that says how far it is. Its name is what the function was called with last; before
    that it has none, so that steps that turn out short are not shown."""
    names: list[str] = []

    def say(name: str) -> None:
        _under_way.append(name)
        names.append(name)
        if len(names) > 1:
            _under_way.remove(names.pop(0))

    try:
        yield say
    finally:
        for name in names:
            _under_way.remove(name)


def current() -> str:
    """The step that began last; empty when there is none."""
    return _under_way[-1] if _under_way else ""
