"""Gathers the names of a mesh file that its reader does not know, for the one rule about them."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from satcheck.core.errors import SatcheckError
from satcheck.scene.errors import Refused
from satcheck.scene.vocabulary import Names


class UnknownNames:
    """Unknown names, each once for a kind of place, with its first place."""

    def __init__(self) -> None:
        self._messages: dict[tuple[str, str], str] = {}
        self._counts: dict[tuple[str, str], int] = {}

    def look(self, names: Names, found: Collection[str], kind: str, place: str) -> None:
        """Take the names found at a place. kind: of the place, such as `node`; place: `node 3`.
        Raises Refused for a misspelt name."""
        if names.read.issuperset(found):
            return
        for name in found:
            key = kind, name
            if key in self._counts:
                self._counts[key] += 1
                continue
            refuse_misspelt(names, [name], place)
            for unread in names.unread([name], place):
                self.note(key, unread.message)

    def note(self, key: tuple[str, str], message: str) -> None:
        """Take something that blocks a pass and is no single name. key: what is named once."""
        if key not in self._counts:
            self._messages[key] = message
        self._counts[key] = self._counts.get(key, 0) + 1

    def warnings(self) -> tuple[tuple[str, str], ...]:
        """Return (code, message) for each name."""
        return tuple(
            ("unread", message + (f" ({count} times)" if count > 1 else ""))
            for key, message in self._messages.items()
            for count in (self._counts[key],)
        )


def refuse_misspelt(names: Names, found: Iterable[str], place: str) -> None:
    """Raises Refused for a misspelt name."""
    try:
        names.refuse_misspelt(found, place)
    except SatcheckError as error:
        raise Refused(error.code, error.message) from None
