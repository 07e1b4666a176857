"""The lines of values in TOML and JSON: held against the text."""

from __future__ import annotations

import json
import random
import re
import tomllib
from collections.abc import Iterable, Iterator
from typing import Any

import pytest

from satcheck.scene.format.positions import Keys, Positions

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


def leaves(value: Any, keys: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    inner: Any = ()
    if isinstance(value, dict):
        inner = value.items()
    elif isinstance(value, list):
        inner = enumerate(value)
    else:
        yield keys, value
    for key, one in inner:
        yield from leaves(one, (*keys, key))


def assert_lines_name_the_keys(positions: Positions, text: str, found: Iterable[Keys]) -> None:
    """A plain key stands in the line of its value; so its items begin there, or further down."""
    lines = text.split("\n")
    for keys in found:
        plain = [key for key in keys if isinstance(key, str) and re.fullmatch(r"[a-z]+", key)]
        if plain and keys[-1] == plain[-1]:
            assert plain[-1] in lines[positions.line(keys) - 1], (keys, text)


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_every_value_of_a_toml_document_is_where_its_key_is(newline: str) -> None:
    text = TOML.replace("\n", newline)
    found = dict(leaves(tomllib.loads(text)))
    assert len(found) == 26
    assert_lines_name_the_keys(Positions(text, toml=True), text, found)


LINES = {
    ("schema",): 2,
    ("text",): 7,
    ("many", 1): 15,
    ("many", 2, "x"): 16,
    ("bodies",): 19,
    ("bodies", 0): 19,
    ("bodies", 0, "shape", "size"): 21,
    ("bodies", 0, "shape", "size", 2): 22,
    ("bodies", 0, "about"): 24,
    ("bodies", 1): 27,
    ("bodies", 1, "parts", 1): 31,
    ("bodies", 1, "nothing", "there"): 27,
    ("x",): 34,
    ("nothing",): 1,
    (): 1,
}


@pytest.mark.parametrize("keys", LINES, ids=str)
def test_line_of_toml(keys: tuple[Any, ...]) -> None:
    assert Positions(TOML, toml=True).line(keys) == LINES[keys]


JSON = """{
  "schema": "one",
  "a": {"b\\u0041": [1, -2.5e3,
     null, {"c": "]}"}], "empty": [], "none": {}},
  "bodies": [
    {"id": "a", "position": [0, 1,
      2]},
    {"id": "b"}
  ]
}"""


@pytest.mark.parametrize("text", [JSON, re.sub(r"\s", "", JSON), "  " + JSON + "\n"])
def test_every_value_of_a_json_document_is_where_its_key_is(text: str) -> None:
    found = dict(leaves(json.loads(text)))
    assert len(found) == 10
    assert_lines_name_the_keys(Positions(text, toml=False), text, found)


def mutant(text: str, chance: random.Random) -> str:
    """The text with a few characters cut out, put in, or copied from elsewhere."""
    for _ in range(chance.choice([1, 1, 2, 4])):
        at, other = chance.randrange(len(text)), chance.randrange(len(text))
        new = chance.choice(["", *"[]{}\"'\\=.,#\n\t 0x-", text[other : other + 12]])
        text = text[:at] + new + text[at + chance.randrange(3) :]
    return text


@pytest.mark.parametrize("form", ["toml", "json"])
def test_whatever_is_still_a_document_has_its_values_where_their_keys_are(form: str) -> None:
    text, read = (TOML, tomllib.loads) if form == "toml" else (JSON, json.loads)
    chance, checked = random.Random(5), 0
    for _ in range(1000):
        changed = mutant(text, chance)
        try:
            found = dict(leaves(read(changed)))
        except ValueError:
            continue
        assert_lines_name_the_keys(Positions(changed, toml=form == "toml"), changed, found)
        checked += 1
    assert checked > 50


def test_line_of_json() -> None:
    positions = Positions(JSON, toml=False)
    assert positions.line(("bodies", 0, "position")) == 6
    assert positions.line(("bodies", 0, "position", 2)) == 7
    assert positions.line(("bodies", 1, "nothing", 5)) == 8
    assert positions.line(("nothing",)) == 1


def test_duplicate_keys_of_json() -> None:
    text = '{"a": 1, "b": [{"c": 1, "c": 2}], "a": {"d": 3}}'
    assert sorted(Positions(text, toml=False).duplicates()) == [("a",), ("b", 0, "c")]
    assert list(Positions(JSON, toml=False).duplicates()) == []
