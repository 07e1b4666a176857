"""Where the values of a JSON document are written. Only for text that `json` has accepted."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cached_property

from satcheck.scene.format.positions import Key, Keys, Place

_SPACE = re.compile(r"[ \t\r\n]*")


class JsonPositions:
    """Finds a value by going down to it; what lies beside the way is skipped by the C scanner."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._skip = json.JSONDecoder().raw_decode
        self._known: dict[int, dict[Key, Place]] = {}

    @cached_property
    def root(self) -> Place:
        start = self._after_space(0)
        return Place(start, start, self._skip(self._text, start)[1])

    def line(self, keys: Keys) -> int:
        place = self.root
        for key in keys:
            inner = self._members(place).get(key)
            if inner is None:
                break
            place = inner
        return self._text.count("\n", 0, place.key) + 1

    def place(self, keys: Keys) -> Place:
        """KeyError where there is no such value."""
        place = self.root
        for key in keys:
            place = self._members(place)[key]
        return place

    def duplicates(self) -> Iterator[Keys]:
        """The way to each key that an object has twice."""
        to_visit: list[tuple[Keys, Place]] = [((), self.root)]
        while to_visit:
            keys, place = to_visit.pop()
            seen = set()
            for key, inner in self._scan(place):
                if key in seen:
                    yield (*keys, key)
                seen.add(key)
                to_visit.append(((*keys, key), inner))

    def _members(self, place: Place) -> dict[Key, Place]:
        if place.start not in self._known:
            self._known[place.start] = dict(self._scan(place))
        return self._known[place.start]

    def _scan(self, place: Place) -> Iterator[tuple[Key, Place]]:
        text, at = self._text, place.start
        opening = text[at]
        if opening not in "[{":
            return
        at = self._after_space(at + 1)
        number = 0
        while at < place.end - 1:
            key: Key = number
            first = at
            if opening == "{":
                key, at = self._skip(text, at)
                at = self._after_space(self._after_space(at) + 1)  # the colon between
            end = self._skip(text, at)[1]
            yield key, Place(first, at, end)
            at = self._after_space(self._after_space(end) + 1)  # the comma, or the closing bracket
            number += 1

    def _after_space(self, at: int) -> int:
        return _SPACE.match(self._text, at).end()  # type: ignore[union-attr]  # matches nothing too
