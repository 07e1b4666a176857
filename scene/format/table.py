"""Reads one table of a document key by key. Errors are collected, and reading continues."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

from satcheck.scene.format.entries import BodyEntry
from satcheck.scene.format.problems import Problems, Wrong
from satcheck.scene.format.values import Reader, shown
from satcheck.scene.words import meant

if TYPE_CHECKING:
    from satcheck.scene.format.lines import Keys

T = TypeVar("T")
D = TypeVar("D")


class Table:
    """keys: the path to it from the top of the document."""

    __slots__ = ("_problems", "keys", "values")

    def __init__(self, values: dict[str, Any], keys: Keys, problems: Problems) -> None:
        self.values = values
        self.keys = keys
        self._problems = problems

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def read(self, key: str, reader: Reader[T], default: D) -> T | D:
        """The value of a key; the default if it is missing or wrong."""
        if key not in self.values:
            return default
        try:
            return reader(self.values[key])
        except Wrong as wrong:
            self._problems.add((*self.keys, key), wrong)
            return default

    def required(self, key: str, reader: Reader[T], default: T) -> T:
        """The same for a required key."""
        if key not in self.values:
            self.wrong(f'"{key}" is missing')
        return self.read(key, reader, default)

    def only(self, known: frozenset[str]) -> None:
        """Reports every other key as an error, because a misspelt key would be ignored."""
        if not self.values.keys() <= known:
            for key in self.values.keys() - known:
                hint = meant(key, known - self.values.keys())
                self._problems.add((*self.keys, key), Wrong(f"unknown key{hint}", code="bad-scene"))

    def wrong(self, message: str, *keys: str, code: str = "bad-scene") -> None:
        self._problems.add((*self.keys, *keys), Wrong(message, code=code))

    @property
    def problem_count(self) -> int:
        """Number of problems in the whole document so far."""
        return len(self._problems)

    def table(self, key: str) -> Table | None:
        """The table at a key; None if it is missing or not a table."""
        values = self.values.get(key)
        if isinstance(values, dict):
            return Table(values, (*self.keys, key), self._problems)
        if key in self.values:
            self.wrong(f"a table expected, not {shown(values)}", key)
        return None

    def tables(self, key: str) -> Iterator[Table]:
        """The tables of a list."""
        values = self.values.get(key, [])
        if not isinstance(values, list):
            self.wrong(f"a list of tables expected, not {shown(values)}", key)
            return
        for index, value in enumerate(values):
            keys = (*self.keys, key, index)
            if isinstance(value, dict):
                yield Table(value, keys, self._problems)
            else:
                self._problems.add(keys, Wrong(f"a table expected, not {shown(value)}"))


def read_bodies(top: Table, read: Callable[[Table], BodyEntry]) -> tuple[BodyEntry, ...]:
    """The bodies of a scene. Two bodies with the same id are an error."""
    bodies, ids = [], set()
    for table in top.tables("bodies"):
        body = read(table)
        if body.id and body.id in ids:
            table.wrong(f"a second body {shown(body.id)}", "id", code="duplicate-id")
        ids.add(body.id)
        bodies.append(body)
    return tuple(bodies)
