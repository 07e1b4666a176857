"""The lines of keys, held against parses of the start of a text, and against what wrote it."""

from __future__ import annotations

import json
import random
import tomllib
from collections.abc import Iterator
from typing import Any

import pytest

from satcheck.scene.scene_file.text import dotted, innermost, lines_of, repeated_keys
from satcheck.scene.table import Keys

TOML = '''# comment [[not.a.header]]
schema = "one"   # = "two"
"quoted key" = 'lit # eral'
a.b . "c.d" = 1_000
time = 1979-05-27 07:32:00

text = """
[[no.header]]
x = "1" \\""" still text
""""
raw = \'\'\'
x = 1 ''\'\'\'
flag=true
many = [ 1, # one ]
  [2.5, "]"],
  {x = 3, y.z = [4]},
  ["no header"]
]

[[bodies]]
id = "a"
shape = { type = "box", size = [1, 2,
  3] }

  [bodies.about]
  deep = "inner"

[[bodies]]
id = "b"
[[bodies.parts]]
n = 0
[[bodies.parts]]
n = 1

[x.y]
z = [[1, 2], [3, -inf]]
["bodies 2"]
end = 0'''
LINES = {
    ("schema",): 2,
    ("quoted key",): 3,
    ("a", "b", "c.d"): 4,
    ("text",): 7,
    ("raw",): 11,
    ("many", 1): 15,
    ("many", 2, "x"): 16,
    ("bodies",): 20,
    ("bodies", 0): 20,
    ("bodies", 0, "shape", "size"): 22,
    ("bodies", 0, "shape", "size", 2): 22,
    ("bodies", 0, "about"): 25,
    ("bodies", 1): 28,
    ("bodies", 1, "parts", 1): 32,
    ("bodies", 1, "parts", 1, "n"): 33,
    ("bodies", 1, "nothing", "there"): 28,
    ("x",): 35,
    ("bodies 2", "end"): 38,
    ("nothing",): 1,
    (): 1,
}


def line(text: str, keys: Keys, *, toml: bool = True) -> int:
    return innermost(lines_of(text, [keys], toml=toml), keys)


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("keys", LINES, ids=str)
def test_the_line_of_a_key_or_of_what_is_around_it(keys: Keys, newline: str) -> None:
    assert line(TOML.replace("\n", newline), keys) == LINES[keys]


def below(value: Any, keys: Keys = ()) -> Iterator[Keys]:
    """The keys of a value and of everything in it."""
    yield keys
    for key, inner in (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    ):
        yield from below(inner, (*keys, key))


def statements(text: str) -> dict[Keys, tuple[int, int]]:
    """The first and the last line of the statement that brings each key into a TOML document."""
    lines = text.split("\n")
    places: dict[Keys, tuple[int, int]] = {}
    before = 0
    for count in range(1, len(lines) + 1):
        try:
            document = tomllib.loads("\n".join(lines[:count]))
        except ValueError:  # the line ends within a value
            continue
        for keys in below(document):
            places.setdefault(keys, (before + 1, count))
        before = count
    return places


def mutant(text: str, chance: random.Random) -> str:
    """The text with a few characters cut out, put in, or copied from elsewhere."""
    for _ in range(chance.choice([1, 1, 2, 4])):
        at, other = chance.randrange(len(text)), chance.randrange(len(text))
        new = chance.choice(["", *"[]{}\"'\\=.,#\n\t 0x-", text[other : other + 12]])
        text = text[:at] + new + text[at + chance.randrange(3) :]
    return text


def test_a_line_is_that_of_the_statement() -> None:
    chance, checked = random.Random(5), 0
    for text in (TOML, *(mutant(TOML, chance) for _ in range(300))):
        try:
            tomllib.loads(text)
        except ValueError:
            continue
        places = statements(text)
        lines = lines_of(text, places, toml=True)
        for keys, (first, last) in places.items():
            assert not keys or first <= innermost(lines, keys) <= last, (keys, text)
        checked += 1
    assert checked > 30


class Writer:
    """Writes JSON with line breaks anywhere, and notes the line of each key and table."""

    def __init__(self, chance: random.Random) -> None:
        self._chance = chance
        self.text = ""
        self.lines: dict[Keys, int] = {}

    def write(self, value: Any, keys: Keys = ()) -> None:
        if not isinstance(value, dict | list):
            self._add(json.dumps(value))
            return
        is_table = isinstance(value, dict)
        if is_table and keys and isinstance(keys[-1], int):
            self._note(keys)
        self._add("{" if is_table else "[")
        for count, key in enumerate(value):
            inner = (*keys, key if is_table else count)
            self._add("," if count else "")
            if is_table:
                self._note(inner)
                self._add(json.dumps(key))
                self._add(":")
            self.write(value[key] if is_table else key, inner)
        self._add("}" if is_table else "]")

    def _note(self, keys: Keys) -> None:
        self.lines[keys] = self.text.count("\n") + 1

    def _add(self, piece: str) -> None:
        self.text += piece + self._chance.choice(["", "", " ", "\n", "\r\n", " \n\t"])


def document(chance: random.Random, depth: int = 4) -> Any:
    kind = chance.randrange(4) if depth else 3
    if kind < 2:
        names = chance.sample(["a", 'b"]', "c\\", "é{", "d:", ""], chance.randrange(4))
        return {name: document(chance, depth - 1) for name in names}
    if kind == 2:
        return [document(chance, depth - 1) for _ in range(chance.randrange(4))]
    return chance.choice([1, -2.5e3, None, True, "", '"', "]}", "\\", "a:", "[1]"])


def test_a_line_of_json_is_where_its_key_was_written() -> None:
    chance, checked = random.Random(7), 0
    for _ in range(400):
        writer = Writer(chance)
        value = {"bodies": [document(chance) for _ in range(3)]}
        writer.write(value)
        assert json.loads(writer.text) == value
        found = lines_of(writer.text, writer.lines, toml=False)
        assert {keys: found[keys] for keys in writer.lines} == writer.lines, writer.text
        outer = [keys for keys in writer.lines if len(keys) == 1 or keys[1:] in ((0,), (1,), (2,))]
        found = lines_of(writer.text, outer, toml=False)  # what is in the tables is not looked at
        assert {keys: found[keys] for keys in outer} == {keys: writer.lines[keys] for keys in outer}
        checked += len(writer.lines)
    assert checked > 2000


def test_keys_that_occur_twice_in_json() -> None:
    text = '{"a": 1, "b": [{"c": 1, "c": [{"e": 0}]}],\n"a": {"d": 3}}'
    assert list(repeated_keys(text)) == [("b", 0, "c"), ("a",)]
    assert line(text, ("a",), toml=False) == 2
    assert list(repeated_keys('{"a": {"b": [{}, {}]}, "b": {"a": 1}}')) == []
    assert list(repeated_keys('{"a": [{"b": 1}], "a": [{"b": 1}]}')) == [("a",)]


def test_a_long_key_is_cut_in_a_message() -> None:
    assert dotted(("bodies", 2, "x" * 80)) == f"bodies[2].{'x' * 80}"
    assert dotted(("x" * 81,)) == f"'{'x' * 80}...'"
