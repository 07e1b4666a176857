"""The one rule for what stands in a file: it is read, or known to be harmless, or blocks a pass.

An element, key, attribute or extension that can make, move, hide, reshape or exempt a body must not
be lost in silence. Each place of a format has the names that are read there, and those that are
harmless, with the reason. A name that is neither blocks a pass; one that resembles a name that is
read is refused as misspelt.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from difflib import get_close_matches
from fnmatch import fnmatchcase
from functools import cached_property

from msgspec import Struct

from satcheck.scene.errors import Refused

# Two names of which so much is the same are one, misspelt: `colision`, `transfrom`.
ALIKE = 0.8


class Names(Struct, frozen=True, dict=True):
    """The names at one place. harmless: why none of them can make, move, hide, reshape or exempt a
    body, by name; `*` in a name stands for any letters. alike: how much of two names is the same
    if one of them is misspelt."""

    read: frozenset[str]
    harmless: Mapping[str, str] = {}
    alike: float = ALIKE

    @cached_property
    def known(self) -> frozenset[str]:
        """Return the names that block no pass, without those that `*` stands in."""
        return self.read.union(self.harmless)

    def knows(self, name: str) -> bool:
        if name in self.known:
            return True
        return any(fnmatchcase(name, known) for known in self.harmless if "*" in known)

    def unread(self, names: Iterable[str], place: str) -> Iterator[str]:
        """Yield what blocks a pass for each name that nobody knows there, once. place:
        `line 4: <link>`. Raises Refused for a name that is misspelt."""
        for name in dict.fromkeys(names):
            if not self.knows(name):
                self.refuse_misspelt([name], place)
                yield f"{place}: {name} is not read; it may hold or move a body"

    def refuse_misspelt(self, names: Iterable[str], place: str) -> None:
        """Raises Refused for the first name that is misspelt. Where a format lets everybody
        write names of their own, the others are harmless."""
        for name in names:
            near = [] if self.knows(name) else self._near(name)
            if near:
                message = f"{place}: unknown {name} (did you mean {near[0]}?)"
                raise Refused("misspelt", message)

    def _near(self, name: str) -> list[str]:
        """Return the name that is read and resembles it most. Capitals do not count, and short
        names are misspelt by swapped letters: `nmae`, `xzy`."""
        low = name.casefold()
        read = {known.casefold(): known for known in sorted(self.read)}
        swapped = [known for known in read if sorted(known) == sorted(low)]
        near = swapped[:1] or get_close_matches(low, read, 1, self.alike)
        return [read[each] for each in near]


def reasons(**names: str) -> dict[str, str]:
    """Return why names are harmless, by name. names: by the reason, with _ for a space, separated
    by blanks."""
    return {name: why.replace("_", " ") for why, text in names.items() for name in text.split()}


class UnknownNames:
    """Unknown names, each once for a kind of place, with its first place."""

    def __init__(self) -> None:
        self._messages: dict[tuple[str, str], str] = {}
        self._counts: Counter[tuple[str, str]] = Counter()

    def look(self, names: Names, found: Collection[str], kind: str, place: str) -> None:
        """Take the names found at a place. kind: of the place, such as `node`; place: `node 3`.
        Raises Refused for a misspelt name."""
        if names.known.issuperset(found):
            return
        for name in found:
            if not names.knows(name):
                key = kind, name
                self.note(key, self._messages.get(key) or next(names.unread([name], place)))

    def note(self, key: tuple[str, str], message: str) -> None:
        """Take something that blocks a pass and is no single name. key: what is named once."""
        self._messages.setdefault(key, message)
        self._counts[key] += 1

    def warnings(self) -> tuple[tuple[str, str], ...]:
        """Return (code, message) for each name."""
        times = {key: f" ({n} times)" if n > 1 else "" for key, n in self._counts.items()}
        return tuple(("unread", said + times[key]) for key, said in self._messages.items())
