"""Bodies as rules see them."""

from __future__ import annotations

from msgspec import Struct


class Subject(Struct, frozen=True):
    """What rules depend on of a body."""

    id: str
    groups: tuple[str, ...] = ()
    static: bool = False
