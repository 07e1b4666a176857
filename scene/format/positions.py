"""Finds the lines of values in the text of a document.

Only errors need this. tree-sitter builds the syntax trees, and only for text that
`tomllib` or `json` has accepted.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import tree_sitter_json
import tree_sitter_toml
from tree_sitter import Language, Node, Parser

Key = str | int
Keys = tuple[Key, ...]

_TABLES = frozenset({"object", "inline_table", "table", "table_array_element"})


@dataclass(slots=True)
class _Value:
    """key: the offset in bytes of the key (in a list, of the item; of a TOML table with a header,
    the header). unread: nodes whose members are not in `members` yet."""

    key: int
    unread: list[Node] = field(default_factory=list)
    members: dict[Key, _Value] = field(default_factory=dict)

    def member(self, key: Key) -> _Value | None:
        while self.unread:
            self._read(self.unread.pop())
        return self.members.get(key)

    def _read(self, node: Node) -> None:
        if node.type == "array":
            for number, item in enumerate(_values(node)):
                self.members[number] = _value(item.start_byte, item)
        elif node.type in _TABLES:
            for names, pair, value in _pairs(node):
                self.add(names, _value(pair.start_byte, value))

    def add(self, names: list[str], value: _Value) -> None:
        owner = self
        for name in names[:-1]:
            owner = owner.members.setdefault(name, _Value(value.key))
        owner.members[names[-1]] = value

    def table(self, name: str, header: int) -> _Value:
        """The table of a header; of an array of tables, the last one."""
        value = self.members.setdefault(name, _Value(header))
        return value.members[len(value.members) - 1] if 0 in value.members else value


class Positions:
    """Lines of values. A lookup parses only the nodes on the way to the value."""

    def __init__(self, text: str, *, toml: bool) -> None:
        data = text.encode()
        grammar = tree_sitter_toml if toml else tree_sitter_json
        document = Parser(Language(grammar.language())).parse(data).root_node
        self._line_ends = np.flatnonzero(np.frombuffer(data, np.uint8) == ord("\n"))
        self._document = document
        self._root = _toml_root(document) if toml else _value(0, _values(document)[0])

    def line(self, keys: Keys) -> int:
        """The line of the value at `keys`, or of its innermost existing parent; counted from 1."""
        value = self._root
        for key in keys:
            inner = value.member(key)
            if inner is None:
                break
            value = inner
        return int(np.searchsorted(self._line_ends, value.key)) + 1

    def duplicates(self) -> Iterator[Keys]:
        """The keys of each member that occurs twice in an object of a JSON document."""
        to_visit: list[tuple[Keys, Node]] = [((), node) for node in _values(self._document)]
        while to_visit:
            keys, node = to_visit.pop()
            if node.type == "array":
                to_visit += [((*keys, k), item) for k, item in enumerate(_values(node))]
            seen = set()
            for (name,), _, value in _pairs(node):
                if name in seen:
                    yield (*keys, name)
                seen.add(name)
                to_visit.append(((*keys, name), value))


def _toml_root(document: Node) -> _Value:
    root = _Value(0, [document])
    for names, pair, value in _pairs(document):
        root.add(names, _value(pair.start_byte, value))
    for node in document.named_children:
        if node.type not in _TABLES:
            continue
        header, owner = node.start_byte, root
        *above, last = _names(node.named_children[0])
        for name in above:
            owner = owner.table(name, header)
        if node.type == "table_array_element":
            tables = owner.members.setdefault(last, _Value(header)).members
            tables[len(tables)] = _Value(header, [node])
        else:
            owner.table(last, header).unread.append(node)
    return root


def _value(key: int, node: Node) -> _Value:
    return _Value(key, [node])


def _values(node: Node) -> list[Node]:
    return [child for child in node.named_children if child.type != "comment"]


def _pairs(node: Node) -> Iterator[tuple[list[str], Node, Node]]:
    """(names of the key, the pair, its value)."""
    for pair in node.named_children:
        if pair.type == "pair":
            key, *_, value = _values(pair)  # the grammar takes -Infinity for an error and a name
            yield _names(key), pair, value


def _names(key: Node) -> list[str]:
    """The parts of a dotted key."""
    if key.type == "dotted_key":
        return [name for part in _values(key) for name in _names(part)]
    text = (key.text or b"").decode()
    if key.type == "bare_key":
        return [text]
    return [json.loads(text)] if key.type == "string" else list(tomllib.loads(f"{text} = 0"))
