"""The long steps that are under way, by name, for whoever shows progress.

A step that takes seconds names itself here; nothing depends on whether anybody looks.
"""

from __future__ import annotations

from collections.abc import Iterator
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


def current() -> str:
    """The step that began last; empty when there is none."""
    return _under_way[-1] if _under_way else ""
