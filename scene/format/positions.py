"""Where the values of a document are written in its text; needed only for errors."""

from __future__ import annotations

from typing import Protocol

from satcheck.core.frozen import frozen

Key = str | int
Keys = tuple[Key, ...]


@frozen
class Place:
    """Offsets in the text: where the key or, in a list, the item starts; the value's extent.

    A TOML table under a header of its own has its header as key, and nothing as value.
    """

    key: int
    start: int
    end: int


class Positions(Protocol):
    def line(self, keys: Keys) -> int:
        """Of what `keys` lead to, or of the innermost of them that is there; the first is 1."""
        ...

    def place(self, keys: Keys) -> Place:
        """KeyError where there is no such value."""
        ...
