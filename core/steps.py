"""The long steps that are under way, by name, for whoever shows progress.

A step that takes seconds names itself here; nothing depends on whether anybody looks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


class _Step:
    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name


# Of all threads, in the order in which the steps began. Appending and removing are atomic, so no
# lock is needed.
_under_way: list[_Step] = []


@contextmanager
def step(name: str) -> Iterator[None]:
    """`splitting kettle`, while it lasts."""
    with step_in_words() as say:
        say(name)
        yield


@contextmanager
def step_in_words() -> Iterator[Callable[[str], None]]:
    """A step that says how far it is. Its name is what the function was called with last; before
    that it has none, so that steps that turn out short are not shown."""
    this = _Step("")

    def say(name: str) -> None:
        if not this.name:
            _under_way.append(this)
        this.name = name

    try:
        yield say
    finally:
        if this.name:
            _under_way.remove(this)


def current() -> str:
    """The name of the step that began last; empty when there is none."""
    last = _under_way[-1:]
    return last[0].name if last else ""
