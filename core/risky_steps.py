"""Steps of a check that may end its process, for whoever has to say which step did.

A process repeats a check carefully after it was lost: it tells each risky step before it takes it,
and leaves out those that are known to end it. Else nothing here has an effect.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from msgspec import Struct

from satcheck.core.errors import SatcheckError


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
