"""The one rule for what stands in a file: it is read, or known to be harmless, or blocks a pass.

An element, key, attribute or extension that can make, move, hide, reshape or exempt a body must not
be lost in silence. Each place of a format has the names that are read there, and those that are
harmless, with the reason. A name that is neither blocks a pass; one that resembles a name that is
read is refused as misspelt.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches

from msgspec import Struct

from satcheck.core.errors import SatcheckError
from satcheck.scene.issue import Issue, issue

# Two names of which so much is the same are one, misspelt: `colision`, `transfrom`.
ALIKE = 0.8


class Names(Struct, frozen=True):
    """The names at one place. harmless: why none of them can make, move, hide, reshape or exempt a
    body, by name; a name that ends in `*` stands for all that begin so."""

    read: frozenset[str]
    harmless: Mapping[str, str] = {}

    def knows(self, name: str) -> bool:
        if name in self.read or name in self.harmless:
            return True
        return any(name.startswith(known[:-1]) for known in self.harmless if known.endswith("*"))

    def unread(
        self,
        names: Iterable[str],
        place: str,
        *,
        body: str | None = None,
        file: str | None = None,
    ) -> Iterator[Issue]:
        """Yield an issue that blocks a pass for each name that nobody knows there, once. place:
        `line 4: <link>`. Raises SatcheckError for a name that is misspelt."""
        for name in dict.fromkeys(names):
            if self.knows(name):
                continue
            if near := self._like(name):
                message = f"{place}: unknown {name} (did you mean {near}?)"
                raise SatcheckError("misspelt", message, file=file, body=body)
            message = f"{place}: {name} is not read; it may hold or move a body"
            yield issue("unread", message, body=body, file=file)

    def _like(self, name: str) -> str | None:
        """Return the name that is read and resembles it most. Capitals do not count, and short
        names are misspelt by swapped letters: `nmae`, `xzy`."""
        read = {known.casefold(): known for known in sorted(self.read)}
        swapped = [known for low, known in read.items() if sorted(low) == sorted(name.casefold())]
        if swapped:
            return swapped[0]
        return next(
            (read[near] for near in get_close_matches(name.casefold(), read, 1, ALIKE)), None
        )
