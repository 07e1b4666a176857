"""The steps of a check: long ones, for progress, and risky ones, which may end the process.

A step that takes seconds names itself here; nothing depends on whether anybody looks. A process
repeats a check carefully after it was lost: it tells each risky step before it takes it, and leaves
out those that are known to end it. Else nothing here has an effect.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from msgspec import Struct

from satcheck.core.errors import SatcheckError


class _Step:
    """end: where time.monotonic() ends it."""

    __slots__ = ("end", "name")

    def __init__(self, name: str, seconds: float) -> None:
        self.name, self.end = name, time.monotonic() + seconds


# Of all threads, in the order in which the steps began. Appending and removing are atomic, so no
# lock is needed.
_under_way: list[_Step] = []


@contextmanager
def step(name: str, seconds: float = math.inf) -> Iterator[None]:
    """`splitting kettle`, while it lasts. seconds: its limit."""
    with step_in_words(seconds) as say:
        say(name)
        yield


@contextmanager
def step_in_words(seconds: float = math.inf) -> Iterator[Callable[[str], None]]:
    """A step that says how far it is. Its name is what the function was called with last; before
    that it has none, so that steps that turn out short are not shown."""
    this = _Step("", seconds)

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
    """The name of the step that began last, and the time that is left of its limit; empty when
    there is none."""
    if not (last := _under_way[-1:]):
        return ""
    left = last[0].end - time.monotonic()
    return last[0].name + (f", at most {max(left, 0.0):.0f} s left" if left < math.inf else "")


class LeftOut(SatcheckError):
    """The step has ended its process before. message: how, as `died (SIGSEGV)`."""


class Loss(Struct, frozen=True):
    """How a process was lost. code: of `core.worker_errors`. how: `died (SIGSEGV)`."""

    code: str
    how: str


class Care(Struct, frozen=True):
    """left_out: the steps to leave out, by name. tell: called with the name of the step that
    begins, and with "" when it ends."""

    left_out: Mapping[str, Loss]
    tell: Callable[[str], None]


_care: Care | None = None
_end: Callable[[], object] | None = None


def is_careful() -> bool:
    return _care is not None


@contextmanager
def careful(care: Care | None) -> Iterator[None]:
    """The steps of this process are careful while it lasts, unless `care` is None."""
    global _care
    _care = care
    try:
        yield
    finally:
        _care = None


@contextmanager
def risky_step(name: str) -> Iterator[None]:
    """Raises LeftOut."""
    care = _care
    if care is None:
        yield
        return
    if name in care.left_out:
        loss = care.left_out[name]
        raise LeftOut(loss.code, loss.how)
    care.tell(name)
    try:
        yield
    except MemoryError as error:
        not_for_lack_of_memory(error)
        raise
    finally:
        care.tell("")


def end_at_memory_error(end: Callable[[], object]) -> None:
    """Makes `end` what this process does as soon as memory does not suffice: a fresh process may
    have enough of it."""
    global _end
    _end = end


def not_for_lack_of_memory(error: Exception) -> None:
    """To be called where any error becomes part of an answer."""
    if isinstance(error, MemoryError) and _end is not None:
        _end()
